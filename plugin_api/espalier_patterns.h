/* Patterns: pieces that grammars of patterns place on surfaces, along tangent fields (docs/patterns.md). A part of espalier.h,
 * which includes it; the rules at its top hold here too. A pattern begins at seeds (espalier_plants.h) whose grammar makes
 * patterns. */
#ifndef ESPALIER_PATTERNS_H
#define ESPALIER_PATTERNS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Fields ------------------------------------------------------------------------------------------------- */

/* What a designer puts on a surface to form a field of directions. */
typedef enum EspElementKind {
    ESP_ELEMENT_REGULAR = 0,     /* the field has this direction here */
    ESP_ELEMENT_WEDGE = 1,       /* the field turns about the place by half a turn, */
    ESP_ELEMENT_TRISECTOR = 2,   /* by half a turn against the way around, */
    ESP_ELEMENT_NODE = 3,        /* by a whole turn: directions lead away from the place, */
    ESP_ELEMENT_CENTRE = 4,      /* likewise: directions lead around the place, */
    ESP_ELEMENT_SADDLE = 5       /* by a whole turn against the way around */
} EspElementKind;
typedef struct EspFieldElement {
    EspElementKind kind;
    float position[3];           /* world; the nearest vertex of the surface is meant */
    float direction[3];          /* world; laid into the surface. A singular element is turned so that this direction is
                                    one of the field's */
    float radius;                /* metres within which the element is felt; 0: a tenth of the surface's radius */
} EspFieldElement;
/* Strokes of a brush, over all else that is said of a field; later ones over earlier ones. */
typedef enum EspFieldBrush {
    ESP_FIELD_COMB = 0,          /* drags directions along the stroke */
    ESP_FIELD_SMOOTH = 1         /* lets directions relax, as far as half the radius in one stroke */
} EspFieldBrush;
typedef struct EspFieldStroke {
    EspFieldBrush brush;
    float radius;                /* metres in the surface's space; 0: a tenth of the surface's radius */
    float strength;              /* 0 to 1; of a comb, the share of the way there that one stroke turns its middle */
    uint32_t pointCount;         /* up to 1,048,576, all strokes of a field together. One point alone combs nothing */
    const float* points;         /* x, y, z each, in the surface's space, on the surface along the way; at most half a
                                    radius from one to the next, or the stroke has gaps */
} EspFieldStroke;
typedef struct EspFieldDef {
    ESP_STRUCT_SIZE(EspFieldDef);
    uint32_t elementCount;       /* up to 4,096 */
    const EspFieldElement* elements;
    float drift[3];              /* world: the direction that the field leans to where no element says otherwise */
    float lean;                  /* how much it does; 0: not at all */
    int exact;                   /* 1: the field has the elements' singularities and no others, but for those that
                                    topology asks for: on a closed piece of the surface all indices add up to its Euler
                                    characteristic. What elements leave over lies far from them. The drift then turns
                                    each piece's field as a whole only */
    uint32_t reserved;           /* 0 */
    /* A field that another program has computed, in the surface's space, as its file has it: it goes with the surface
     * where that goes. It holds where it says something, but not within an element's radius; an exact field only turns to it
     * as to the drift. Either vectors or tensors at points, or a picture; all NULL: none. */
    const float* points;         /* metres, x, y, z each. A vertex takes the point at its place, or a mean of the nearest
                                    within a hundredth of the surface's radius; without one it follows its neighbours */
    const float* vectors;        /* x, y, z for each point; their length is the field's value */
    const float* tensors;        /* symmetric: xx, yy, zz, xy, xz, yz for each point; of fields whose N is even */
    uint32_t pointCount;         /* up to 16,777,216 */
    uint32_t strokeCount;        /* up to 65,536 */
    const EspFieldStroke* strokes;
    const float* picture;        /* vectors over the walk's UVs: x, y, z for each texel, rows from v = 0; 0, 0, 0 says nothing */
    uint32_t pictureWidth, pictureHeight; /* up to 16,384 */
    uint32_t summed;             /* 1: not by one solve but the paper's way (Li 2011): what elements and the drift ask for is
                                    summed up, then smoothed. Makes many singularities. Not together with `exact`; points
                                    and pictures are where it begins, and hold nothing */
    uint32_t passes;             /* of smoothing then, up to 10,000; espDefaultFieldDef: 300 */
} EspFieldDef;
ESP_API EspResult espDefaultFieldDef(EspFieldDef* out);   /* nothing of all this; it leans down by 1 */

/* The field of this name on one surface, which grammars of patterns read that declare a field so; a field of curvature is the
 * surface's own. def: copied; NULL: as espDefaultFieldDef says, which holds for every surface to begin with. Takes effect with
 * the next espUpdate. ESP_INVALID_ARGUMENT: there is no such surface, the name is empty, a number isn't finite, or there is
 * too much of something. Elements of half a turn do nothing where a grammar declares a field of vectors. Tensors for a field
 * of odd N, points of which none lies near the surface, and strokes that are felt by more than 100,000,000 vertices, each
 * counted for each point of a stroke, fail in espUpdate with ESP_INVALID_CONTENT. */
ESP_API EspResult espSetField(EspContext* context, EspSurface surface, const char* name, const EspFieldDef* def);

/* A place about which a field turns. */
typedef struct EspSingularity {
    float position[3];           /* world */
    float index;                 /* whole turns of the direction on the way once around; N-ths, of a field of N directions */
} EspSingularity;
/* Those of a field of this name, which a grammar declares, on one surface, as the last espSetField asked for. *count: room in
 * out, set to how many there are; what there is no room for is left out. out NULL: only asks. Over a closed surface the
 * indices add up to its Euler characteristic. ESP_INVALID_ARGUMENT: there is no such surface, or no grammar declares such a
 * field. */
ESP_API EspResult espFieldSingularities(EspContext* context, EspSurface surface, const char* name, EspSingularity* out,
                                        uint32_t* count);

/* ---- Grammars ----------------------------------------------------------------------------------------------- */

typedef enum EspGrammarKind { ESP_GRAMMAR_PLANTS = 0, ESP_GRAMMAR_ROOFS = 1, ESP_GRAMMAR_PATTERNS = 2 } EspGrammarKind;
/* What a grammar makes. ESP_INVALID_ARGUMENT: there is no such grammar. */
ESP_API EspResult espGrammarKind(const EspContext* context, EspGrammar grammar, EspGrammarKind* out);
/* The words that the language of a kind of grammars has of its own, for editors that complete names: rule kinds, commands,
 * functions, what is told of a place. index: below espWordCount, else ESP_INVALID_ARGUMENT. Static strings; usage: how the word
 * is written, such as "min(a, b)", or "". */
typedef struct EspWord {
    ESP_STRUCT_SIZE(EspWord);
    uint32_t reserved;           /* 0 */
    const char* name;
    const char* usage;
} EspWord;
ESP_API uint32_t espWordCount(EspGrammarKind kind);
ESP_API EspResult espWord(EspGrammarKind kind, uint32_t index, EspWord* out);

/* The fields that a grammar of patterns declares; the first guides its translations. The name lives as long as the
 * grammar isn't compiled anew. */
ESP_API uint32_t espFieldCount(const EspContext* context, EspGrammar grammar);
ESP_API const char* espFieldName(const EspContext* context, EspGrammar grammar, uint32_t index);

/* ---- Pieces ------------------------------------------------------------------------------------------------- */

/* The meshes that grammars of patterns may place from now on: what espalier-bake --pieces wrote, read as all files are. NULL:
 * pieces.glb beside EspContextDef::terminals, as at first. ESP_INVALID_ARGUMENT: a grammar of patterns is compiled already,
 * which knows the meshes that there were. ESP_IO_FAILED: the file can't be read, and the meshes are what they were. */
ESP_API EspResult espSetPieces(EspContext* context, const char* path);

/* ---- What has been placed ----------------------------------------------------------------------------------- */

typedef struct EspPatternStats {
    ESP_STRUCT_SIZE(EspPatternStats);
    uint32_t seeds;              /* that patterns begin at */
    uint32_t shapes;             /* symbols that were derived */
    uint32_t tried, standing;    /* pieces; sets of pieces that stand or fall together */
    uint32_t fallen;             /* sets that met others, or hung on such */
    uint32_t waves, rounds;      /* of derivation; of decisions, all waves together */
    uint32_t pieces;             /* that stand */
    uint64_t hash;               /* of all that stands; the same inputs give the same on every device */
    double ms;                   /* of the last derivation */
} EspPatternStats;
ESP_API EspResult espPatternStats(EspContext* context, EspPatternStats* out);

#ifdef __cplusplus
}
#endif

#endif
