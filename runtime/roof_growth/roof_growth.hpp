#pragma once

// RoofGrowth on the GPU: its buffers and kernels. roof_growth.cpp expands, roof_upload.cpp sends what that reads,
// roof_stages.cpp lists the kernels, few_roofs.cpp grows a few houses on the CPU, house_sums.cpp counts what houses
// have drawn.

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "runtime/machine/room.hpp"
#include "runtime/machine/run_waves.hpp"
#include "runtime/machine/waves.hpp"
#include "runtime/roof_growth/roof_data.hpp"
#include "runtime/roof_growth/roof_stages.hpp"

namespace espalier {

class RoofGrowth {
  public:
    static Result<std::unique_ptr<RoofGrowth>> create(Device& device);

    // Grows all roofs anew and publishes them when complete; on failure the last ones stand.
    Status grow(const RoofInputs& inputs);
    // Grows some houses anew, each named once, whose atoms replaceAtoms() has changed or whose layers; the others
    // stand. A few grow on the CPU, which takes less time than asking the GPU.
    Status growHouses(const RoofInputs& inputs, std::span<const uint32_t> houses);
    // Sends the rows of layers that have changed, for what is drawn of them; growing does so too.
    Status showLayers(const RoofInputs& inputs);
    // [house]: the layers that it has read when it grew last, as RoofEnv::reads.
    std::span<const uint32_t> reads() const { return reads_; }
    RoofView view() const { return view_; }
    RoofStats stats() const { return stats_; }
    // Waits for the GPU and copies what was grown.
    Result<RoofRecords> read();
    // Drops what only the next growth of all roofs, or of many, would use. What stands is left as it is.
    void trim();

  private:
    explicit RoofGrowth(Device& device) : device_(device), runner_(device, "roof") {}
    Status setUp();

    // Records of the town's tables, which only grow, and how many of them the GPU has been sent.
    struct Table {
        Buffer buffer;
        uint32_t held = 0;
    };
    // Regions, parts and planes that Join makes stand behind the town's. plots: [house], RoofView's. layers:
    // RoofLayer, as the grammar counts them that the set is grown by.
    struct Set {
        Buffer grids, runs, plots, layers;
        Table regions, parts, planes;
    };
    // Of the town, whichever grammar reads it.
    struct LayerTexels {
        Buffer buffer;
        bool sent = false;  // all rows
    };
    struct Outcome {
        RoofStatus status;
        uint32_t waves = 0, widest = 0;
        bool complete = false;  // it has found room
        bool native = false;
        double ms = 0;
        // Of a few houses, as they are sent.
        std::vector<RoofGrid> grids;
        std::vector<RoofRun> runs;
    };
    // What grids come to, as in RoofStatus.
    struct Sums {
        uint64_t touched = 0, whole = 0, terminals = 0;
        uint32_t hash[2] = {0, 0};
        Sums& operator+=(const Sums& s) {
            touched += s.touched, whole += s.whole, terminals += s.terminals;
            for (int i : {0, 1}) hash[i] += s.hash[i];
            return *this;
        }
    };
    // Records of the town's tables, with room for houses that change.
    struct Counts {
        uint32_t atoms = 0, pieces = 0, regions = 0, parts = 0, planes = 0;
        static Counts of(const RoofTables& t) {
            return {uint32_t(t.atoms.size()), uint32_t(t.pieces.size()), uint32_t(t.regions.size()),
                    uint32_t(t.parts.size()), uint32_t(t.planes.size())};
        }
        Counts withSlack() const {
            auto more = [](uint32_t n) { return n + n / 8 + 512; };
            return {more(atoms), more(pieces), more(regions), more(parts), more(planes)};
        }
        bool holds(const Counts& c) const {
            return c.atoms <= atoms && c.pieces <= pieces && c.regions <= regions && c.parts <= parts &&
                   c.planes <= planes;
        }
    };
    // What kernels are specialised to. `uses` only grows, so that edits seldom make a kernel.
    struct Kind {
        bool mapByAddress = false;
        uint32_t uses = 0;
        bool operator==(const Kind&) const = default;
    };
    struct Box {
        glm::vec3 low{1e9f}, high{-1e9f};
    };

    void noticeKind(const RuleMap& grammar);
    Status ensure(Buffer& buffer, const char* name, uint64_t bytes);
    Status ensure(Table& table, const char* name, uint64_t bytes);
    Status makeRoom(Set& set);
    void noticeTown(const RoofInputs& inputs);
    // Nothing is known to have been sent of tables and layers.
    void forgetTables();
    Status uploadTables(Commands& commands, const RoofTables& t, Set& set);
    Status uploadStarts(Commands& commands, const RoofTables& t, std::span<const uint32_t> houses);
    Status uploadGrammar(Commands& commands, const RoofInputs& inputs);
    void forgetLayersBut(std::span<const ContextInfo> read);
    Status uploadLayers(Commands& commands, const RoofInputs& inputs, Set& set);
    Status uploadHouses(Commands& commands, const RoofInputs& inputs, const Set& set, std::span<const uint32_t> houses);
    Status uploadPlot(Commands& commands, const Set& set, uint32_t house);
    RoofEnv environment(const RoofInputs& inputs, const Set& set) const;

    Status growAll(const RoofInputs& inputs);
    // houses: those to grow, none: all.
    Result<Outcome> expand(const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses,
                           const RoofStatus& status);
    Status send(Commands& commands, const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses,
                RoofStatus status);
    RoofShaders shaders() const;
    void readBack(Run& run) const;
    bool take(const Run& run, uint32_t last, Outcome& outcome);
    // On the CPU, sent behind what the published set holds. Not complete: there is no room for it.
    Result<Outcome> growFew(const RoofInputs& inputs, std::span<const uint32_t> houses);
    // These haven't grown.
    void takeBack(const Set& set, std::span<const uint32_t> houses, std::vector<RoofPlot>& plots) noexcept;
    // Whether what a status tells has found room.
    static bool fits(const RoofStatus& status, const Set& set);
    // houses: that have grown, none: all.
    void publish(const RoofInputs& inputs, const Outcome& outcome, std::span<const uint32_t> houses);
    void measure(const RoofTables& t, uint32_t house);
    uint64_t reserved() const;
    Sums sumsOf(const RoofGrid& grid, std::span<const RoofRun> runs) const;
    // Of all houses, while all that is published is drawn.
    Status countHouses();
    // These have grown anew: their grids, and the runs from `last_` on.
    Status recount(std::span<const uint32_t> houses, Outcome& outcome);

    Device& device_;
    Runner runner_;
    Kind kind_;
    RoofRoom room_;
    DoubleBuffered<Set> sets_;
    Table atoms_, pieces_;
    Buffer starts_, words_, noWords_, map_, meshes_, scopes_[2], status_, waves_, env_, houseReads_, means_;
    std::map<std::string, LayerTexels> layers_;  // by name
    uint64_t grammarRevision_ = 0;
    uint32_t wavesAhead_ = 4, widest_ = 0;   // shapes of the widest wave, when all houses grew last
    Counts own_;                             // room for the town's tables
    uint64_t town_ = 0;                      // RoofInputs::townRevision
    std::vector<RoofTables::House> ranges_;  // of its houses, when what follows was made
    std::vector<uint32_t> townStarts_;       // atoms of all houses' first shapes
    bool startsSent_ = false;                // `starts_` holds these
    uint32_t startCount_ = 0;                // of the expansion that is being recorded
    std::vector<RoofPlot> plots_;            // [house]
    std::vector<uint32_t> reads_;            // likewise
    bool stands_ = false;          // what is published goes with the members above: no growth has failed since
    std::vector<Box> boxes_;       // [house]
    std::vector<Sums> houseSums_;  // [house], of what is drawn; empty: not counted since all have grown
    Sums replaced_;                // of grids that aren't drawn any more
    RoofStatus last_{};
    RoofView view_;
    RoofStats stats_;
};

}  // namespace espalier
