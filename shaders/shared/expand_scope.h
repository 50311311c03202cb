// What a rule may ask about the place where a shape stands: the machine's inputs, and the record of what was read.
#ifndef ESPALIER_SHARED_EXPAND_SCOPE_H
#define ESPALIER_SHARED_EXPAND_SCOPE_H
#include "shaders/shared/expand_tables.h"
#include "shaders/shared/walk.h"

ESPALIER_BEGIN

// A chunk's read set as it gathers, see Chunk::reads. Tiles of a layer's changes are grown by what a bilinear read takes
// in, so a place is noted for the tile that it lies in alone.
struct ReadSet {
    uint uses;           // Chunk::uses
    uint level;          // above kMaxReadLevel: everything
    uint last;           // the place noted last: instance << 16 | finest tile
    uint instance;
    uint tile0, tile1, tile2, tile3, tile4;   // kNoIndex: none
    bool beyond;         // places that are none of its nodes'
};
RECORD_WORDS(ReadSet)
RECORD_OFFSETS(ReadSet)

FN ReadSet emptyReadSet() {
    ReadSet r = {};
    r.uses = 0u;
    r.level = 0u;
    r.last = kNoIndex;
    r.instance = kNoIndex;
    r.tile0 = kNoIndex;
    r.tile1 = kNoIndex;
    r.tile2 = kNoIndex;
    r.tile3 = kNoIndex;
    r.tile4 = kNoIndex;
    r.beyond = false;
    return r;
}

// Puts a tile in front of the others, unless it is known. False: there is no room.
FN bool addTile(INOUT(ReadSet) r, uint tile, bool wanted) {
    bool known = tile == r.tile0 || tile == r.tile1 || tile == r.tile2 || tile == r.tile3 || tile == r.tile4;
    bool full = r.tile4 != kNoIndex;
    bool add = wanted && !known && !full;
    r.tile4 = add ? r.tile3 : r.tile4;
    r.tile3 = add ? r.tile2 : r.tile3;
    r.tile2 = add ? r.tile1 : r.tile2;
    r.tile1 = add ? r.tile0 : r.tile1;
    r.tile0 = add ? tile : r.tile0;
    return !wanted || known || !full;
}
FN uint tileOf(ReadSet r, uint i) {
    uint t = i == 0u ? r.tile0 : r.tile1;
    t = i == 2u ? r.tile2 : t;
    t = i == 3u ? r.tile3 : t;
    return i == 4u ? r.tile4 : t;
}
FN uint coarseTile(uint tile, uint level) { return (((tile >> 8u) >> level) << 8u) | ((tile & 255u) >> level); }

// Notes a place. Where its tile finds no room, all move a level up, where some fall together.
FN void notePlace(INOUT(ReadSet) r, uint instance, vec2 uv) {
    uint x = uint(limited(uv.x * 256.0f, 0.0f, 255.0f));
    uint y = uint(limited(uv.y * 256.0f, 0.0f, 255.0f));
    uint place = ((instance & 0xFFFFu) << 16u) | (y << 8u) | x;
    for (bool again = place != r.last; again;) {
        r.last = place;
        bool same = r.instance == kNoIndex || r.instance == instance;
        r.instance = instance;
        r.level = same ? r.level : kMaxReadLevel + 1u;
        again = !addTile(r, coarseTile(place & 0xFFFFu, r.level), r.level <= kMaxReadLevel);
        ReadSet old = r;
        for (uint i = 0u; i < (again ? kReadTiles : 0u); ++i) {
            if (i == 0u) {
                r = emptyReadSet();
                r.uses = old.uses;
                r.last = old.last;
                r.instance = old.instance;
                r.beyond = old.beyond;
                r.level = old.level + 1u;
            }
            addTile(r, coarseTile(tileOf(old, i), 1u), true);
        }
    }
}

// Word i of Chunk::reads. The level goes to Chunk::marks.
FN uint readWord(ReadSet r, uint i) {
    uint low = i == 0u ? r.instance : i == 1u ? r.tile1 : r.tile3;
    uint high = i == 0u ? r.tile0 : i == 1u ? r.tile2 : r.tile4;
    return (low & 0xFFFFu) | (high << 16u);
}

// A layer's value at uv: bilinear, clamped at the image's edge, the fill where nothing is painted.
FN float layerAt(LayerBuf layers, uint instance, uint layer, vec2 uv) {
    uint at = instance * kMaxLayers + layer;
    uint size = layers.v[at].size;
    float value = layers.v[at].fill;
    float fsize = float(size);
    FloatBuf texels = layers.v[at].texels;
    if (IS_GIVEN(texels)) {
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
    }
    return value;
}

// The place of a shape or node, in object space of its instance.
struct Place {
    vec3 position, normal, heading;
    vec2 uv;
    uint instance;
    uint level;
};

// An instance's place in the world, kept at hand while growth stays on it.
struct WorldFrame {
    uint instance;
    vec3 x, y, z;        // rows of object to world
    vec3 offset;
    float perMetre;      // object units a metre
    float lowest;        // height of its lowest point
};

// inputs: only what they need is read.
FN WorldFrame frameOf(SurfaceBuf surfaces, uint instance, uint inputs) {
    WorldFrame f = {};
    f.instance = instance;
    f.x = vec3(1.0f, 0.0f, 0.0f);
    f.y = vec3(0.0f, 1.0f, 0.0f);
    f.z = vec3(0.0f, 0.0f, 1.0f);
    f.offset = vec3(0.0f);
    f.perMetre = 0.0f;
    if ((inputs & (kInputsOfWorld | kInputCurvature)) != 0u) f.perMetre = rcpExact(surfaceScale(surfaces, instance));
    f.lowest = 0.0f;
    if ((kFeatures & kFeatureWorld) == 0u) return f;
    for (uint i = 0u; i < ((inputs & kInputsOfWorld) != 0u ? 3u : 0u); ++i) {
        vec4 row = surfaces.v[instance].toWorld[i];
        vec3 r = vec3(row.x, row.y, row.z);
        f.x = i == 0u ? r : f.x;
        f.y = i == 1u ? r : f.y;
        f.z = i == 2u ? r : f.z;
        f.offset = vec3(i == 0u ? row.w : f.offset.x, i == 1u ? row.w : f.offset.y, i == 2u ? row.w : f.offset.z);
    }
    f.lowest = f.offset.y;
    for (uint i = 0u; i < ((inputs & kInputHeight) != 0u ? 3u : 0u); ++i) {
        float k = i == 0u ? f.y.x : i == 1u ? f.y.y : f.y.z;
        f.lowest = f.lowest + smaller(k * surfaces.v[instance].boundsMin[i], k * surfaces.v[instance].boundsMax[i]);
    }
    return f;
}

// Fills the slots that the masks name. `depth`, `step`, `arc`: see rule_map.h.
FN void giveInputs(MACHINE_PARAM SurfaceBuf surfaces, LayerBuf painted, RuleMapBuf grammars, WorldFrame f, uint grammar,
                   uint inputs, uint layers, Place p, uint depth, uint step, float arc) {
    SET_SLOT(kSlotTexCoord, p.uv.x);
    SET_SLOT(kSlotTexCoord + 1u, p.uv.y);
    SET_SLOT(kSlotDepth, float(depth));
    SET_SLOT(kSlotStep, float(step));
    SET_SLOT(kSlotArc, arc);
    if ((kFeatures & kFeatureSurface) != 0u) {
        if ((inputs & kInputCurvature) != 0u) {
            SET_SLOT(kSlotCurvature, curvatureAt(surfaces, p.instance, p.level, p.uv) * f.perMetre);
        }
        for (uint left = layers; left != 0u; left = left & (left - 1u)) {
            uint i = lowestBit(left);
            SET_SLOT(kSlotLayer + i, layerAt(painted, p.instance, grammars.v[grammar].layerOf[i] & 15u, p.uv));
        }
    }
    if ((kFeatures & kFeatureWorld) == 0u || (inputs & kInputsOfWorld) == 0u) return;
    vec3 normal = vec3(dot3(f.x, p.normal), dot3(f.y, p.normal), dot3(f.z, p.normal)) * f.perMetre;
    vec3 heading = vec3(dot3(f.x, p.heading), dot3(f.y, p.heading), dot3(f.z, p.heading)) * f.perMetre;
    float height = dot3(f.y, p.position) + f.offset.y;
    SET_SLOT(kSlotNormal, normal.x);
    SET_SLOT(kSlotNormal + 1u, normal.y);
    SET_SLOT(kSlotNormal + 2u, normal.z);
    SET_SLOT(kSlotHeading, heading.x);
    SET_SLOT(kSlotHeading + 1u, heading.y);
    SET_SLOT(kSlotHeading + 2u, heading.z);
    SET_SLOT(kSlotPosition, dot3(f.x, p.position) + f.offset.x);
    SET_SLOT(kSlotPosition + 1u, height);
    SET_SLOT(kSlotPosition + 2u, dot3(f.z, p.position) + f.offset.z);
    SET_SLOT(kSlotHeight, height - f.lowest);
    if ((inputs & kInputSlope) != 0u) {
        SET_SLOT(kSlotSlope, atan2Exact(sqrtExact(normal.x * normal.x + normal.z * normal.z), normal.y));
    }
    for (uint left = inputs & 15u; left != 0u; left = left & (left - 1u)) {
        uint i = lowestBit(left);
        vec4 d = grammars.v[grammar].directions[i];
        SET_SLOT(kSlotAngle + i, angleInSurface(heading, normal, vec3(d.x, d.y, d.z)));
    }
}

ESPALIER_END
#endif
