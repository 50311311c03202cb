// In: growth's buffers by pointer. Out: the records that the kernels leave. Waves are taken in turn, items by whichever
// thread is free; places are drawn by atomics as on a GPU, so records' order differs between runs of several threads.
#include "runtime/host/growth.hpp"

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

}  // namespace

void packTablesNative(ExpandEnv env, uint32_t grammars) {
    for (uint32_t i = 0; i < grammars; ++i) packGrammar(env.grammars, env.tables, i, 0, 1);
}

uint32_t marchNative(ExpandEnv env, const ItemQueues& queues, uint32_t most, Crew& crew, bool wide,
                     GrowthWatch* watch) {
    return march(env, queues, most, crew, wide, watch);
}

void terminalsNative(ExpandEnv env, Crew& crew, GrowthWatch* watch) {
    if (!complete(env)) return;
    const GrowStatus& s = env.status.v[0];
    if (joints(env))
        overRange(s.frozenBranches, s.branches, kBranchesAtOnce, crew, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) sumJoint(env, uint32_t(i));
        });
    for (uint32_t phase : {kTerminalsCount, kTerminalsWrite}) {
        if (phase == kTerminalsCount && s.leafDensityCap <= 0) continue;
        env.phase = phase;
        overRange(s.frozenNodes, s.nodes, kNodesAtOnce, crew, [&](size_t begin, size_t end) {
            if (goesOn(watch, s.nodes)) finishNodes(env, begin, end);
        });
    }
}

void fitNative(ExpandEnv env, Crew& crew) {
    if (!complete(env)) return;
    const GrowStatus& s = env.status.v[0];
    overRange(s.frozenBranches, s.branches, kBranchesAtOnce, crew, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) env.branches.v[i].thickness = thicknessOf(env, uint32_t(i));
    });
    overRange(s.frozenNodes, s.nodes, kNodesAtOnce, crew, [&](size_t begin, size_t end) { fitNodes(env, begin, end); });
}

}  // namespace espalier
