// Reads of growth's own records: nodes, chunks and branches, after the kernels that wrote them.
#ifndef ESPALIER_SHARED_RECORD_LOOKUP_H
#define ESPALIER_SHARED_RECORD_LOOKUP_H
#include "shaders/shared/expand_env.h"

ESPALIER_BEGIN

// Where a node lies in its branch.
struct NodeArc {
    float arc;
    uint chunk, flags;
};

FN Node readNode(ExpandEnv env, uint at) { return env.nodes.v[at]; }
FN vec3 readPosition(ExpandEnv env, uint at) { return env.nodes.v[at].position; }
FN vec3 rowsTimes(vec4 r0, vec4 r1, vec4 r2, vec3 p) {
    return vec3(r0.x * p.x + r0.y * p.y + r0.z * p.z, r1.x * p.x + r1.y * p.y + r1.z * p.z,
                r2.x * p.x + r2.y * p.y + r2.z * p.z);
}
// A place on one instance as another one's object space has it.
FN vec3 seenFrom(SurfaceBuf surfaces, uint from, uint instance, vec3 p) {
    vec4 a0 = surfaces.v[from].toWorld[0];
    vec4 a1 = surfaces.v[from].toWorld[1];
    vec4 a2 = surfaces.v[from].toWorld[2];
    vec4 b0 = surfaces.v[instance].toWorld[0];
    vec4 b1 = surfaces.v[instance].toWorld[1];
    vec4 b2 = surfaces.v[instance].toWorld[2];
    // Both lie far from the origin perhaps, and near each other.
    vec3 w = rowsTimes(a0, a1, a2, p) + vec3(a0.w - b0.w, a1.w - b1.w, a2.w - b2.w);
    vec3 turned = vec3(b0.x * w.x + b1.x * w.y + b2.x * w.z, b0.y * w.x + b1.y * w.y + b2.y * w.z,
                       b0.z * w.x + b1.z * w.y + b2.z * w.z);
    float scale = surfaces.v[instance].scale;
    return turned * rcpExact(scale * scale);
}
// A node's position, in the object space of the instance that this place is on.
FN vec3 readPositionFrom(ExpandEnv env, uint at, uint place) {
    vec3 p = readPosition(env, at);
    uint from = env.nodes.v[at].place >> 16u;
    uint instance = place >> 16u;
    if (from != instance) p = seenFrom(env.surfaces, from, instance, p);
    return p;
}
FN NodeArc readArc(ExpandEnv env, uint at) {
    NodeArc a = {};
    a.arc = env.nodes.v[at].arc;
    a.chunk = env.nodes.v[at].chunk;
    a.flags = loadShared(env.nodes.v[at].flags);
    return a;
}
FN u64 readKey(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].key; }
FN uint readBranchOf(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].branch; }
FN uint readFirstNode(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].firstNode; }
FN uint readMarks(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].marks; }
FN BranchRecord readBranch(ExpandEnv env, uint at) { return env.branches.v[at]; }

ESPALIER_END
#endif
