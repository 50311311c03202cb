/* What stands, as parts: a mesh each, and where it stands. For export, for a renderer of the host's own, for physics and ray
 * tracing. A part of espalier.h, which includes it; the rules at its top hold here too.
 *
 * Leaves, whole tiles and pieces of patterns are parts that stand many times. What is shaped by its place stands once and is
 * in the world already: the stems of a plant, the walls and cut tiles of a house.
 */
#ifndef ESPALIER_PARTS_H
#define ESPALIER_PARTS_H

#include "espalier.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum EspPartKind {
    ESP_PART_STEMS = 0,          /* the bark of one plant */
    ESP_PART_LEAF = 1,           /* what grows on stems: leaves, pebbles */
    ESP_PART_TILE = 2,           /* whole cells of roofs and walls */
    ESP_PART_HOUSE = 3,          /* what of one house is cut: walls, tiles along outlines */
    ESP_PART_PIECE = 4           /* of a pattern */
} EspPartKind;

typedef struct EspPartsDef {
    ESP_STRUCT_SIZE(EspPartsDef);
    uint32_t kinds;              /* bits 1 << EspPartKind; default: all */
    float stemError;             /* by which stems of the finest level may differ from their curves, as a share of the
                                    radius of the plant's thickest stem. 0: not at all, as espMaterialise has them, 216
                                    triangles from node to node; default 0.2 */
    uint32_t stemLevels;         /* levels of detail of stems, 1 to 4, each with four times the error; default 3 */
} EspPartsDef;
ESP_API EspResult espDefaultPartsDef(EspPartsDef* out);

typedef struct EspPartsInfo {
    ESP_STRUCT_SIZE(EspPartsInfo);
    uint32_t parts, materials, pictures;
    uint64_t instances;          /* of all parts */
    uint64_t triangles;          /* of all instances at their finest level */
} EspPartsInfo;
/* Gathers what the last espUpdate left, on the CPU. What the functions below tell of it belongs to the context and lives until
 * the next espReadParts, espTrim or espDestroy, whatever grows meanwhile. ESP_OUT_OF_MEMORY: it is too much. */
ESP_API EspResult espReadParts(EspContext* context, const EspPartsDef* def, EspPartsInfo* out);

typedef struct EspPartInfo {
    ESP_STRUCT_SIZE(EspPartInfo);
    EspPartKind kind;
    const char* name;            /* "leaf_0", "slate", "stems_12", "house_3_rough": no two parts have the same */
    uint32_t material;
    uint32_t levels;             /* of detail, the finest first; at least 1 */
    uint32_t instances;          /* 1 of stems and houses, which stand where their vertices say */
    EspSeed seed;                /* of stems */
    uint32_t house;              /* of ESP_PART_HOUSE: its number */
    uint32_t reserved;           /* 0 */
} EspPartInfo;
/* index: below EspPartsInfo::parts; of all functions here ESP_INVALID_ARGUMENT otherwise. */
ESP_API EspResult espPartInfo(const EspContext* context, uint32_t index, EspPartInfo* out);

typedef struct EspPartVertex {
    float position[3];           /* metres, or in the instance's space */
    float normal[3];             /* unit */
    float uv[2];                 /* of the material's pictures; without any: metres, or in the instance's space */
    float uv2[2];                /* of a set of its own in [0, 1], in which no two triangles of the level overlap */
    float colour[3];             /* linear; factor of the material's and the instance's */
    float wind;                  /* how freely it moves, 0 to 1: of stems 0 at the root, rising along each branch to 1 at its
                                    tip; of leaves 0 at the stalk and 1 at the tip; of all else 0 */
    float age;                   /* of stems: 1 at the root, 0 at the tip that is farthest along its branches; else 0 */
} EspPartVertex;
typedef struct EspPartLevel {
    ESP_STRUCT_SIZE(EspPartLevel);
    uint32_t vertexCount, indexCount;
    float error;                 /* by which it differs from the finest level: metres, or in the instance's space */
    const EspPartVertex* vertices;
    const uint32_t* indices;     /* three a triangle, counterclockwise from outside */
} EspPartLevel;
/* level: below EspPartInfo::levels */
ESP_API EspResult espPartLevel(const EspContext* context, uint32_t index, uint32_t level, EspPartLevel* out);

typedef struct EspPartInstance {
    EspTransform place;          /* turned, scaled along the part's own axes, mirrored perhaps, moved; never sheared */
    float colour[3];             /* linear; factor of the material's */
    float wind, age;             /* of the stem where a leaf stands, as EspPartVertex; else 0 */
    EspSeed seed;                /* of a leaf */
    uint32_t house;              /* of a tile */
    uint32_t reserved;           /* 0 */
} EspPartInstance;
/* *instances: EspPartInfo::instances of them. */
ESP_API EspResult espPartInstances(const EspContext* context, uint32_t index, const EspPartInstance** instances);

typedef struct EspPartMaterial {
    ESP_STRUCT_SIZE(EspPartMaterial);
    const char* name;
    float colour[3];             /* linear; factor of the picture's */
    float roughness;             /* 0 to 1; none is of metal */
    float alphaCutoff;           /* what of the picture has less alpha isn't there; 0: all is */
    int twoSided;
    int colourPicture, normalPicture;   /* -1: none */
} EspPartMaterial;
ESP_API EspResult espPartMaterial(const EspContext* context, uint32_t index, EspPartMaterial* out);

typedef struct EspPartPicture {
    ESP_STRUCT_SIZE(EspPartPicture);
    uint32_t width, height;
    const uint8_t* rgba;         /* rows top to bottom; colours sRGB, normals as in glTF */
} EspPartPicture;
ESP_API EspResult espPartPicture(const EspContext* context, uint32_t index, EspPartPicture* out);

#ifdef __cplusplus
}
#endif

#endif
