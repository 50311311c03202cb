// In: nodes with their neighbours, leaves as their terminals gave them, a lane each. Out: what records keep of them.
// Loops over all lanes call text without branches, of which the compiler makes vectors (CMakeLists.txt lets it).
#include "runtime/expand/wide_nodes.hpp"

#include "shaders/shared/expand_terminals.h"

// Wider vectors where the machine has them; no fused operations, so the bits are the same.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define ESPALIER_LANES __attribute__((flatten, target_clones("avx2", "default")))
#else
#define ESPALIER_LANES __attribute__((flatten))
#endif

namespace espalier {
namespace {

vec3 vectorOf(const WideStems::Vectors& v, uint32_t i) {
    return {v.x[i], v.y[i], v.z[i]};
}
void put(WideStems::Vectors& to, uint32_t i, vec3 v) {
    to.x[i] = v.x;
    to.y[i] = v.y;
    to.z[i] = v.z;
}

}  // namespace

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
