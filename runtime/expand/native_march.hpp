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

constexpr size_t kItemsAtOnce = 8;  // of a long queue

// Has the processor fetch the texels about uv and what a patch there may read besides: growth waits for memory as much
// as it computes, and knows a rule earlier about where it will be. A hint; gone wrong, it costs a little time.
inline void expectTexels(const SurfaceLevel& level, vec2 uv, bool border) {
    const float last = float(level.size) - 1.0f;
    const uint x = uint(inRange(uv.x * float(level.size) - 1.5f, last - 3.0f));
    const uint y = uint(inRange(uv.y * float(level.size) - 1.5f, last - 3.0f));
    const uint near1 = texelColumn(x), far1 = texelColumn(x + 3u);
    for (uint row = 0; row < 4; ++row) {
        const uint at = texelRow(level.size, y + row);
        __builtin_prefetch(level.texels.v + at + near1);
        __builtin_prefetch(level.texels.v + at + far1);
        if (row == 1 || row == 2) __builtin_prefetch(level.aux.v + at + near1);
        if (border && (row == 1 || row == 2)) __builtin_prefetch(level.crossingHead.v + at + near1);
    }
}

// A walk that goes on as it has come.
inline void expectNext(const ExpandEnv& env, const Grower& g) {
    const SurfaceLevel& level = env.surfaces.v[g.trial.walk.place >> 16u].levels[g.trial.level];
    const vec2 uv = g.trial.walk.uv, step = uv - g.at.walk.uv;
    expectTexels(level, uv + step, g.trial.clear * g.trial.clear <= dot2(step, step) * 4.0f);
}

ESPALIER_WHOLE void growItems(ExpandEnv env, size_t begin, size_t end) {
    uint32_t stage[kChunkNodes * kStagedWords];
    env.scratch = {stage};
    GrowthTally tally = emptyTally();
    Machine machine;
    for (size_t i = end; i-- > begin;) {
        ChunkGrowth c;
        if (!beginChunk(machine, env, env.items.v[i], c)) continue;
        if (i > begin) {
            const Walk& next = env.items.v[i - 1].walk;
            expectTexels(env.surfaces.v[next.place >> 16u].levels[c.site.level], next.uv, true);
        }
        while (growing(c.g)) {
            growOn(machine, env, c);
            if (c.g.arrived) expectNext(env, c.g);
        }
        endChunk(env, c, tally);
    }
    addTally(env, tally);
}

// body(begin, end) over [first, last).
template <class Body>
void overRange(uint32_t first, uint32_t last, size_t grain, Crew& crew, const Body& body) {
    crew.overRange(last > first ? last - first : 0, grain,
                   [&](size_t begin, size_t end) { body(first + begin, first + end); });
}

// See marchNative. The last items are grown first: at their end chunks queue what carries a long branch on, and a long
// one at the end of a wave would keep the others waiting.
uint32_t march(ExpandEnv env, const ItemQueues& queues, uint32_t most, unsigned threads) {
    Crew crew(threads);
    uint32_t w = env.wave;
    for (; w < most && env.waves.v[w].count > 0; ++w) {
        env.wave = w;
        env.items = {queues[w & 1]};
        env.nextItems = {queues[(w + 1) & 1]};
        const uint32_t wanted = env.waves.v[w].count, count = std::min(wanted, env.itemCapacity);
        if (wanted > count) atomicMax(env.status.v[0].items, wanted);
        const size_t grain = std::clamp<size_t>(count / (8 * crew.threads()), 1, kItemsAtOnce);
        crew.overRange(count, grain, [&](size_t begin, size_t end) { growItems(env, count - end, count - begin); });
    }
    return w;
}

}  // namespace
}  // namespace espalier
