// In: growth's buffers by pointer. Out: the records that the kernels leave. Items of a wave are taken by whichever
// thread is free; places are drawn by atomics as on a GPU, so records' order differs between runs of several threads.
#include "runtime/host/finish.hpp"
#include "runtime/host/march.hpp"
#include "shaders/shared/expand_fit.h"

namespace espalier {
namespace {

constexpr size_t kNodesAtOnce = 1024, kBranchesAtOnce = 1024;

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

ESPALIER_WHOLE void fitNodes(ExpandEnv env, size_t begin, size_t end) {
    uvec2 hash(0, 0);
    for (size_t i = begin; i < end; ++i) hash += fitNode(env, uint32_t(i));
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
        if (goesOn(run.watch, s.nodes)) finishNodes(env, begin, end);
    });
}

void branches(ExpandEnv env, const HostRun& run) {
    if (!complete(env)) return;
    const GrowStatus& s = env.status.v[0];
    overRange(s.frozenBranches, s.branches, kBranchesAtOnce, run.crew, [&](size_t begin, size_t end) {
        for (uint32_t i = uint32_t(begin); i < end; ++i) {
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

constexpr HostRow kRows[] = {
    {"expand/tables.comp", passOf<ExpandEnv, packTables>},    {"expand/march.comp", waveOf<ExpandEnv, growWave>},
    {"expand/march_paper.comp", waveOf<ExpandEnv, growWave>}, {"expand/terminals.comp", passOf<ExpandEnv, terminals>},
    {"expand/branches.comp", passOf<ExpandEnv, branches>},    {"expand/fit.comp", passOf<ExpandEnv, fit>}};

}  // namespace

const std::span<const HostRow> kGrowthRows = kRows;

}  // namespace espalier
