// The passes of a regrowth in their order (expand_again.h). In: growth's buffers by pointer, an edit's. Out: what the
// kernels leave there.
#include "runtime/expand/native_growth.hpp"

// Text that ESPALIER_AGAIN changes must not be taken for native_growth.cpp's by the linker.
#undef FN
#define FN static inline
#define ESPALIER_AGAIN
#include "runtime/expand/native_finish.hpp"
#include "runtime/expand/native_march.hpp"
#include "shaders/expand/again_apply.h"
#include "shaders/expand/again_find.h"
#include "shaders/expand/again_fit.h"
#include "shaders/expand/again_settle.h"
#include "shaders/expand/again_start.h"
#include "shaders/expand/again_terminals.h"
#include "shaders/expand/again_work.h"

namespace espalier {
namespace {

constexpr size_t kChunksAtOnce = 1024, kEntriesAtOnce = 64, kWorkAtOnce = 512;

void finishWork(ExpandEnv env, size_t begin, size_t end) {
    const UintBuf results = AGAIN.results, firstLeaves = env.status.v[0].firstLeaves;
    const uint32_t capacity = AGAIN.resultCapacity;
    const uvec2 hash = finishEach(
        env, begin, end, [&](size_t i) { return workNode(results, uint32_t(i)); },
        [&](size_t i, const NodeFinish& finish) {
            keepAgain(env, results, capacity, uint32_t(i), firstLeaves, finish);
        });
    addHash(env, uint32_t(begin / kWorkAtOnce), hash);
}

// each(i, tally) for what is taken out, from [0, count).
template <class Each>
void takeEach(ExpandEnv env, uint32_t count, size_t grain, Crew& crew, const Each& each) {
    overRange(0, count, grain, crew, [&](size_t begin, size_t end) {
        GoneTally tally = nothingGone();
        for (size_t i = begin; i < end; ++i) each(uint32_t(i), tally);
        addGone(env, uint32_t(begin / grain), tally);
    });
}

void apply(ExpandEnv env, Crew& crew) {
    const LeafChains chains = {env.status.v[0].firstLeaves, env.status.v[0].nextLeaves};
    const ChunkBuf before = AGAIN.chunksBefore;
    const auto takeChunk = [&](uint32_t chunk, GoneTally& tally) {
        const ChunkBefore was = readBefore(before, chunk);
        for (uint32_t lane = 0; lane < std::max(1u, chunkNodes(was.marks)); ++lane)
            takeOut(env, chains, was, lane, tally);
    };
    takeEach(env, AGAIN.counts[kListWork], kWorkAtOnce, crew, [&](uint32_t i, GoneTally& tally) {
        applyResult(env, chains, AGAIN.results, AGAIN.resultCapacity, i, tally);
    });
    takeEach(env, listed(env, kListGrown), kEntriesAtOnce, crew, [&](uint32_t i, GoneTally& tally) {
        const uint32_t chunk = listEntry(env, kListGrown, i);
        if ((AGAIN_MARKS.v[chunk].bits & kMarkAgain) != 0) takeChunk(chunk, tally);
    });
    takeEach(env, listed(env, kListGone), kEntriesAtOnce, crew, [&](uint32_t i, GoneTally& tally) {
        const uint32_t chunk = listEntry(env, kListGone, i);
        takeChunk(chunk, tally);
        env.chunks.v[chunk].marks = 0;
    });
}

void fit(ExpandEnv env, Crew& crew) {
    overRange(0, listed(env, kListFit), kEntriesAtOnce, crew, [&](size_t begin, size_t end) {
        uvec2 hash(0, 0);
        for (size_t i = begin; i < end; ++i) {
            const uint32_t chunk = listEntry(env, kListFit, uint32_t(i));
            const ChunkBrief brief = readBrief(env, chunk);
            for (uint32_t lane = 0; lane < chunkNodes(brief.marks); ++lane)
                fitAgain(env, AGAIN.branchesBefore, chunk, brief, lane, hash);
        }
        addHash(env, uint32_t(begin / kEntriesAtOnce), hash);
    });
    for (uint32_t i = AGAIN.leafCount; i < env.status.v[0].leaves; ++i) showLeaf(env, i);
}

// each(i) over the entries of a list.
template <class Each>
void overList(ExpandEnv env, uint32_t list, Crew& crew, const Each& each) {
    overRange(0, listed(env, list), kEntriesAtOnce, crew, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) each(uint32_t(i));
    });
}

}  // namespace

void findNative(ExpandEnv env, Crew& crew) {
    const EditHead head = editHead(env);
    std::copy_n(AGAIN.branchesBefore.v, AGAIN.branchCount, env.branches.v);
    overRange(0, AGAIN.chunkCount, kChunksAtOnce, crew, [&](size_t begin, size_t end) {
        std::copy(AGAIN.chunksBefore.v + begin, AGAIN.chunksBefore.v + end, env.chunks.v + begin);
        for (size_t c = begin; c < end; ++c) findChunk(env, head, uint32_t(c));
    });
    const UintBuf first = env.status.v[0].firstLeaves, next = env.status.v[0].nextLeaves;
    for (uint32_t i = AGAIN.chainedLeaves; i < AGAIN.leafCount; ++i) chainAgain(env, first, next, i);
    overList(env, kListDirty, crew, [&](uint32_t i) { startAgain(env, i); });
}

uint32_t marchAgainNative(ExpandEnv env, const ItemQueues& queues, uint32_t most, Crew& crew) {
    return march(env, queues, most, crew, true);
}

void finishAgainNative(ExpandEnv env, Crew& crew) {
    if (!complete(env)) return;
    overList(env, kListGrown, crew, [&](uint32_t i) { settleAgain(env, AGAIN.chunksBefore, i); });
    overList(env, kListBranches, crew, [&](uint32_t i) { workAgain(env, i); });
    const uint32_t work = AGAIN.counts[kListWork];
    if (work > AGAIN.resultCapacity) AGAIN.overrun = 1;
    if (AGAIN.overrun != 0) return;
    env.phase = kTerminalsAgain;
    overRange(0, work, kWorkAtOnce, crew, [&](size_t begin, size_t end) { finishWork(env, begin, end); });
    if (!holds(env)) return;
    apply(env, crew);
    overList(env, kListKin, crew, [&](uint32_t i) { thickenAgain(env, i); });
    fit(env, crew);
}

}  // namespace espalier
