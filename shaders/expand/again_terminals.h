// Terminals of a regrowth's nodes: leaves as pending ones, and the rest aside for nodes that are drawn already, since it
// may yet prove too much.
#ifndef ESPALIER_EXPAND_AGAIN_TERMINALS_H
#define ESPALIER_EXPAND_AGAIN_TERMINALS_H
#include "shaders/expand/again.h"
#include "shaders/shared/expand_terminals.h"

ESPALIER_BEGIN

// Node i of the work; see AgainState::results.
FN uint workNode(UintBuf results, uint i) { return results.v[i] & ~kResultKept; }
FN void keepAgain(ExpandEnv env, UintBuf results, uint capacity, uint i, UintBuf firstLeaves, NodeFinish finish) {
    uint index = results.v[i];
    if ((index & kResultKept) != 0u) {
        uint at = capacity + kResultWords * i;
        results.v[at] = finish.tangent;
        results.v[at + 1u] = finish.flags;
        results.v[at + 2u] = floatBitsToUint(finish.radius);
        results.v[at + 3u] = finish.firstLeaf;
    } else {
        keepFinish(env.nodes, index, finish);
        firstLeaves.v[index] = finish.firstLeaf;
    }
}

ESPALIER_END
#endif
