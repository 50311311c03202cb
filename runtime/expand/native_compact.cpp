// Closing gaps as native code (shaders/expand/compact.h). In: what is drawn, by pointer. Out: the same without gaps, in
// the order of chunks, so that what lies together goes together.
#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "runtime/expand/native_growth.hpp"

namespace espalier {
namespace {

constexpr size_t kChunksAtOnce = 1024, kLeavesAtOnce = 8192;

}  // namespace

void compactNative(CompactEnv env, unsigned threads) {
    Crew crew(threads);
    for (uint32_t c = 0; c < env.chunkCount; ++c) placeChunk(env, c);
    crew.overRange(env.chunkCount, kChunksAtOnce, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c)
            for (uint32_t lane = 0; lane < std::max(1u, chunkNodes(env.chunks.v[c].marks)); ++lane)
                moveNode(env, uint32_t(c), lane);
    });
    crew.overRange(env.leafCount, kLeavesAtOnce, [&](size_t begin, size_t end) {
        const auto stays = [](const Leaf& leaf) { return leaf.node != kNoIndex; };
        const auto count = std::count_if(env.leaves.v + begin, env.leaves.v + end, stays);
        uint32_t to = atomicAdd(env.status.v[0].leaves, uint32_t(count));
        for (size_t i = begin; i < end; ++i) {
            if (stays(env.leaves.v[i]))
                moveLeaf(env, uint32_t(i), to++);
            else
                env.leavesWent.v[i] = kNoIndex;
        }
    });
}

}  // namespace espalier
