// Terminals of a regrowth's nodes: leaves as pending ones, the rest aside, since it may yet prove too much.
#ifndef ESPALIER_EXPAND_AGAIN_TERMINALS_H
#define ESPALIER_EXPAND_AGAIN_TERMINALS_H
#include "shaders/expand/again.h"
#include "shaders/shared/expand_terminals.h"

ESPALIER_BEGIN

// Node i of the work; see AgainState::results.
FN uint workNode(UintBuf results, uint i) { return results.v[kResultWords * i]; }
FN void keepAgain(UintBuf results, uint i, NodeFinish finish) {
    uint at = kResultWords * i;
    results.v[at + 1u] = finish.tangent;
    results.v[at + 2u] = finish.flags;
    results.v[at + 3u] = floatBitsToUint(finish.radius);
    results.v[at + 4u] = finish.firstLeaf;
}

ESPALIER_END
#endif
