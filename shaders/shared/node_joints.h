// A tree of joints: each carries as many smaller ones at its end. A joint follows from its number alone: the number
// tells its parents down to the root, and from the root up each parent's place follows from the one before. So all
// joints are made at once, and more levels change none.
#ifndef ESPALIER_SHARED_NODE_JOINTS_H
#define ESPALIER_SHARED_NODE_JOINTS_H
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

struct JointArgs {
    NodePlanes to, ends;          // where joints begin; where those of the last level end
    UintBuf normals, endNormals;  // octahedral: their directions
    FloatBuf sizes;               // m: how long they are
    uint count, firstEnd;         // of joints; the first of the last level
    uint branches, seed;
    float trunk, shrink;  // m: of the first; of each next level, as a share
    float angle, spread;  // rad: from one to its child; how far angles, turns and lengths differ, as a share
    float perBranch;      // 1 / branches
    uint spare;
};
STATIC_SIZE(JointArgs, 96);

struct Joint {
    vec3 at, along, side;  // side: a unit vector across it
    float span;            // m: how long it is
};
FN Joint firstJoint(JointArgs a) {
    Joint j;
    j.at = vec3(0.0f);
    j.along = vec3(0.0f, 1.0f, 0.0f);
    j.side = vec3(1.0f, 0.0f, 0.0f);
    j.span = a.trunk;
    return j;
}
FN vec3 endOf(Joint j) {
    return j.at + j.along * j.span;
}

FN float jointSpread(JointArgs a, uint i, uint site) {
    return a.spread * (2.0f * nodeRandom(a.seed, i, site) - 1.0f);
}
// Joint i, which is the child of that number. Children stand around, and turn by the golden angle from level to level,
// so that none hides another.
FN Joint childOf(JointArgs a, Joint j, uint child, uint i) {
    float s;
    float c;
    sinCosExact(6.28318531f * a.perBranch * (float(int(child)) + 0.5f * jointSpread(a, i, 0u)) + 2.39996323f, s, c);
    vec3 across = j.side * c + cross3(j.along, j.side) * s;
    sinCosExact(a.angle * (1.0f + jointSpread(a, i, 1u)), s, c);
    Joint next;
    next.at = endOf(j);
    next.along = unit3(j.along * c + across * s);
    next.side = unit3(across * c - j.along * s);
    next.span = j.span * a.shrink * (1.0f + 0.5f * jointSpread(a, i, 2u));
    return next;
}

FN Joint jointAt(JointArgs a, uint i) {
    uint level = 0u;
    uint first = 0u;  // of the level
    uint many = 1u;   // joints of the level
    for (; i - first >= many; ++level) {
        first += many;
        many *= a.branches;
    }
    uint inLevel = i - first;
    Joint j = firstJoint(a);
    first = 0u;
    uint above = 1u;
    for (uint k = 0u; k < level; ++k) {
        many /= a.branches;
        first += above;
        above *= a.branches;
        uint ancestor = inLevel / many;
        j = childOf(a, j, ancestor % a.branches, first + ancestor);
    }
    return j;
}
FN void placeJoint(JointArgs a, uint i) {
    Joint j = jointAt(a, i);
    putVector(a.to, i, j.at);
    a.normals.v[i] = packOct(j.along);
    a.sizes.v[i] = j.span;
    if (i < a.firstEnd) return;
    putVector(a.ends, i - a.firstEnd, endOf(j));
    a.endNormals.v[i - a.firstEnd] = packOct(j.along);
}

ESPALIER_END
#endif
