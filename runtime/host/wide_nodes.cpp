// In: nodes with their neighbours, leaves as their terminals gave them, a lane each. Out: what records keep of them.
// Loops over all lanes call text without branches, of which the compiler makes vectors (CMakeLists.txt lets it).
#include "runtime/host/wide_nodes.hpp"

#include "shaders/shared/expand_terminals.h"

namespace espalier {

ESPALIER_LANES void frameStems(WideStems& l) {
    for (uint32_t i = 0; i < kNodeLanes; ++i) {
        const StemFrame f = stemFrame(vectorOf(l.before, i), vectorOf(l.at, i), vectorOf(l.after, i),
                                      vectorOf(l.branches, i), l.packedNormal[i], l.packedHeading[i]);
        put(l.normal, i, f.normal);
        put(l.heading, i, f.heading);
        l.tangent[i] = f.tangent;
    }
}

ESPALIER_LANES void packLeaves(WideLeaves& l) {
    for (uint32_t i = 0; i < kLeafLanes; ++i) {
        const Leaf leaf = leafOf({l.along[i], l.span[i], l.size[i], l.lift[i], l.turn[i], l.pitch[i], l.tint[i],
                                  l.mesh[i], l.colour[i], l.word[i]});
        l.packedPlace[i] = leaf.place;
        l.packedPose[i] = leaf.pose;
        l.packedTint[i] = leaf.tint;
    }
}

}  // namespace espalier
