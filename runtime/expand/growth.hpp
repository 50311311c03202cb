#pragma once

// Expansion in GPU buffers: growth.cpp grows all anew, regrowth.cpp only what an edit concerns, compaction.cpp closes
// the gaps that this leaves; growth_set_up.cpp is what they share.

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

#include "runtime/expand/growth_data.hpp"
#include "runtime/expand/growth_plan.hpp"
#include "runtime/expand/growth_stages.hpp"
#include "runtime/expand/seed_changes.hpp"
#include "runtime/machine/room.hpp"
#include "runtime/machine/run_waves.hpp"
#include "shaders/shared/expand_again.h"
#include "shaders/shared/expand_tables.h"

namespace espalier {

// Bytes of a buffer that is read as texels to its end.
inline uint64_t wholeTexels(uint64_t bytes) {
    return (bytes + 15) / 16 * 16;
}

template <class T>
uint32_t capacityOf(const Buffer& buffer) {
    return uint32_t(std::min<uint64_t>(buffer.size() / sizeof(T), 0x7FFFFFFF));
}

class Growth {
  public:
    static Result<std::unique_ptr<Growth>> create(Device& device, const GrowthRoom& room = {});

    // Grows what inputs.changes and the seeds say, or everything anew, and publishes it when complete; until then, and
    // on failure, the last growth stands.
    // Fails for inputs that can't be grown (a seed of no grammar, NaN), when memory has run out, and when
    // inputs.watch has stopped it.
    Status grow(const GrowthInputs& inputs);
    GrowthView view() const { return view_; }
    GrowthStats stats() const { return stats_; }
    // Waits for the GPU and copies the published growth, without gaps: indices differ from those of view().
    Result<GrowthRecords> read();
    // Drops what only the next full growth would use, or edits of more than what stands, and makes its room what the
    // last one needs, with half as much to spare. What stands stays, but may lie elsewhere after growth that needed far
    // more.
    void trim();

  private:
    Growth(Device& device, const GrowthRoom& room)
        : device_(device), runner_(device, "growth"), least_(room), room_(room) {}

    // A full growth writes the other set of both; a regrowth adds to the nodes and leaves that are drawn, and writes
    // the other links.
    struct Plants {
        Buffer nodes, leaves;
    };
    struct Links {
        Buffer chunks, branches;
    };
    // What a growth was made from: all that the next one compares.
    struct Origin : GrownFrom {
        GrowthLimits limits;
        std::vector<RuleMapRef> maps;
        bool avoids = false;  // some stems keep a distance
    };
    struct Outcome {
        GrowStatus status;
        std::vector<Wave> waves;
        double marchMs = 0, terminalsMs = 0, fitMs = 0;
    };

    // Both kinds: growth_set_up.cpp.
    Status ensureChains(const Plants& plants);
    Status ensure(Buffer& buffer, const char* name, uint64_t bytes) { return ensureRoom(device_, buffer, name, bytes); }
    Status makeTables(const GrowthInputs& inputs);
    void noticeFeatures(const GrowthInputs& inputs);
    Status makeAvoidRoom(const GrowthInputs& inputs, const GrowthRecords& frozen);
    Status makeQueues(const GrowthInputs& inputs);
    Status makeRoom(const GrowthInputs& inputs, const GrowthRecords& frozen);
    Status makeRoom(const GrowthInputs& inputs, const GrowthRecords& frozen, bool spare);  // with room for edits
    // Their heads; tableStages() packs them.
    Status uploadTables(Commands& commands, const GrowthInputs& inputs);
    // Counters of an attempt, and the pruned branches that they lead to.
    Status uploadStatus(Commands& commands, const GrowthInputs& inputs, GrowStatus status);
    ExpandEnv environment(const GrowthInputs& inputs, const Plants& plants, const Links& links);
    GrowthShaders shaders() const;
    // Asks for, and takes, what tells of a run up to wave `last`.
    void readBack(Run& run, uint32_t last) const;
    void take(const Run& run, uint32_t last, Outcome& outcome);
    static Origin originOf(const GrowthInputs& inputs);
    // What lies in front is drawn from now on. all: nodes aren't where they were.
    void show(const GrowStatus& status, bool all);
    void lookAtFront();  // its buffers, which hold the same as those before, or what show() tells
    uint64_t reserved() const;
    // Whether stages run at once, and may move records in place.
    bool atOnce(const GrowthInputs& inputs) const { return runner_.atOnce(inputs.native, status_); }
    // ExpandEnv::density; frozen: nodes that stand before those for which there is room.
    uint64_t densityWords(const GrowthLimits& limits, uint64_t frozen) const {
        if (limits.tangents == TangentMode::paper) return kDensityCells + 3 * (room_.nodes + frozen);
        return limits.leafDensityCap > 0 ? kDensityCells : 1;
    }
    // Memory of the lanes of the march's widest wave and of a pass over all nodes, as far as there is room for them.
    uint64_t laneBytes() const {
        const uint64_t march = laneGroupsOf(room_.items, kItemsPerGroupAgain) * uint64_t(kLaneWords);
        const uint64_t nodes =
            std::max(laneGroupsOf(room_.nodes, kNodesPerGroup), groupsThroughChunks()) * uint64_t(kSlotWords);
        return std::max(march, nodes) * kExpandGroup * 4;
    }
    uint32_t groupsThroughChunks() const { return device_.info().traits.groupsThrough(view_.chunkCount); }
    // The packed tables for kernels' uniform binding: something of its size when they are read by address.
    const Buffer& uniformTables() const { return tablesByAddress_ ? noTables_ : tables_; }

    // All anew: growth.cpp.
    Status growAll(const GrowthInputs& inputs);
    Status growWhole(const GrowthInputs& inputs);
    Result<Outcome> attempt(const GrowthInputs& inputs, const FrozenSum& frozen, const GrowthCut& cut);
    Status uploadInputs(Commands& commands, const GrowthInputs& inputs, const FrozenSum& frozen, const GrowthCut& cut);
    void publish(const GrowthInputs& inputs, const FrozenSum& frozen, const Outcome& outcome, Origin&& origin);

    // What an edit concerns: regrowth.cpp.
    bool canRegrow(const GrowthInputs& inputs) const;
    enum class Regrown { done, tooMuch, noRoom };
    Result<Regrown> regrow(const GrowthInputs& inputs, const SeedChanges& seeds);
    static constexpr uint64_t kLeastEditBytes = 16384;
    // Of the buffers of a regrowth of what these links hold.
    struct AgainBytes {
        uint64_t chunks, branches, marks, lists, results;
    };
    AgainBytes againBytes(const Links& from) const;
    Status makeAgainRoom(const GrowthInputs& inputs, uint64_t editWords);
    Status sendEdit(Run& run, const GrowthInputs& inputs, const SeedChanges& seeds, std::span<const uint32_t> edits);
    bool tablesStay(const GrowthInputs& inputs) const;
    // edits: editWords(inputs, seeds).
    Result<AgainState> findDirty(const GrowthInputs& inputs, const SeedChanges& seeds, std::span<const uint32_t> edits,
                                 ExpandEnv env);
    Result<Regrown> growAgain(const GrowthInputs& inputs, const ExpandEnv& env, Outcome& outcome, AgainState& state);
    void publishAgain(const GrowthInputs& inputs, const Outcome& outcome, const AgainState& state, Origin&& origin);
    ItemQueues itemQueues() const { return {addressOf<WorkItemBuf>(items_[0]), addressOf<WorkItemBuf>(items_[1])}; }

    // Frozen plants that GrowthChanges::frozen names, among what is drawn as if they had been there before: put_in.cpp.
    // False: there is no room.
    Result<bool> putIn(const GrowthInputs& inputs);
    Result<Regrown> regrowWithFrozen(const GrowthInputs& inputs);  // with them

    // Gaps that edits have left: compaction.cpp.
    bool gappy(const GrowthInputs& inputs) const;
    bool gappyLinks() const;
    Status makePlantRoom(Plants& plants);
    Status compact(const GrowthInputs& inputs);
    Status enlarge();
    struct Copied {
        const Buffer &from, &to;
        uint64_t bytes;
    };
    Status copyOver(std::initializer_list<Copied> pairs);
    Status movePlants();
    Status moveLinks();
    Status shrink();
    Status makeCopyRoom();
    CompactEnv compactEnvironment(bool inPlace) const;
    Result<GrowStatus> closeGaps(bool inPlace);
    Status checkMoved(uint32_t nodes, uint32_t leaves);
    void showMoved(uint32_t nodes, uint32_t leaves);

    Device& device_;
    Runner runner_;
    const GrowthRoom least_;        // to begin with
    GrowthRoom room_;               // of a full growth, beside frozen plants
    uint32_t likelyWaves_ = 24;     // recorded in the first submission
    uint32_t features_ = 0;         // kFeature...: what grammars have ever used, so that kernels settle
    bool tablesByAddress_ = false;  // else from a uniform buffer, which holds kUniformTableWords
    DoubleBuffered<Plants> plants_;
    DoubleBuffered<Links> links_;
    Buffer items_[2], status_, pruned_, waves_, grammars_, tables_, noTables_, density_;
    Buffer again_, marks_, lists_, edits_, results_, firstLeaves_, nextLeaves_, touched_, nodesWent_, leavesWent_;
    Buffer avoidHeads_, avoidEntries_, avoidBounds_;
    bool touchedIsNew_ = false;  // and holds nothing yet
    bool chained_ = false;       // leaves on the nodes that are drawn are chained
    bool tablesStand_ = false;   // tables_ and grammars_ hold what is drawn was grown by
    GrowthView view_;
    GrowthStats stats_;
    Origin origin_;        // of the growth that is shown
    bool whole_ = false;   // no limit cut it, and no failure an edit of it: edits may grow only what they concern
    uint32_t widest_ = 0;  // items of its widest wave
};

}  // namespace espalier
