// Where a loose terminal stands in the world: its stalk on the stem, its blade turned to the light.
#ifndef ESPALIER_EMIT_LEAF_PLACE_H
#define ESPALIER_EMIT_LEAF_PLACE_H
#include "shaders/emit/span_load.h"
#include "shaders/shared/leaf_pose.h"

ESPALIER_BEGIN

struct PlacedLeaf {
    vec3 origin;
    vec3 axisX, axisY, axisZ;   // unit; the mesh's x, y (stalk to tip) and z (face)
    vec3 normal;                // of the surface below, unit
    float size;
    float height;               // of the origin above the surface, metres
};

// Bits that differ between leaves and are the same on every run: of the record, not of its index.
FN uint leafHash(Leaf leaf) {
    uint h = leaf.place * 0x9E3779B1u ^ leaf.pose * 0x85EBCA77u ^ leaf.tint * 0xC2B2AE3Du;
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12u)) * 0x297A2D39u;
    return h ^ (h >> 15u);
}
// Number `which` of four, in [-1, 1].
FN float hashSigned(uint hash, uint which) { return float((hash >> (which * 8u)) & 255u) * 7.84313725e-3f - 1.0f; }

// extent: radius of the mesh around its origin in sizes.
FN PlacedLeaf placeLeaf(LoadedSpan s, LeafPose pose, uint hash, float extent) {
    Frame frame = spanFrame(s.span, pose.t, s.normal0, s.normal1);
    vec3 n = frame.out1;
    float sinTurn;
    float cosTurn;
    float sinPitch;
    float cosPitch;
    sinCosExact(pose.turn, sinTurn, cosTurn);
    sinCosExact(pose.pitch, sinPitch, cosPitch);
    vec3 flat0 = frame.along * cosTurn - frame.side * sinTurn;
    vec3 y = flat0 * cosPitch + n * sinPitch;
    vec3 face = n * cosPitch - flat0 * sinPitch;

    PlacedLeaf leaf;
    leaf.size = pose.size;
    leaf.normal = n;
    if (hangs(pose.mesh)) {
        // Gravity draws the tip down along the surface; the face turns outward and to the sky. How much differs
        // from leaf to leaf, which is what makes a canopy glitter.
        vec3 up = vec3(0.0f, 1.0f, 0.0f);
        vec3 down = n * n.y - up;
        float droop = 0.30f + 0.30f * hashSigned(hash, 0u);
        y = unit3(y + down * droop + n * (0.14f + 0.14f * hashSigned(hash, 1u)));
        face = n + up * 0.45f + frame.along * (0.38f * hashSigned(hash, 2u)) + frame.side * (0.38f * hashSigned(hash, 3u));
    }
    vec3 x = cross3(y, face);
    float x2 = dot3(x, x);
    if (!(x2 > 1e-6f)) {
        x = cross3(y, n);
        x2 = dot3(x, x);
        if (!(x2 > 1e-6f)) {
            x = frame.side;
            x2 = 1.0f;
        }
    }
    leaf.axisX = x * rsqrtExact(x2);
    leaf.axisY = y;
    leaf.axisZ = cross3(leaf.axisX, leaf.axisY);
    if (hangs(pose.mesh) && dot3(leaf.axisZ, n) < 0.0f) {
        leaf.axisX = -leaf.axisX;
        leaf.axisZ = -leaf.axisZ;
    }

    // High enough that neither the tip nor a lobe dips into the wall, nor the blade into its own stem.
    float radius = s.radius0 * (1.0f - pose.t) + s.radius1 * pose.t;
    float reach = pose.size * smaller(extent, 1.2f);
    float dip = larger(-dot3(leaf.axisY, n), 0.0f) * reach + absolute(dot3(leaf.axisX, n)) * 0.5f * reach;
    leaf.height = larger(larger(pose.lift, radius * (kBarkRise + 0.6f)), dip + 0.02f * reach);
    leaf.origin = spanPoint(s.span, pose.t) + n * leaf.height;
    return leaf;
}

ESPALIER_END
#endif
