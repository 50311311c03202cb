// In: growth's buffers by pointer. Out: the records that the kernels leave. Items of a wave are taken by whichever
// thread is free; places are drawn by atomics as on a GPU, so records' order differs between runs of several threads.
#include "runtime/host/finish.hpp"
#include "runtime/host/march.hpp"
#include "shaders/shared/expand_avoid.h"
#include "shaders/shared/expand_fit.h"

namespace espalier {
namespace {

constexpr size_t kNodesAtOnce = 1024, kBranchesAtOnce = 1024, kChunksAtOnce = 16;

void finishNodes(ExpandEnv env, size_t begin, size_t end) {
    const UintBuf firstLeaves = env.status.v[0].firstLeaves;
    const auto keep = [&](size_t i, const NodeFinish& finish) {
        if (env.phase != kTerminalsWrite) return;
        keepFinish(env.nodes, uint32_t(i), finish);
        if (IS_GIVEN(firstLeaves)) firstLeaves.v[i] = finish.firstLeaf;
    };
    const uvec2 hash = finishEach(
        env, begin, end, [](size_t i) { return uint32_t(i); }, keep);
    addHash(env, uint32_t(begin / kNodesAtOnce), hash);
}

// The same where stems that came too near to others have left gaps.
void finishStanding(ExpandEnv env, size_t begin, size_t end) {
    const UintBuf firstLeaves = env.status.v[0].firstLeaves;
    for (size_t first = begin; first < end; ++first) {
        const size_t start = first;
        while (first < end && !isGap(env.nodes.v[first])) ++first;
        if (first > start) finishNodes(env, start, first);
        if (first < end && IS_GIVEN(firstLeaves)) firstLeaves.v[first] = kNoIndex;
    }
}

ESPALIER_WHOLE void fitNodes(ExpandEnv env, size_t begin, size_t end) {
    uvec2 hash(0, 0);
    for (size_t i = begin; i < end; ++i)
        if (!isGap(env.nodes.v[i])) hash += fitNode(env, uint32_t(i));
    addHash(env, uint32_t(begin / kNodesAtOnce), hash);
}

// Of run.groups grammars.
void packTables(ExpandEnv env, const HostRun& run) {
    for (uint32_t i = 0; i < run.groups; ++i) packGrammar(env.grammars, env.tables, i, 0, 1);
}

void terminals(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    const GrowStatus& s = env.status.v[0];
    overRange(s.frozenNodes, s.nodes, kNodesAtOnce, run.crew, [&](size_t begin, size_t end) {
        if (goesOn(run.watch, s.nodes)) avoids(env) ? finishStanding(env, begin, end) : finishNodes(env, begin, end);
    });
}

void branches(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    const GrowStatus& s = env.status.v[0];
    overRange(s.frozenBranches, s.branches, kBranchesAtOnce, run.crew, [&](size_t begin, size_t end) {
        for (uint32_t i = uint32_t(begin); i < end; ++i) {
            if (env.branches.v[i].firstChunk == kNoIndex) continue;
            if (env.phase == kTerminalsJoints)
                sumJoint(env, i);
            else
                env.branches.v[i].thickness = thicknessOf(env, i);
        }
    });
}

void fit(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    const GrowStatus& s = env.status.v[0];
    overRange(s.frozenNodes, s.nodes, kNodesAtOnce, run.crew,
              [&](size_t begin, size_t end) { fitNodes(env, begin, end); });
}

// Chunks that the latest wave has begun.
template <class Body>
void overWaveChunks(const ExpandEnv& env, Crew& crew, const Body& body) {
    const GrowStatus& s = env.status.v[0];
    overRange(s.waveFirst, s.chunks, kChunksAtOnce, crew, [&](size_t begin, size_t end) {
        for (uint32_t chunk = uint32_t(begin); chunk < end; ++chunk) body(chunk);
    });
}

void lookForOthers(ExpandEnv env, const HostRun& run) {
    if (!roomForNodes(env)) return;
    overWaveChunks(env, run.crew, [&](uint32_t chunk) {
        beginBounds(env, chunk);
        const uint32_t first = readFirstNode(env, chunk);
        const uint32_t count = entersGrid(env, chunk) ? chunkNodes(env.chunks.v[chunk].marks) : 0;
        for (uint32_t i = 0; i < count; ++i) enterSpan(env, first + i);
    });
}

// One round of an undecided chunk.
void decideChunk(const ExpandEnv& env, uint32_t chunk, uint32_t known) {
    const AvoidSite site = avoidSite(env, chunk);
    const uint32_t count = chunkNodes(env.chunks.v[chunk].marks);
    const bool again = mayTryAgain(env, chunk, known);
    Found spans = {mostOf(known), mostOf(known), mostOf(known)};
    for (uint32_t i = leastOf(known); i < std::min(spans.falls, spans.yields); ++i) {
        const uint32_t verdict = verdictOf(env, site, spanAt(env, site.firstNode + i, site.base));
        if (verdict == kSpanFalls) spans.falls = i;
        if (verdict == kSpanYields) spans.yields = i;
        if (verdict == kSpanWaits) spans.waits = std::min(spans.waits, i);
    }
    const uint32_t found = boundsAfter(env, site, known, spans, again);
    if (isDecided(found)) {
        const uint32_t previousNode = env.chunks.v[chunk].previousNode;
        for (uint32_t i = mostOf(found); i < count; ++i) cutNode(env, site.firstNode + i, previousNode);
        endDecision(env, chunk, found, count, again && spans.yields < spans.falls);
    }
    STORE_SHARED(env.status.v[0].avoidBounds.v[chunk], found);
}

void decide(ExpandEnv env, const HostRun& run) {
    if (!roomToAvoid(env)) return;
    overWaveChunks(env, run.crew, [&](uint32_t chunk) {
        const uint32_t known = env.status.v[0].avoidBounds.v[chunk];
        if (!isDecided(known)) decideChunk(env, chunk, known);
    });
}

void settle(ExpandEnv env, const HostRun& run) {
    const bool room = roomToAvoid(env);
    const auto stopped = [&] { return run.watch && run.watch->stopped(); };
    while (room && env.status.v[0].waveUndecided > 0 && !stopped()) decide(env, run);
    endDecisions(env, room);
}

constexpr HostRow kRows[] = {{"expand/tables.comp", passOf<ExpandEnv, packTables>},
                             {"expand/march.comp", waveOf<ExpandEnv, growWave>},
                             {"expand/march_paper.comp", waveOf<ExpandEnv, growWave>},
                             {"expand/terminals.comp", passOf<ExpandEnv, terminals>},
                             {"expand/branches.comp", passOf<ExpandEnv, branches>},
                             {"expand/fit.comp", passOf<ExpandEnv, fit>},
                             {"expand/avoid_look.comp", passOf<ExpandEnv, lookForOthers>},
                             {"expand/avoid_decide.comp", passOf<ExpandEnv, decide>},
                             {"expand/avoid_settle.comp", passOf<ExpandEnv, settle>}};

}  // namespace

const std::span<const HostRow> kGrowthRows = kRows;

}  // namespace espalier
