// What the shaders of props read: where each stands, and each draw's push data.
#ifndef ESPALIER_RENDER_PROP_RECORDS_H
#define ESPALIER_RENDER_PROP_RECORDS_H
#include "shaders/render/frame_records.h"

ESPALIER_BEGIN

CONST_UINT(kFacingSide, 32u);   // directions of foliage's cards are told in so many squares along a side of the octahedron

CONST_FLOAT(kShadeStep, 0.06f);   // of PropInstance::tint, a share

// Two texels of four words.
struct PropInstance {
    vec3 position;
    float scale;
    vec2 turn;      // cosine and sine about the vertical, counterclockwise from above
    float tint;     // its fraction: how it differs from others of its kind; its whole part: by how many steps it is lighter
    float fade;     // 1: all pixels; above 0: this share of them; below: those that -fade leaves out
};
STATIC_SIZE(PropInstance, 32);

struct PropPush {
    vec4 baseColor;
    uint firstInstance;
    uint grass;         // 1: it has the meadow's colour
    float roughness;
    float alphaCutoff;  // 0: opaque
    float high;         // of the mesh above its origin, where it stands
};
STATIC_SIZE(PropPush, 36);

ESPALIER_END
#endif
