/* Seeds, and the plants that grow from them. A part of espalier.h, which includes it; the rules at its top hold here too. */
#ifndef ESPALIER_PLANTS_H
#define ESPALIER_PLANTS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Seeds -------------------------------------------------------------------------------------------------- */

typedef struct EspSeedDef {
    ESP_STRUCT_SIZE(EspSeedDef);
    EspGrammar grammar;
    const char* symbol;       /* start symbol; NULL: the grammar's first */
    float position[3];        /* world; the nearest place on a surface is taken; from bare material ground beside it */
    float direction[3];       /* world; laid into the surface. Zero: upward, or any where the surface is level */
    uint32_t number;          /* the seed's random number: seeds of unlike numbers grow unlike plants */
    uint32_t twin;            /* tells apart seeds of one number, 1 to 2^20; 0: the first that isn't planted yet */
} EspSeedDef;
ESP_API EspResult espDefaultSeedDef(EspSeedDef* out);
/* Up to 2^20 - 1 a context. ESP_INVALID_ARGUMENT: there is no surface, the grammar makes roofs, no rule grows from the symbol,
 * the twin is planted already, or a number isn't finite. */
ESP_API EspResult espPlant(EspContext* context, const EspSeedDef* def, EspSeed* out);
ESP_API EspResult espRemoveSeed(EspContext* context, EspSeed seed);
/* All but those that procedural graphs planted. */
ESP_API EspResult espRemoveAllSeeds(EspContext* context);

typedef struct EspSeedInfo {
    ESP_STRUCT_SIZE(EspSeedInfo);
    EspSurface surface;
    float position[3];        /* on the surface, world */
    float normal[3], direction[3];   /* unit, world; the direction is laid into the surface */
    int frozen;               /* 1: its plant stands as it is, see espFreezePlant */
    int ofGraph;              /* 1: a procedural graph planted it (a Grow node), and takes it away. What a host saves of
                                 seeds, it saves without these */
    int hidden;               /* 1: see espHideSeed */
} EspSeedInfo;

ESP_API uint32_t espSeedCount(const EspContext* context);
/* In an order that doesn't change while no seed comes or goes. */
ESP_API EspResult espSeedAt(const EspContext* context, uint32_t index, EspSeed* out);
ESP_API EspResult espSeedInfo(const EspContext* context, EspSeed seed, EspSeedInfo* out);
/* As it was planted or last moved: planted by it again, the plant is the same to the bit, or, if its surface was moved since,
 * by rounding slightly another. symbol: "" or valid as long as the seed: for later it is copied. */
ESP_API EspResult espSeedDef(const EspContext* context, EspSeed seed, EspSeedDef* out);
/* Hides a seed's plant (hidden 1), as an editor does: nothing stands there, so nothing is drawn, picked or exported, until it
 * is shown again (0) and is the same to the bit. A frozen plant stays frozen meanwhile. With the next espUpdate. */
ESP_API EspResult espHideSeed(EspContext* context, EspSeed seed, int hidden);
/* To where it would be planted at `position`; its plant keeps its random numbers. Without ground near, it doesn't grow. */
ESP_API EspResult espMoveSeed(EspContext* context, EspSeed seed, const float position[3], const float direction[3]);
/* twin: as in EspSeedDef. */
ESP_API EspResult espSetSeedNumber(EspContext* context, EspSeed seed, uint32_t number, uint32_t twin);
/* A value for this seed alone in place of its grammar's; count 0: the grammar's again. Growth limits it to the range. Kept by
 * name when the grammar is compiled anew. Seeds of the same settings share one copy of the grammar's rule map; with more
 * than 65,536 of these and grammars together espUpdate fails. */
ESP_API EspResult espSetSeedParam(EspContext* context, EspSeed seed, const char* name, const float* value,
                                  uint32_t count);
/* *count: 0 where the seed has no value of its own. */
ESP_API EspResult espSeedParam(const EspContext* context, EspSeed seed, const char* name, float value[3],
                               uint32_t* count);

/* ---- Looks -------------------------------------------------------------------------------------------------- */

/* What a grammar of plants draws: some of "bark", "leaf", "pebble", "oval", "blossom" and "tuft", which Shape() names.
 * Static strings. */
ESP_API uint32_t espTerminalCount(const EspContext* context, EspGrammar grammar);
ESP_API const char* espTerminalName(const EspContext* context, EspGrammar grammar, uint32_t index);

/* How one kind of terminal of one grammar looks in place of EspContextDef::terminals. Begin with zeros: as shipped. */
typedef struct EspTerminalLook {
    ESP_STRUCT_SIZE(EspTerminalLook);
    int coloured;             /* 1: `colour` counts. It multiplies a picture or mesh of the host's; the shipped picture it
                                 gives this hue, as bright on average */
    float colour[3];          /* linear, 0 to 1 */
    uint32_t reserved;        /* 0 */
    const char* mesh;         /* a file of meshes as espalier-bake --terminal writes it, not for bark; up to four variants of
                                 four levels each. NULL: the shipped meshes */
    const char* picture;      /* PNG or JPEG of up to 4,096 texels a side, in place of the meshes' own; what is more than half
                                 transparent is cut out. Of bark and pebbles it tiles; other terminals without a mesh become
                                 cards that show it, its lower edge at the stalk. NULL: the meshes' own */
} EspTerminalLook;
/* NULL: as shipped. Plants by this grammar get it with the next espUpdate; frozen ones keep theirs, as long as it is set. Kept
 * when the grammar is compiled anew. ESP_INVALID_ARGUMENT: no such grammar of plants, no such terminal, a number out of
 * range, or no room: five grammars may have a look of one kind, and all looks together a limited number of levels of
 * detail. ESP_IO_FAILED, ESP_INVALID_CONTENT: of a file. Waits for the GPU. */
ESP_API EspResult espSetTerminalLook(EspContext* context, EspGrammar grammar, const char* terminal,
                                     const EspTerminalLook* look);

/* ---- Plants ------------------------------------------------------------------------------------------------- */

/* These look at what the last espUpdate grew. The first call after a growth reads it back, and waits for the GPU. */
typedef struct EspPlantHit {
    ESP_STRUCT_SIZE(EspPlantHit);
    EspSeed seed;
    uint64_t branch;          /* key: stays the same as long as the rules that led to the branch do */
    float position[3];        /* world */
    float distance;           /* along the ray, metres */
    uint32_t depth;           /* branches from the seed, 0: the seed's own */
    uint32_t reserved;        /* 0 */
} EspPlantHit;
/* The branch that the ray meets first; ESP_INVALID_ARGUMENT if none, or if a surface hides it. */
ESP_API EspResult espPickPlant(EspContext* context, const float origin[3], const float direction[3], EspPlantHit* out);

/* The walk of a branch (Buron 2015, Figure 4). Where chart or surface changes from one sample to the next, the walk
 * has gone over a crossing. */
typedef struct EspPathSample {
    float position[3];        /* world */
    float uv[2];              /* the surface's walk UV */
    uint32_t chart;
    EspSurface surface;
    int inserted;             /* 1: put in by a seam, a crease or a bend, not a step of the grammar */
} EspPathSample;
/* From the node that the branch leaves from to its tip. *count: room in samples, set to how many there are. */
ESP_API EspResult espBranchPath(EspContext* context, uint64_t branch, EspPathSample* samples, uint32_t* count);

/* Why a branch goes no further. A frozen plant's tell what was so when it grew. */
typedef enum EspBranchEnd {
    ESP_END_BY_RULES = 0,     /* no rule leads on, or Marching's condition has ended it whatever the place: by `step`, by
                                 arguments. Pruned ones, too */
    ESP_END_REFUSED = 1,      /* no direction of the half circle ahead served (§8), and of one at least the condition doesn't
                                 hold where it leads: what is painted or steep there, how long the branch is (`arc`) */
    ESP_END_NO_GROUND = 2,    /* no direction served, and all for want of ground: a border, bare or buried. Seeds that wait
                                 for ground, too */
    ESP_END_BY_LIMIT = 3      /* a limit stopped it: EspGrowDef's maxNodes or maxDepth. Seeds that haven't grown yet, too */
} EspBranchEnd;

typedef struct EspPlantInfo {
    ESP_STRUCT_SIZE(EspPlantInfo);
    uint32_t nodes;                            /* 0: nothing has grown from the seed */
    float boundsMin[3], boundsMax[3];          /* world, of its nodes; a seed without nodes: its own place */
    EspBranchEnd end;                          /* of the seed's own branch */
} EspPlantInfo;
/* Of one seed's plant. ESP_INVALID_ARGUMENT if there is no such seed. */
ESP_API EspResult espPlantInfo(EspContext* context, EspSeed seed, EspPlantInfo* out);

typedef struct EspBranchInfo {
    ESP_STRUCT_SIZE(EspBranchInfo);
    EspSeed seed;
    uint64_t parent;          /* the branch that it leaves from; at depth 0 the branch itself */
    uint32_t depth;           /* as in EspPlantHit */
    EspBranchEnd end;
} EspBranchInfo;
/* ESP_INVALID_ARGUMENT if no branch of this key has grown. */
ESP_API EspResult espBranchInfo(EspContext* context, uint64_t branch, EspBranchInfo* out);

/* Cuts a branch away with all that grows from it (pruned 1), or lets it grow again (0): the plant is then the same to
 * the bit as if it had never been cut. branch: a key as in EspPlantHit; depth 0 is the whole plant but for its seed.
 * It stays cut through every regrowth, and where no branch has this key (any more), the key waits for one. Takes
 * effect with the next espUpdate; setting what is set does nothing. */
ESP_API EspResult espPruneBranch(EspContext* context, uint64_t branch, int pruned);
/* The keys that are pruned, ascending: what a project keeps of pruning. index: below espPrunedCount. */
ESP_API uint32_t espPrunedCount(const EspContext* context);
ESP_API EspResult espPrunedAt(const EspContext* context, uint32_t index, uint64_t* branch);

/* Keeps a seed's plant as the last espUpdate grew it (frozen 1): layers, parameters, grammars, prunings and changes of
 * the seed itself concern it no more, nor does a limit but maxNodes. It moves with its surface. Thawed (0), it grows
 * from what is there. It thaws by itself when a surface that it has grown on is destroyed, scaled, or moved against another
 * one that it stands on.
 * ESP_INVALID_ARGUMENT: no such seed, or it hasn't grown yet, or a surface that it has grown on was destroyed, scaled,
 * or moved against another one that it stands on, since. Takes effect with the next espUpdate. */
ESP_API EspResult espFreezePlant(EspContext* context, EspSeed seed, int frozen);
/* A frozen plant is its records, not what it grew from: so a project keeps these. *size: bytes that `bytes` has room
 * for, set to how many there are; bytes NULL: only asks. */
ESP_API EspResult espReadFrozen(EspContext* context, EspSeed seed, void* bytes, size_t* size);
/* Freezes a seed's plant as espReadFrozen gave it, in this or another context where surfaces have been loaded in the
 * same order. ESP_INVALID_CONTENT: the bytes are none of a plant, of another version, or of a missing surface. */
ESP_API EspResult espFreezeAs(EspContext* context, EspSeed seed, const void* bytes, size_t size);

#ifdef __cplusplus
}
#endif
#endif
