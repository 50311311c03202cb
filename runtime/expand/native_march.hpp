#pragma once

// What growth and regrowth as native code share: of the text that ESPALIER_AGAIN makes two of, each of the two files
// that include this has its own.

#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "runtime/expand/native_growth.hpp"
#include "shaders/shared/expand_grow.h"

// All of a pass in one function: its state stays in registers, and pointers needn't be handed on.
#define ESPALIER_WHOLE __attribute__((flatten))

namespace espalier {
namespace {

constexpr size_t kItemsAtOnce = 8;

ESPALIER_WHOLE void growItems(ExpandEnv env, size_t begin, size_t end) {
    uint32_t stage[kChunkNodes * kStagedWords];
    env.scratch = {stage};
    GrowthTally tally = emptyTally();
    Machine machine;
    for (size_t i = begin; i < end; ++i) {
        ChunkGrowth c;
        if (!beginChunk(machine, env, env.items.v[i], c)) continue;
        while (growing(c.g)) growOn(machine, env, c);
        endChunk(env, c, tally);
    }
    addTally(env, tally);
}

// body(begin, end) over [first, last).
template <class Body>
void overRange(uint32_t first, uint32_t last, size_t grain, unsigned threads, const Body& body) {
    parallelFor(
        last > first ? last - first : 0, grain, [&](size_t begin, size_t end) { body(first + begin, first + end); },
        threads);
}

// See marchNative.
uint32_t march(ExpandEnv env, const ItemQueues& queues, uint32_t most, unsigned threads) {
    uint32_t w = env.wave;
    for (; w < most && env.waves.v[w].count > 0; ++w) {
        env.wave = w;
        env.items = {queues[w & 1]};
        env.nextItems = {queues[(w + 1) & 1]};
        const uint32_t wanted = env.waves.v[w].count, count = std::min(wanted, env.itemCapacity);
        if (wanted > count) atomicMax(env.status.v[0].items, wanted);
        parallelFor(
            count, kItemsAtOnce, [&](size_t begin, size_t end) { growItems(env, begin, end); }, threads);
    }
    return w;
}

}  // namespace
}  // namespace espalier
