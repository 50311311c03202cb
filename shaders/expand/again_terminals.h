// Terminals of a regrowth's nodes: leaves as pending ones, the rest aside, since it may yet prove too much.
#ifndef ESPALIER_EXPAND_AGAIN_TERMINALS_H
#define ESPALIER_EXPAND_AGAIN_TERMINALS_H
#include "shaders/expand/again.h"
#include "shaders/shared/expand_terminals.h"

ESPALIER_BEGIN

// Node i of the work; see AgainState::results.
FN void finishAgain(MACHINE_PARAM ExpandEnv env, UintBuf results, uint i, INOUT(uvec2) hash) {
    uint at = kResultWords * i;
    NodeFinish finish = finishNode(MACHINE env, results.v[at], hash);
    results.v[at + 1u] = finish.tangent;
    results.v[at + 2u] = finish.flags;
    results.v[at + 3u] = floatBitsToUint(finish.radius);
    results.v[at + 4u] = finish.firstLeaf;
}

ESPALIER_END
#endif
