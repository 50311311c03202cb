// How a loose terminal (leaf, pebble) is packed into Leaf::place, pose and tint. Expand packs what the grammar's
// terminal gave (rule_map.h, TerminalRecord); emit and drawing unpack it.
//
//   place  bits 31..16  t along the span, unorm
//               15..8   terminal mesh (TerminalRecord::mesh)
//                7..0   size q: size = 2^((q - 160) / 16) metres in the world, 0.98 mm to 61 m in steps of 4.4 %
//   pose   bits 31..20  turn about the surface normal, from the heading to the left, whole turns
//               19..10  pitch away from the surface, -pi/2 to pi/2
//                9..0   lift above the surface in 1/256 of the size, up to 4 sizes
//   tint   bits 31..24  tint, unorm
//               23..8   colour, 5-6-5 bits of the square roots of the linear values
//                7..0   bits of the instance's key, for variation of its own
#ifndef ESPALIER_SHARED_LEAF_POSE_H
#define ESPALIER_SHARED_LEAF_POSE_H
#include "shaders/shared/exact.h"
#include "shaders/shared/growth_records.h"

ESPALIER_BEGIN

struct LeafPose {
    float t;
    uint mesh;
    float size;     // metres, world
    float turn;     // radians
    float pitch;    // radians
    float lift;     // metres, world
    float tint;
    vec3 colour;    // linear
    uint hash;      // 0 to 255
};

// 2^(i / 16), i in 0..15, by multiplication alone.
FN float sixteenthPower(uint i) {
    float r = 1.0f;
    if ((i & 1u) != 0u) r = r * 1.04427378f;
    if ((i & 2u) != 0u) r = r * 1.09050773f;
    if ((i & 4u) != 0u) r = r * 1.18920712f;
    if ((i & 8u) != 0u) r = r * 1.41421356f;
    return r;
}
FN float decodeLeafSize(uint q) {
    return uintBitsToFloat(((q >> 4u) + 117u) << 23u) * sixteenthPower(q & 15u);   // 117 = 127 - 160 / 16
}
// The nearest step not above `size`, plus half a step.
FN uint encodeLeafSize(float size) {
    float s = limited(size * 1.02189715f, 9.765625e-4f, 6.1e1f);
    uint octave = (floatBitsToUint(s) >> 23u) - 117u;
    float base = uintBitsToFloat((octave + 117u) << 23u);
    uint step = 0u;
    if (s >= base * 1.41421356f) step = 8u;
    if (s >= base * sixteenthPower(step + 4u)) step = step + 4u;
    if (s >= base * sixteenthPower(step + 2u)) step = step + 2u;
    if (s >= base * sixteenthPower(step + 1u)) step = step + 1u;
    return (octave << 4u) | step;
}

FN uint packLeafPlace(float t, uint mesh, float size) {
    return (uint(limited(t, 0.0f, 1.0f) * 65535.0f + 0.5f) << 16u) | ((mesh & 255u) << 8u) | encodeLeafSize(size);
}
// lift and size: metres in the world.
FN uint packLeafPose(float turn, float pitch, float lift, float size) {
    float turns = limited(turn, -1000.0f, 1000.0f) * 0.159154943f;
    uint a = uint((turns - floorExact(turns)) * 4096.0f + 0.5f) & 4095u;
    uint b = uint((limited(pitch, -1.57079633f, 1.57079633f) * 0.318309886f + 0.5f) * 1023.0f + 0.5f);
    float sizes = limited(divExact(limited(lift, 0.0f, 1000.0f), larger(size, 1e-6f)), 0.0f, 3.99f);
    return (a << 20u) | (b << 10u) | uint(sizes * 256.0f + 0.5f);
}
FN uint packLeafTint(float tint, vec3 colour, uint hash) {
    uint r = uint(sqrtExact(limited(colour.x, 0.0f, 1.0f)) * 31.0f + 0.5f);
    uint g = uint(sqrtExact(limited(colour.y, 0.0f, 1.0f)) * 63.0f + 0.5f);
    uint b = uint(sqrtExact(limited(colour.z, 0.0f, 1.0f)) * 31.0f + 0.5f);
    return (uint(limited(tint, 0.0f, 1.0f) * 255.0f + 0.5f) << 24u) | (r << 19u) | (g << 13u) | (b << 8u) | (hash & 255u);
}

FN LeafPose unpackLeaf(uint place, uint pose, uint tint) {
    LeafPose p = {};
    p.t = float(place >> 16u) * 1.52590219e-5f;
    p.mesh = (place >> 8u) & 255u;
    p.size = decodeLeafSize(place & 255u);
    p.turn = float(pose >> 20u) * 1.53398079e-3f;
    p.pitch = (float((pose >> 10u) & 1023u) * 9.77517107e-4f - 0.5f) * kPi;
    p.lift = float(pose & 1023u) * 0.00390625f * p.size;
    p.tint = float(tint >> 24u) * 3.92156863e-3f;
    vec3 root = vec3(float((tint >> 19u) & 31u) * 3.22580645e-2f, float((tint >> 13u) & 63u) * 1.58730159e-2f,
                     float((tint >> 8u) & 31u) * 3.22580645e-2f);
    p.colour = vec3(root.x * root.x, root.y * root.y, root.z * root.z);
    p.hash = tint & 255u;
    return p;
}

ESPALIER_END
#endif
