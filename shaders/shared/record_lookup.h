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
