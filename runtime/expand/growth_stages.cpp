// The table of growth's kernels, and the order in which they run.
#include "runtime/expand/growth_stages.hpp"

#include <cstddef>

#include "shaders/expand/lane_words.h"  // whose sums are checked where C++ reads them
#include "shaders/shared/rule_map.h"

namespace espalier {
namespace {

// What the kernels share. Links are chunks and branches; a chunk's link to the node before it counts as a node where
// nodes move. Found: all that a regrowth keeps beside what is drawn.
enum : Things {
    kTables = 1u << 0,
    kQueues = 1u << 1,
    kStatus = 1u << 2,
    kNodes = 1u << 3,
    kLinks = 1u << 4,
    kLeaves = 1u << 5,
    kLanes = 1u << 6,
    kDensity = 1u << 7,
    kFound = 1u << 8,
    kGrid = 1u << 9,
};

constexpr Kernel row(const char* shader, Things reads, Things writes) {
    return {shader, reads, writes, kExpandGroup};
}
constexpr Things kGrown = kQueues | kStatus | kNodes | kLinks;
constexpr Kernel kPackTables = row("expand/tables.comp", 0, kTables),
                 kMarch = row("expand/march.comp", kTables, kGrown | kLanes | kGrid),
                 kMarchPaper = row("expand/march_paper.comp", kTables, kGrown | kLanes | kGrid),
                 kTerminals = row("expand/terminals.comp", kTables | kQueues | kLinks,
                                  kStatus | kNodes | kLeaves | kLanes | kDensity),
                 kBranches = row("expand/branches.comp", kQueues | kStatus | kNodes, kLinks | kDensity),
                 kFit = row("expand/fit.comp", kQueues | kLinks, kStatus | kNodes);
// Between waves, of stems that keep a distance: expand_avoid.h.
constexpr Kernel kLook = row("expand/avoid_look.comp", kTables | kNodes | kLinks, kStatus | kGrid),
                 kDecide = row("expand/avoid_decide.comp", kTables, kStatus | kQueues | kNodes | kLinks | kGrid),
                 kDecideRest = row("expand/avoid_settle.comp", kTables, kStatus | kQueues | kNodes | kLinks | kGrid);
// What an edit concerns: expand_again.h.
constexpr Kernel kFind = row("expand/again_find.comp", kTables | kNodes, kLinks | kFound),
                 kStart = row("expand/again_start.comp", kNodes, kGrown | kLeaves | kFound),
                 kMarchAgain = row("expand/march_again.comp", kTables, kGrown | kLanes | kFound),
                 kSettle = row("expand/again_settle.comp", kQueues | kStatus | kNodes, kLinks | kFound),
                 kWork = row("expand/again_work.comp", kQueues | kStatus | kNodes, kLinks | kFound),
                 kAgainTerminals = row("expand/terminals_again.comp", kTables | kQueues | kLinks,
                                       kStatus | kNodes | kLeaves | kLanes | kFound),
                 kApply = row("expand/again_apply.comp", kQueues, kStatus | kNodes | kLinks | kLeaves | kFound),
                 kThickness = row("expand/again_thickness.comp", kQueues | kStatus | kNodes, kLinks | kFound),
                 kFitAgain = row("expand/again_fit.comp", kQueues | kLinks, kStatus | kNodes | kLeaves | kFound);
// Closing gaps: nodes and leaves move beside each other.
constexpr Kernel kCompactPlaces = row("expand/compact_places.comp", 0, kStatus | kLinks),
                 kCompactNodes = row("expand/compact_nodes.comp", kLinks, kNodes),
                 kCompactLeaves = row("expand/compact_leaves.comp", kLinks, kStatus | kLeaves),
                 kCloseGaps = row("expand/close_gaps", 0, kStatus | kNodes | kLinks | kLeaves);

constexpr const char *kMarching = "expand march", *kTerminating = "expand terminals", *kFitting = "expand fit";

// A list being made.
struct Stages {
    const GrowthShaders& shaders;
    StageList list;

    template <class Env>
    Stage& add(const char* pass, const Kernel& kernel, const Env& env, const Groups& groups) {
        Stage& stage = list.emplace_back();
        stage.kernel = kernel;
        stage.pass = pass;
        stage.push.set(env);
        stage.groups = groups;
        return stage;
    }
    // One that runs rules of grammars, and whose lanes have memory.
    Stage& addRules(const char* pass, const Kernel& kernel, const ExpandEnv& env, const Groups& groups) {
        Stage& stage = add(pass, kernel, env, groups);
        stage.constants = {{kConstantTablesByAddress, shaders.tablesByAddress ? 1u : 0u},
                           {kConstantFeatures, shaders.features}};
        if (shaders.tables) stage.bindings.emplace_back(*shaders.tables);
        stage.laneBytes = shaders.laneBytes;
        return stage;
    }
    void addWaves(const Kernel& march, const ExpandEnv& env, const ItemQueues& queues, uint32_t first, uint32_t last) {
        Stage& stage = addRules(kMarching, march, env, {{}, shaders.waves, 0, kQueues});
        stage.rounds = (env.itemCapacity + kDispatchItems - 1) / kDispatchItems;
        stage.firstWave = first;
        stage.lastWave = last;
        stage.turn = [queues](Stage& s, uint32_t wave) {
            ExpandEnv& now = s.push.as<ExpandEnv>();
            now.wave = wave;
            now.items = queues[wave & 1];
            now.nextItems = queues[(wave + 1) & 1];
            if (s.groups.thing == kQueues) s.groups.offset = wave * sizeof(Wave) + offsetof(Wave, groups);
        };
    }
    Groups overChunks() const { return {{}, shaders.status, offsetof(GrowStatus, chunkGroups), kStatus}; }
    // Before the first wave: frozen plants, from which stems stay away.
    void addFrozen(const ExpandEnv& env) {
        add(kMarching, kLook, env, overChunks());
        add(kMarching, kDecideRest, env, {});
    }
    // Behind a march, in each of its waves.
    void addAvoidance(const ExpandEnv& env, uint32_t rounds, uint32_t first, uint32_t last) {
        const size_t marching = list.size() - 1;
        add(kMarching, kLook, env, overChunks());
        add(kMarching, kDecide, env, overChunks()).rounds = rounds;
        add(kMarching, kDecideRest, env, {});
        list[marching].together = uint32_t(list.size() - marching);
        for (size_t i = marching + 1; i < list.size(); ++i) {
            list[i].firstWave = first;
            list[i].lastWave = last;
            list[i].turn = list[marching].turn;
        }
    }
    Groups overNodes() const { return {{}, shaders.status, offsetof(GrowStatus, nodeGroups), kStatus}; }
    Groups overBranches() const { return {{}, shaders.status, offsetof(GrowStatus, branchGroups), kStatus}; }
    Groups through() const { return {{shaders.groups, 1, 1}}; }
};

}  // namespace

StageList tableStages(const GrowthShaders& shaders, const ExpandEnv& env, uint32_t grammars) {
    Stages stages{shaders, {}};
    stages.add("expand tables", kPackTables, env, {{grammars, 1, 1}});
    return std::move(stages.list);
}

StageList growthStages(const GrowthShaders& shaders, ExpandEnv env, const ItemQueues& queues,
                       const GrowthLimits& limits, uint32_t avoidRounds, uint32_t first, uint32_t last) {
    Stages stages{shaders, {}};
    if (avoidRounds > 0 && first == 0) stages.addFrozen(env);
    stages.addWaves(limits.walk == WalkMode::paper ? kMarchPaper : kMarch, env, queues, first, last);
    if (avoidRounds > 0) stages.addAvoidance(env, avoidRounds, first, last);
    env.wave = last;
    const auto inPhase = [&](uint32_t phase) -> const ExpandEnv& { return env.phase = phase, env; };
    if (limits.tangents == TangentMode::paper)
        stages.add(kTerminating, kBranches, inPhase(kTerminalsJoints), stages.overBranches());
    if (limits.leafDensityCap > 0)
        stages.addRules(kTerminating, kTerminals, inPhase(kTerminalsCount), stages.overNodes());
    stages.addRules(kTerminating, kTerminals, inPhase(kTerminalsWrite), stages.overNodes());
    stages.add(kFitting, kBranches, env, stages.overBranches());
    stages.add(kFitting, kFit, env, stages.overNodes());
    return std::move(stages.list);
}

StageList findStages(const GrowthShaders& shaders, const ExpandEnv& env) {
    Stages stages{shaders, {}};
    stages.add("expand find", kFind, env, stages.through());
    stages.add("expand find", kStart, env, stages.through());
    return std::move(stages.list);
}

StageList regrowthStages(const GrowthShaders& shaders, ExpandEnv env, const ItemQueues& queues, uint32_t first,
                         uint32_t last) {
    Stages stages{shaders, {}};
    stages.addWaves(kMarchAgain, env, queues, first, last);
    env.wave = last;
    stages.add(kTerminating, kSettle, env, stages.through());
    stages.add(kTerminating, kWork, env, stages.through());
    env.phase = kTerminalsAgain;
    stages.addRules(kTerminating, kAgainTerminals, env, stages.through());
    for (const Kernel& kernel : {kApply, kThickness, kFitAgain}) stages.add(kFitting, kernel, env, stages.through());
    for (size_t i = 1; i < stages.list.size(); ++i) stages.list[i].watched = false;
    return std::move(stages.list);
}

StageList compactionStages(const GrowthShaders& shaders, const CompactEnv& env) {
    Stages stages{shaders, {}};
    for (const Kernel& kernel : {kCompactPlaces, kCompactNodes, kCompactLeaves})
        stages.add("expand compact", kernel, env, stages.through());
    return std::move(stages.list);
}

StageList closingStages(const CompactEnv& env) {
    const GrowthShaders none;
    Stages stages{none, {}};
    stages.add("expand compact", kCloseGaps, env, {});
    return std::move(stages.list);
}

}  // namespace espalier
