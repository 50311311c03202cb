// The passes of a regrowth in their order (expand_again.h). In: growth's buffers by pointer, an edit's. Out: what the
// kernels leave there.
#include "runtime/host/kernels.hpp"
#include "shaders/shared/expand_env.h"

// Text that ESPALIER_AGAIN changes must not be taken for growth.cpp's by the linker.
#undef FN
#define FN static inline
#define ESPALIER_AGAIN
#include "runtime/host/finish.hpp"
#include "runtime/host/march.hpp"
#include "shaders/expand/again_apply.h"
#include "shaders/expand/again_find.h"
#include "shaders/expand/again_fit.h"
#include "shaders/expand/again_settle.h"
#include "shaders/expand/again_start.h"
#include "shaders/expand/again_terminals.h"
#include "shaders/expand/again_work.h"

namespace espalier {
namespace {

constexpr size_t kChunksAtOnce = 1024, kEntriesAtOnce = 64, kWorkAtOnce = 512, kCacheLine = 64, kAhead = 4;

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

// Records of an edit's chunks lie far apart: they are asked for some chunks before they are looked at.
template <class Record>
void fetch(const Record* records, size_t count) {
    const char* at = reinterpret_cast<const char*>(records);
    for (const char* end = at + count * sizeof(Record); at < end; at += kCacheLine) ESPALIER_WILL_WRITE(at);
}
void fetchLeaves(const ExpandEnv& env, const LeafChains& chains, const ChunkBefore& was) {
    for (uint32_t lane = 0; lane < chunkNodes(was.marks); ++lane) {
        const uint32_t leaf = chains.first.v[was.firstNode + lane];
        if (leaf == kNoIndex) continue;
        fetch(&env.leaves.v[leaf], 1);
        fetch(&chains.next.v[leaf], 1);
    }
}
void fetchNodes(const ExpandEnv& env, const LeafChains& chains, const ChunkBefore& was) {
    const uint32_t first = was.firstNode, count = chunkNodes(was.marks);
    fetch(env.nodes.v + first, count);
    fetch(chains.first.v + first, count);
    fetch(AGAIN.touched.v + first, count);
}

size_t piecesOf(size_t count, size_t grain) {
    return (count + grain - 1) / grain;
}

// Takes out what the chunks of a piece of a list were, as far as they aren't any more.
void takeChunks(ExpandEnv env, const LeafChains& chains, uint32_t list, size_t piece, GoneTally& tally) {
    ChunkBefore were[kEntriesAtOnce];
    size_t count = 0;
    const size_t begin = piece * kEntriesAtOnce, end = std::min<size_t>(begin + kEntriesAtOnce, listed(env, list));
    for (size_t i = begin; i < end; ++i) {
        const uint32_t chunk = listEntry(env, list, uint32_t(i));
        if (list == kListGone) env.chunks.v[chunk].marks = 0;
        if (list == kListGone || (AGAIN_MARKS.v[chunk].bits & kMarkAgain) != 0)
            were[count++] = readBefore(AGAIN.chunksBefore, chunk);
    }
    for (size_t i = 0; i < count + 2 * kAhead; ++i) {
        if (i < count) fetchNodes(env, chains, were[i]);
        if (i - kAhead < count) fetchLeaves(env, chains, were[i - kAhead]);
        if (i < 2 * kAhead) continue;
        const ChunkBefore& was = were[i - 2 * kAhead];
        for (uint32_t lane = 0; lane < std::max(1u, chunkNodes(was.marks)); ++lane)
            takeOut(env, chains, was, lane, tally);
    }
}

void applyResults(ExpandEnv env, const LeafChains& chains, size_t piece, GoneTally& tally) {
    const size_t begin = piece * kWorkAtOnce, end = std::min<size_t>(begin + kWorkAtOnce, AGAIN.counts[kListWork]);
    for (size_t i = begin; i < end; ++i)
        applyResult(env, chains, AGAIN.results, AGAIN.resultCapacity, uint32_t(i), tally);
}

// each(i) over the entries of a list.
template <class Each>
void overList(ExpandEnv env, uint32_t list, Crew& crew, const Each& each) {
    overRange(0, listed(env, list), kEntriesAtOnce, crew, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) each(uint32_t(i));
    });
}

// Copies the links that are drawn to env's as it looks at them.
void find(ExpandEnv env, const HostRun& run) {
    const EditHead head = editHead(env);
    std::copy_n(AGAIN.branchesBefore.v, AGAIN.branchCount, env.branches.v);
    overRange(0, AGAIN.chunkCount, kChunksAtOnce, run.crew, [&](size_t begin, size_t end) {
        std::copy(AGAIN.chunksBefore.v + begin, AGAIN.chunksBefore.v + end, env.chunks.v + begin);
        for (size_t c = begin; c < end; ++c) findChunk(env, head, uint32_t(c));
    });
}

// Sooner done than shared out.
void start(ExpandEnv env, const HostRun&) {
    const UintBuf first = env.status.v[0].firstLeaves, next = env.status.v[0].nextLeaves;
    for (uint32_t i = AGAIN.chainedLeaves; i < AGAIN.leafCount; ++i) chainAgain(env, first, next, i);
    for (uint32_t i = 0; i < listed(env, kListDirty); ++i) startAgain(env, i);
}

void settle(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    overList(env, kListGrown, run.crew, [&](uint32_t i) { settleAgain(env, AGAIN.chunksBefore, i); });
}

void work(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    overList(env, kListBranches, run.crew, [&](uint32_t i) { workAgain(env, i); });
}

void terminals(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    const uint32_t work = AGAIN.counts[kListWork];
    if (work > AGAIN.resultCapacity) AGAIN.overrun = 1;
    if (AGAIN.overrun != 0) return;
    overRange(0, work, kWorkAtOnce, run.crew, [&](size_t begin, size_t end) { finishWork(env, begin, end); });
}

void apply(ExpandEnv env, const HostRun& run) {
    if (!holds(env)) return;
    const LeafChains chains = {env.status.v[0].firstLeaves, env.status.v[0].nextLeaves};
    const size_t gone = piecesOf(listed(env, kListGone), kEntriesAtOnce),
                 grown = gone + piecesOf(listed(env, kListGrown), kEntriesAtOnce),
                 all = grown + piecesOf(AGAIN.counts[kListWork], kWorkAtOnce);
    run.crew.overRange(all, 1, [&](size_t piece, size_t) {
        GoneTally tally = nothingGone();
        if (piece < gone)
            takeChunks(env, chains, kListGone, piece, tally);
        else if (piece < grown)
            takeChunks(env, chains, kListGrown, piece - gone, tally);
        else
            applyResults(env, chains, piece - grown, tally);
        addGone(env, uint32_t(piece), tally);
    });
}

void thickness(ExpandEnv env, const HostRun& run) {
    if (!holds(env)) return;
    overList(env, kListKin, run.crew, [&](uint32_t i) { thickenAgain(env, i); });
}

void fit(ExpandEnv env, const HostRun& run) {
    if (!holds(env)) return;
    overRange(0, listed(env, kListFit), kEntriesAtOnce, run.crew, [&](size_t begin, size_t end) {
        ChunkBrief briefs[kEntriesAtOnce];
        const size_t count = end - begin;
        for (size_t i = 0; i < count; ++i)
            briefs[i] = readChunkBrief(env.chunks, listEntry(env, kListFit, uint32_t(begin + i)));
        uvec2 hash(0, 0);
        for (size_t i = 0; i < count + kAhead; ++i) {
            if (i < count) fetch(env.nodes.v + briefs[i].firstNode, chunkNodes(briefs[i].marks));
            if (i < kAhead) continue;
            const ChunkBrief& brief = briefs[i - kAhead];
            const uint32_t chunk = listEntry(env, kListFit, uint32_t(begin + i - kAhead));
            for (uint32_t lane = 0; lane < chunkNodes(brief.marks); ++lane)
                fitAgain(env, AGAIN.branchesBefore, chunk, brief, lane, hash);
        }
        addHash(env, uint32_t(begin / kEntriesAtOnce), hash);
    });
    for (uint32_t i = AGAIN.leafCount; i < env.status.v[0].leaves; ++i) showLeaf(env, i);
}

constexpr HostRow kRows[] = {{"expand/again_find.comp", passOf<ExpandEnv, find>},
                             {"expand/again_start.comp", passOf<ExpandEnv, start>},
                             {"expand/march_again.comp", waveOf<ExpandEnv, growWave>},
                             {"expand/again_settle.comp", passOf<ExpandEnv, settle>},
                             {"expand/again_work.comp", passOf<ExpandEnv, work>},
                             {"expand/terminals_again.comp", passOf<ExpandEnv, terminals>},
                             {"expand/again_apply.comp", passOf<ExpandEnv, apply>},
                             {"expand/again_thickness.comp", passOf<ExpandEnv, thickness>},
                             {"expand/again_fit.comp", passOf<ExpandEnv, fit>}};

}  // namespace

const std::span<const HostRow> kRegrowthRows = kRows;

}  // namespace espalier
