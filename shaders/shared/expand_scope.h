// What a rule may ask about the place where a shape stands: the machine's inputs, and the record of what was read.
#ifndef ESPALIER_SHARED_EXPAND_SCOPE_H
#define ESPALIER_SHARED_EXPAND_SCOPE_H
#include "shaders/shared/expand_env.h"
#include "shaders/shared/interpreter.h"
#include "shaders/shared/walk.h"

ESPALIER_BEGIN

// What derivation needs of a rule map, without its larger arrays.
struct RuleTables {
    SymbolRecordBuf symbols;
    RuleRecordBuf rules;
    SuccessorRecordBuf successors;
    CodeBuf code;
    UintBuf sites;
};
FN RuleTables tablesOf(RuleMapBuf grammars, uint grammar) {
    RuleTables t;
    t.symbols = grammars.v[grammar].symbols;
    t.rules = grammars.v[grammar].rules;
    t.successors = grammars.v[grammar].successors;
    t.code = grammars.v[grammar].code;
    t.sites = grammars.v[grammar].sites;
    return t;
}

// A chunk's read set as it gathers; see Chunk::readTiles. A tile is noted for the texel that holds the texture
// coordinate; the bilinear read touches texels one further, so who marks tiles dirty grows them by a texel.
struct ReadSet {
    uint layers, params;
    uint tile0, tile1, tile2, tile3;
    bool all;
};

FN ReadSet emptyReadSet() {
    ReadSet r;
    r.layers = 0u;
    r.params = 0u;
    r.tile0 = kNoIndex;
    r.tile1 = kNoIndex;
    r.tile2 = kNoIndex;
    r.tile3 = kNoIndex;
    r.all = false;
    return r;
}

FN void noteTile(INOUT(ReadSet) r, uint tile) {
    bool known = tile == r.tile0 || tile == r.tile1 || tile == r.tile2 || tile == r.tile3;
    bool full = r.tile3 != kNoIndex;
    r.all = r.all || (full && !known);
    bool add = !known && !full;
    // Slots fill from 0 on, and `tile3` last.
    r.tile3 = add && r.tile2 != kNoIndex ? tile : r.tile3;
    r.tile2 = add && r.tile1 != kNoIndex && r.tile2 == kNoIndex ? tile : r.tile2;
    r.tile1 = add && r.tile0 != kNoIndex && r.tile1 == kNoIndex ? tile : r.tile1;
    r.tile0 = add && r.tile0 == kNoIndex ? tile : r.tile0;
}

// A layer's value at uv: bilinear, clamped at the image's edge, the fill where nothing is painted.
FN float layerAt(LayerBuf layers, uint instance, uint layer, vec2 uv, INOUT(ReadSet) reads) {
    uint at = instance * kMaxLayers + layer;
    uint size = layers.v[at].size;
    float value = layers.v[at].fill;
    reads.layers = reads.layers | (1u << layer);
    // An unpainted layer has one tile, so that a first stroke finds its readers.
    uint tile = 0u;
    if (size > 0u) {
        FloatBuf texels = layers.v[at].texels;
        float fsize = float(size);
        float gx = limited(uv.x * fsize - 0.5f, 0.0f, fsize - 1.0f);
        float gy = limited(uv.y * fsize - 0.5f, 0.0f, fsize - 1.0f);
        uint x = uint(gx);
        uint y = uint(gy);
        uint x1 = x + 1u < size ? x + 1u : x;
        uint y1 = y + 1u < size ? y + 1u : y;
        float fx = gx - float(x);
        float fy = gy - float(y);
        float low = texels.v[texelIndex(size, x, y)] * (1.0f - fx) + texels.v[texelIndex(size, x1, y)] * fx;
        float high = texels.v[texelIndex(size, x, y1)] * (1.0f - fx) + texels.v[texelIndex(size, x1, y1)] * fx;
        value = low * (1.0f - fy) + high * fy;
        uint tx = uint(uv.x * fsize) / kLayerTile;
        uint ty = uint(uv.y * fsize) / kLayerTile;
        tile = ((ty & 255u) << 8u) | (tx & 255u);
    }
    noteTile(reads, ((instance & 255u) << 24u) | (layer << 16u) | tile);
    return value;
}

// The place of a shape or node, in object space of its instance.
struct Place {
    vec3 position, normal, heading;
    vec2 uv;
    uint instance;
    uint level;
};

CONST_UINT(kInputsOfWorld, kInputNormal | kInputHeading | kInputPosition | kInputSlope | kInputHeight | 15u);

// Fills the slots that the masks name. `depth`, `step`, `arc`: see rule_map.h.
FN void giveInputs(MACHINE_PARAM ExpandEnv env, uint grammar, uint inputs, uint layers, Place p, uint depth, uint step,
                   float arc, INOUT(ReadSet) reads) {
    SLOT(kSlotTexCoord) = p.uv.x;
    SLOT(kSlotTexCoord + 1u) = p.uv.y;
    SLOT(kSlotDepth) = float(depth);
    SLOT(kSlotStep) = float(step);
    SLOT(kSlotArc) = arc;

    for (uint left = layers; left != 0u; left = left & (left - 1u)) {
        uint i = lowestBit(left);
        SLOT(kSlotLayer + i) = layerAt(env.layers, p.instance, env.grammars.v[grammar].layerOf[i] & 15u, p.uv, reads);
    }
    if ((inputs & (kInputsOfWorld | kInputCurvature)) == 0u) return;

    float perMetre = rcpExact(env.surfaces.v[p.instance].scale);
    vec4 row0 = env.surfaces.v[p.instance].toWorld[0];
    vec4 row1 = env.surfaces.v[p.instance].toWorld[1];
    vec4 row2 = env.surfaces.v[p.instance].toWorld[2];
    vec3 x = vec3(row0.x, row0.y, row0.z);
    vec3 y = vec3(row1.x, row1.y, row1.z);
    vec3 z = vec3(row2.x, row2.y, row2.z);
    vec3 normal = vec3(dot3(x, p.normal), dot3(y, p.normal), dot3(z, p.normal)) * perMetre;
    vec3 heading = vec3(dot3(x, p.heading), dot3(y, p.heading), dot3(z, p.heading)) * perMetre;
    float height = dot3(y, p.position) + row1.w;
    SLOT(kSlotNormal) = normal.x;
    SLOT(kSlotNormal + 1u) = normal.y;
    SLOT(kSlotNormal + 2u) = normal.z;
    SLOT(kSlotHeading) = heading.x;
    SLOT(kSlotHeading + 1u) = heading.y;
    SLOT(kSlotHeading + 2u) = heading.z;
    SLOT(kSlotPosition) = dot3(x, p.position) + row0.w;
    SLOT(kSlotPosition + 1u) = height;
    SLOT(kSlotPosition + 2u) = dot3(z, p.position) + row2.w;
    if ((inputs & kInputHeight) != 0u) {
        vec3 a = env.surfaces.v[p.instance].boundsMin;
        vec3 b = env.surfaces.v[p.instance].boundsMax;
        float lowest = smaller(y.x * a.x, y.x * b.x) + smaller(y.y * a.y, y.y * b.y) + smaller(y.z * a.z, y.z * b.z);
        SLOT(kSlotHeight) = height - (lowest + row1.w);
    }
    if ((inputs & kInputSlope) != 0u) {
        SLOT(kSlotSlope) = atan2Exact(sqrtExact(normal.x * normal.x + normal.z * normal.z), normal.y);
    }
    if ((inputs & kInputCurvature) != 0u) {
        SLOT(kSlotCurvature) = curvatureAt(env.surfaces, p.instance, p.level, p.uv) * perMetre;
    }
    for (uint left = inputs & 15u; left != 0u; left = left & (left - 1u)) {
        uint i = lowestBit(left);
        vec4 d = env.grammars.v[grammar].directions[i];
        SLOT(kSlotAngle + i) = angleInSurface(heading, normal, vec3(d.x, d.y, d.z));
    }
}

ESPALIER_END
#endif
