/* Roofs: towns of houses from footprints, on which a grammar grows walls and roofs. A part of espalier.h, which includes
 * it; the rules at its top hold here too. */
#ifndef ESPALIER_ROOFS_H
#define ESPALIER_ROOFS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A town: buildings from footprints, on which a grammar of roofs (docs/roof_grammar.md) grows walls and roofs. One a
 * context. text: GeoJSON with OpenStreetMap's tags, or a plan in metres (docs/roofs.md); features that can't be used are
 * named in warnings, the rest of the town stands. */
typedef struct EspTownDef {
    ESP_STRUCT_SIZE(EspTownDef);
    EspGrammar grammar;      /* may be set later */
    const char* name;        /* for messages, usually the file's path */
    const char* text;
    size_t length;
    float position[3];       /* world, metres: where the plan's origin stands */
    float turn;              /* radians, counterclockwise from above */
    int ground;              /* 1: level ground is drawn under the lowest wall, out to the horizon */
    float groundColour[3];   /* linear */
} EspTownDef;
ESP_API EspResult espDefaultTownDef(EspTownDef* out);   /* where it was modelled, on ground */
/* Replaces the town that there was. It grows in the next espUpdate. ESP_IO_FAILED: roofs.glb, beside the terminal meshes,
 * can't be read; ESP_INVALID_CONTENT: text has no town. What fails leaves the town that there was. */
ESP_API EspResult espLoadTown(EspContext* context, const EspTownDef* def);
ESP_API EspResult espRemoveTown(EspContext* context);
/* The grammar that the town grows by; its parameters and recompiling are those of any grammar. */
ESP_API EspResult espSetTownGrammar(EspContext* context, EspGrammar grammar);
ESP_API EspResult espTownGrammar(const EspContext* context, EspGrammar* out);

/* Layers of a town lie over a square of the plan around its houses, seen from above: rows of texels from north (least z)
 * to south, each from west (least x) to east. Grammars of roofs read them as name(texCoord) where a shape stands, or
 * name(house), the mean over a house; Drop(name) takes tiles away by them and Moss(name) covers tiles. Houses that read
 * what changed grow anew in the next espUpdate, and stay as they are where that fails; what is dropped or covered costs no
 * growth.
 * The strokes above paint them too, those that the town's grammar reads or that were painted or set before, straight down
 * whatever the height, and undo it. */
typedef struct EspTownInfo {
    ESP_STRUCT_SIZE(EspTownInfo);
    uint32_t houses;
    float layerLow[2];       /* world x and z of the square's north-western corner */
    float layerSide;         /* metres */
    uint32_t layerTexels;    /* a side */
    float groundHeight;      /* world */
    int geographic;          /* 1: `origin` is in degrees */
    double origin[2];        /* of the plan that EspTownDef::position places: degrees of longitude and latitude, or metres
                                of a plan, which has an origin of its own if it lies more than 10 km from (0, 0) */
} EspTownInfo;
ESP_API EspResult espTownInfo(const EspContext* context, EspTownInfo* out);
/* Replaces the whole layer, resampled from height rows of width floats in [0,1], 1 to 8192 each. out: an ended stroke to
 * undo it by, or NULL. One that the town's grammar doesn't read is kept until it does. */
ESP_API EspResult espSetTownLayer(EspContext* context, const char* name, const float* texels, uint32_t width,
                                  uint32_t height, EspStroke* out);
/* As espReadLayer. */
ESP_API EspResult espReadTownLayer(EspContext* context, const char* name, float* texels, uint32_t* size);
/* The layers of the town that were painted or set. */
ESP_API uint32_t espTownLayerCount(const EspContext* context);
ESP_API const char* espTownLayerName(const EspContext* context, uint32_t index);

typedef enum EspRoofShape {
    ESP_ROOF_HIP = 0, ESP_ROOF_GABLE = 1, ESP_ROOF_HALF_HIP = 2, ESP_ROOF_PYRAMID = 3, ESP_ROOF_SHED = 4,
    ESP_ROOF_GAMBREL = 5, ESP_ROOF_MANSARD = 6, ESP_ROOF_FLAT = 7
} EspRoofShape;

/* What one edge of a house has of its own. Edge i leads from corner i to the next of its ring, counted over all rings. */
typedef struct EspHouseEdge {
    uint32_t edge;
    int gable;               /* 1: a gable stands on it, 0: an eave, -1: as the shape says */
    float slope;             /* tangent of the pitch; 0: as the shape says */
} EspHouseEdge;

/* What covers a roof; which of them it draws, and how, is the grammar's business. THATCH to GRASS come from plans. */
typedef enum EspCovering {
    ESP_COVERING_ANY = 0,    /* the grammar chooses */
    ESP_COVERING_TILES = 1, ESP_COVERING_SLATE = 2, ESP_COVERING_METAL = 3, ESP_COVERING_COPPER = 4, ESP_COVERING_THATCH = 5,
    ESP_COVERING_WOOD = 6, ESP_COVERING_STONE = 7, ESP_COVERING_CONCRETE = 8, ESP_COVERING_ASPHALT = 9,
    ESP_COVERING_GRAVEL = 10, ESP_COVERING_GLASS = 11, ESP_COVERING_GRASS = 12, ESP_COVERING_PLAIN_TILES = 13,
    ESP_COVERING_PAN_TILES = 14, ESP_COVERING_BARREL_TILES = 15
} EspCovering;
typedef enum EspChimneys { ESP_CHIMNEYS_ANY = 0, ESP_CHIMNEYS_NONE = 1, ESP_CHIMNEYS_ALL = 2 } EspChimneys;

/* How a house's roof is dressed, where that isn't left to the grammar. */
typedef struct EspHouseLook {
    ESP_STRUCT_SIZE(EspHouseLook);
    EspCovering covering;
    int coloured;            /* 1: the covering has this colour */
    float colour[3];         /* linear, 0 to 1, kept with 8 bits; read if it is coloured */
    float overhang;          /* of the eaves, metres, up to 1; 0: as the grammar says. Over steep walls the shipped ones reach out less */
    EspChimneys chimneys;    /* ALL: on every ridge that the grammar finds long enough */
} EspHouseLook;

typedef struct EspHouseInfo {
    ESP_STRUCT_SIZE(EspHouseInfo);
    const char* id;          /* the feature's; lives as long as the town */
    const char* note;        /* what couldn't be made as it was asked for, a line each; "": all was. Until the house changes */
    EspRoofShape shape;      /* as it was asked for */
    float slope;             /* tangent of the pitch; 0: the shape's own */
    float baseHeight, eaveHeight, ridgeHeight;   /* world y, metres */
    uint32_t cornerCount;    /* of all rings */
    uint32_t edgeCount;      /* edges with something of their own */
    float boundsMin[3], boundsMax[3];            /* world */
    uint32_t ringCount;      /* the outer ring and courtyards, in this order */
    int hidden;              /* 1: see espHideHouse */
    uint32_t reserved;       /* 0 */
} EspHouseInfo;

ESP_API uint32_t espHouseCount(const EspContext* context);
ESP_API EspResult espHouseInfo(const EspContext* context, uint32_t house, EspHouseInfo* out);
ESP_API EspResult espHouseLook(const EspContext* context, uint32_t house, EspHouseLook* out);
/* What stands: needless corners are gone, outer rings run counterclockwise seen from above, and edges count over these rings.
 * Corners in the plan, two floats each: world x and z. Room for EspHouseInfo::cornerCount pairs, edgeCount edges; either
 * may be NULL. */
ESP_API EspResult espHouseShape(const EspContext* context, uint32_t house, float* corners, EspHouseEdge* edges);
/* How many of these corners each ring has. Room for EspHouseInfo::ringCount numbers. */
ESP_API EspResult espHouseRings(const EspContext* context, uint32_t house, uint32_t* corners);

/* Changes one house; it alone grows anew in the next espUpdate. What is left out is as it stands; all else comes from the
 * house's plan and from this alone. An outline that crosses itself or has no area is refused with ESP_INVALID_CONTENT, and
 * the house stands as it did. */
typedef struct EspHouseDef {
    ESP_STRUCT_SIZE(EspHouseDef);
    EspRoofShape shape;
    float slope;             /* 0: the shape's own; where that is the plan's shape, by the height that the plan gives the roof */
    float eaveHeight;        /* metres above the house's base; 0: as it is */
    const EspHouseEdge* edges;   /* of the corners below, then of the rings that stay as they are */
    uint32_t edgeCount;
    const float* corners;    /* as espHouseShape gives them; NULL: as they are */
    uint32_t cornerCount;
    const uint32_t* rings;   /* how many of them each ring has, the outer one first; at least 3 */
    uint32_t ringCount;      /* 0: all are of the outer ring, and courtyards stay as they are */
    const EspHouseLook* look;   /* NULL: as it is */
} EspHouseDef;
ESP_API EspResult espSetHouse(EspContext* context, uint32_t house, const EspHouseDef* def);
/* Back to what the town was loaded with; does nothing where that is what stands. */
ESP_API EspResult espResetHouse(EspContext* context, uint32_t house);
/* Hides a house (hidden 1), as an editor does: walls and roof are neither drawn nor exported until it is shown again (0), and
 * then they are the same to the bit. Whatever changes the house meanwhile is kept. It alone grows anew, in the next espUpdate;
 * a town that is loaded shows all. INVALID_ARGUMENT: there is no such house. */
ESP_API EspResult espHideHouse(EspContext* context, uint32_t house, int hidden);

typedef struct EspRoofStats {
    ESP_STRUCT_SIZE(EspRoofStats);
    uint32_t houses, eaves;
    uint64_t tiles;              /* cells of all grids that stand */
    uint64_t clippedTiles;       /* those of them that an outline crosses */
    uint32_t grids;              /* records; those of houses that grew anew are kept until the whole town grows */
    uint32_t drawnTiles, drawnRectangles;   /* instances in the last frame; rectangles stand for far cells */
    uint64_t drawnTriangles;
    uint32_t stopped;            /* shapes that a limit ended */
    uint32_t overflow;           /* instances left out of the last frame for want of room */
    uint64_t bytes;              /* of what was grown */
    double structureMs, expandMs;   /* from footprints to roofs, on the CPU; the latest expansion, GPU time */
    uint64_t hash;               /* canonical, of the town as it stands, whether houses grew one by one or all at once */
    uint64_t housesGrown;        /* by all expansions together since the town was loaded with a grammar */
} EspRoofStats;
ESP_API EspResult espReadRoofStats(EspContext* context, EspRoofStats* out);

#ifdef __cplusplus
}
#endif
#endif
