// Expansion of roofs on the GPU (Buron 2013 §3). In: atoms and a rule map by address. Out: grids and their rows' runs.
// Waves are recorded ahead, as many as the last expansion took; should that be too few, more of them.
// What ran out of room is grown again with more, into a second set of buffers, so that the last good roofs stand until
// the new ones are complete. Single houses are grown behind the others, whose records stay; their old ones are told by
// their generation.
#include <algorithm>
#include <new>

#include "runtime/core/check.hpp"
#include "runtime/core/undo.hpp"
#include "runtime/roof_growth/house_tables.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
#include "shaders/shared/roof_lane.h"
#include "shaders/shared/roof_tables.h"

namespace espalier {
namespace {

constexpr int kMostAttempts = 12;
constexpr size_t kFewHouses = 32;  // that the CPU grows in less time than submitting to a software device takes
// A kernel takes a software device seconds to make, so kinds of rules come together: those that any roof has, and the
// rest.
constexpr uint32_t kCommonRules = 1u << kRuleNull | 1u << kRuleExtrude | 1u << kRuleJoinRoof | 1u << kRuleRepeat |
                                  1u << kRuleScope | 1u << kRuleShape;
constexpr uint32_t kRareRules = 1u << kRuleJoin | 1u << kRuleProject | 1u << kRuleExplode | 1u << kRuleSplit;

// The grids so far stand, and their rows are worked out.
void noGridsWait(RoofStatus& status) {
    status.firstGrid = status.grids;
    const uint32_t none[] = {0, 1, 1};
    std::copy_n(none, 3, status.gridGroups);
}

}  // namespace

Status RoofGrowth::setUp() {
    return ensure(noWords_, "no roof grammar", kUniformMapWords * 4);
}

// Kernels are made for what the grammar uses.
void RoofGrowth::noticeKind(const RuleMap& grammar) {
    const RuleMapRef map = grammar.ref();
    Kind kind{words_.size() > kUniformMapWords * 4, kind_.uses};
    for (uint32_t i = 0; i < map.ruleCount; ++i) {
        kind.uses |= 1u << roofKind(map.rules.v[i]);
        if (map.rules.v[i].startLayers) kind.uses |= kRoofUsesLayers;
    }
    for (uint32_t i = 0; i < map.symbolCount; ++i)
        if (map.symbols.v[i].layers) kind.uses |= kRoofUsesLayers;
    kind.uses |= kCommonRules | (kind.uses & kRareRules ? kRareRules : 0);
    if (kind != kind_) runner_.dropPrograms(kConstantRoofUses);
    kind_ = kind;
}

RoofEnv RoofGrowth::environment(const RoofInputs& inputs, const Set& set) const {
    RoofEnv env{};
    env.map = addressOf<RuleMapBuf>(map_);
    env.atoms = addressOf<RoofAtomBuf>(atoms_.buffer);
    env.pieces = addressOf<RoofPieceBuf>(pieces_.buffer);
    env.regions = addressOf<RoofRegionBuf>(set.regions.buffer);
    env.parts = addressOf<RoofPartBuf>(set.parts.buffer);
    env.planes = addressOf<Vec4Buf>(set.planes.buffer);
    for (int i : {0, 1}) env.queues[i] = addressOf<RoofScopeBuf>(scopes_[i]);
    env.grids = addressOf<RoofGridBuf>(set.grids);
    env.runs = addressOf<RoofRunBuf>(set.runs);
    env.meshes = addressOf<RoofMeshBuf>(meshes_);
    env.status = addressOf<RoofStatusBuf>(status_);
    env.waves = addressOf<WaveBuf>(waves_);
    env.plots = addressOf<RoofPlotBuf>(set.plots);
    env.layers = addressOf<RoofLayerBuf>(set.layers);
    env.means = addressOf<FloatBuf>(means_);
    env.reads = addressOf<UintBuf>(houseReads_);
    env.site = inputs.site;
    env.words = words_.address();
    env.shapeRoom = room_.scopes;
    env.gridRoom = uint32_t(set.grids.size() / sizeof(RoofGrid));
    env.rowRoom = uint32_t(set.runs.size() / sizeof(RoofRun));
    env.regionRoom = uint32_t(set.regions.buffer.size() / sizeof(RoofRegion));
    env.partRoom = uint32_t(set.parts.buffer.size() / sizeof(RoofPart));
    env.planeRoom = uint32_t(set.planes.buffer.size() / sizeof(vec4));
    env.starts = addressOf<UintBuf>(starts_);
    env.startSymbol = inputs.grammar->startSymbol();
    return env;
}

// All that the first wave's kernels read.
Status RoofGrowth::send(Commands& commands, const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses,
                        RoofStatus status) {
    if (Status s = uploadGrammar(commands, inputs); !s) return s;
    if (Status s = uploadTables(commands, *inputs.town, set); !s) return s;
    if (Status s = uploadStarts(commands, *inputs.town, houses); !s) return s;
    if (Status s = uploadHouses(commands, inputs, set, houses); !s) return s;
    if (Status s = uploadLayers(commands, inputs, set); !s) return s;
    room_.scopes = std::max(room_.scopes, startCount_);
    for (Buffer& scopes : scopes_)
        if (Status s = ensure(scopes, "roof scopes", room_.scopes * sizeof(RoofScope)); !s) return s.failure();

    const uint32_t groups = std::min((startCount_ + kRoofGroup - 1) / kRoofGroup, kRoofLaneGroups);
    const std::vector<Wave> waves = wavesBefore(kRoofWaves, startCount_, groups);
    noGridsWait(status);
    const RoofEnv env = environment(inputs, set);
    if (Status s =
            allDone({commands.upload(waves_, waves), commands.upload(status_, std::as_bytes(std::span(&status, 1))),
                     commands.upload(env_, std::as_bytes(std::span(&env, 1)))});
        !s)
        return s.failure();
    noticeKind(*inputs.grammar);
    return Done{};
}

RoofShaders RoofGrowth::shaders() const {
    RoofShaders s;
    s.waves = &waves_;
    s.status = &status_;
    s.constants = {{kConstantTablesByAddress, kind_.mapByAddress}, {kConstantRoofUses, kind_.uses}};
    s.derive = {env_, map_, kind_.mapByAddress ? noWords_ : words_};
    s.rows = {env_};
    const uint32_t lanes = std::min((room_.scopes + kRoofGroup - 1) / kRoofGroup * kRoofGroup, kMostLanes);
    s.laneBytes = uint64_t(lanes) * kRoofLaneWords * 4;
    return s;
}

// A run's status, waves, and what houses have read.
void RoofGrowth::readBack(Run& run) const {
    run.readBack(status_, sizeof(RoofStatus));
    run.readBack(waves_, kRoofWaves * sizeof(Wave));
    run.readBack(houseReads_, plots_.size() * 4);
}

// Returns whether shapes wait for wave `last`.
bool RoofGrowth::take(const Run& run, uint32_t last, Outcome& outcome) {
    outcome.native = run.atOnce();
    outcome.ms += run.milliseconds("roof expand");
    outcome.status = *run.got<RoofStatus>(0);
    const std::span<const Wave> waves(run.got<Wave>(1), kRoofWaves);
    reads_.assign(run.got<uint32_t>(2), run.got<uint32_t>(2) + plots_.size());
    outcome.waves = wavesOf(waves);
    outcome.widest = widestOf(waves);
    return waves[last].count > 0;
}

Result<RoofGrowth::Outcome> RoofGrowth::expand(const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses,
                                               const RoofStatus& status) {
    if (houses.empty())
        if (Status s = makeRoom(set); !s) return s.failure();
    Outcome outcome;
    const auto add = [&](Run& run, uint32_t first, uint32_t last) -> Status {
        if (first == 0) {
            if (Status s = send(run.send(), inputs, set, houses, status); !s) return s;
        } else {
            // Rows of the grids of earlier waves are worked out.
            RoofStatus so = outcome.status;
            noGridsWait(so);
            if (Status s = run.send().upload(status_, std::as_bytes(std::span(&so, 1))); !s) return s;
        }
        readBack(run);
        return run.add(roofStages(shaders(), environment(inputs, set), first, last));
    };
    const auto waitsStill = [&](const Run& run, uint32_t last) -> Result<bool> { return take(run, last, outcome); };
    const bool atOnce = runner_.atOnce(inputs.native, status_);
    if (Status s = runWaves(runner_, "roofs", atOnce, wavesAhead_, kRoofWaves - 1, add, waitsStill); !s)
        return s.failure();
    outcome.complete = true;
    wavesAhead_ = std::clamp(houses.empty() ? outcome.waves : std::max(wavesAhead_, outcome.waves), 1u, kRoofWaves - 1);
    return outcome;
}

void RoofGrowth::measure(const RoofTables& t, uint32_t house) {
    Box box;
    const RoofTables::House& range = t.houses[house];
    const glm::vec3 plot(t.plots[house].at.x, 0, t.plots[house].at.y);
    for (uint32_t i = range.firstAtom; i < range.firstAtom + range.atomCount; ++i) {
        const RoofAtom& atom = t.atoms[i];
        for (float along : {0.0f, atom.eaveLength})
            for (float up : {0.0f, atom.wallHeight + atom.height}) {
                const glm::vec3 p = plot + atom.foot + atom.tangent * along + glm::vec3(0, up, 0);
                box.low = glm::min(box.low, p);
                box.high = glm::max(box.high, p);
            }
    }
    boxes_[house] = box;
}

void RoofGrowth::publish(const RoofInputs& inputs, const Outcome& outcome, std::span<const uint32_t> houses) {
    const Set& set = sets_.drawn();
    last_ = outcome.status;
    view_.grids = addressOf<RoofGridBuf>(set.grids);
    view_.runs = addressOf<RoofRunBuf>(set.runs);
    view_.regions = addressOf<RoofRegionBuf>(set.regions.buffer);
    view_.parts = addressOf<RoofPartBuf>(set.parts.buffer);
    view_.planes = addressOf<Vec4Buf>(set.planes.buffer);
    view_.meshes = addressOf<RoofMeshBuf>(meshes_);
    view_.plots = addressOf<RoofPlotBuf>(set.plots);
    view_.layers = addressOf<RoofLayerBuf>(set.layers);
    view_.site = inputs.site;
    view_.gridCount = last_.grids;
    view_.rowCount = last_.rows;
    view_.tileCount = last_.touched;
    view_.clippedCount = last_.touched - last_.whole;
    view_.revision += 1;
    const RoofTables& t = *inputs.town;
    for (uint32_t house : houses) measure(t, house);
    Box all;
    for (const Box& box : boxes_) {
        all.low = glm::min(all.low, box.low);
        all.high = glm::max(all.high, box.high);
    }
    view_.low = all.low;
    view_.high = all.high;
    stats_.houses = uint32_t(t.houses.size());
    stats_.atoms = usedAtoms(t);
    stats_.grids = last_.grids;
    if (houses.empty()) {
        houseSums_.clear();
        replaced_ = {};
        forgetLayersBut(inputs.grammar->contexts());
    }
    stats_.terminals = uint32_t(last_.terminals - replaced_.terminals);
    stats_.tiles = last_.touched - replaced_.touched;
    stats_.clipped = stats_.tiles - (last_.whole - replaced_.whole);
    stats_.waves = outcome.waves;
    stats_.stopped = last_.stopped;
    stats_.expansions += 1;
    stats_.hash = uint64_t(last_.hash[1] - replaced_.hash[1]) << 32 | (last_.hash[0] - replaced_.hash[0]);
    stats_.native = outcome.native;
    stats_.expandMs = outcome.ms;
    stats_.bytes = uint64_t(last_.grids) * sizeof(RoofGrid) + uint64_t(last_.rows) * sizeof(RoofRun) +
                   (last_.regions - own_.regions) * sizeof(RoofRegion) + (last_.parts - own_.parts) * sizeof(RoofPart) +
                   (last_.planes - own_.planes) * sizeof(vec4);
    stats_.reservedBytes = reserved();
}

uint64_t RoofGrowth::reserved() const {
    uint64_t bytes = 0;
    for (const Set& s : sets_.sets)
        bytes += s.grids.size() + s.runs.size() + s.plots.size() + s.regions.buffer.size() + s.parts.buffer.size() +
                 s.planes.buffer.size();
    for (const Buffer* b : {&atoms_.buffer, &pieces_.buffer, &scopes_[0], &scopes_[1]}) bytes += b->size();
    return bytes;
}

void RoofGrowth::trim() {
    const RoofRoom least;
    shrinkRoom(room_.scopes, widest_, least.scopes);
    shrinkRoom(room_.grids, last_.grids, least.grids);
    shrinkRoom(room_.rows, last_.rows, least.rows);
    shrinkRoom(room_.regions, last_.regions, least.regions);
    shrinkRoom(room_.parts, last_.parts, least.parts);
    shrinkRoom(room_.planes, last_.planes, least.planes);
    sets_.spare() = {};
    for (Buffer& scopes : scopes_) scopes = {};
    stats_.reservedBytes = reserved();
}

bool RoofGrowth::fits(const RoofStatus& s, const Set& set) {
    return s.grids <= set.grids.size() / sizeof(RoofGrid) && s.rows <= set.runs.size() / sizeof(RoofRun) &&
           s.regions <= set.regions.buffer.size() / sizeof(RoofRegion) &&
           s.parts <= set.parts.buffer.size() / sizeof(RoofPart) && s.planes <= set.planes.buffer.size() / sizeof(vec4);
}

// What has failed leaves the room that it asked for to nobody: later growth may need far less. What was noted as sent
// while it was recorded may not have been.
Status RoofGrowth::grow(const RoofInputs& inputs) {
    Undo undo([this, room = room_, plots = plots_]() mutable {
        stands_ = false;
        forgetTables();
        grammarRevision_ = 0;
        room_ = room;
        plots_ = std::move(plots);
    });
    Status grown = growAll(inputs);
    if (!grown) return grown;
    undo.done();
    stands_ = true;
    return Done{};
}

Status RoofGrowth::growAll(const RoofInputs& inputs) {
    const RoofTables& t = *inputs.town;
    noticeTown(inputs);
    plots_ = t.plots;
    own_ = Counts::of(t).withSlack();
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
        RoofStatus status{};
        status.regions = own_.regions;
        status.parts = own_.parts;
        status.planes = own_.planes;
        Result<Outcome> outcome = expand(inputs, sets_.spare(), {}, status);
        if (!outcome) return outcome.failure();
        RoofStatus made = outcome->status;
        made.regions -= own_.regions;
        made.parts -= own_.parts;
        made.planes -= own_.planes;
        Result<bool> held = room_.hold(made, outcome->widest, startCount_);
        if (!held) return held.failure();
        if (*held) {
            sets_.swap();
            widest_ = outcome->widest;
            publish(inputs, *outcome, {});
            stats_.housesGrown += t.houses.size();
            return Done{};
        }
    }
    return tooManyShapes();
}

Status RoofGrowth::growHouses(const RoofInputs& inputs, std::span<const uint32_t> houses) {
    const RoofTables& t = *inputs.town;
    if (houses.empty()) return Done{};
    // A generation has eight bits, and what has gone is swept out by growing all anew when room runs out.
    bool possible = stands_ && plots_.size() == t.houses.size() && own_.holds(Counts::of(t)) &&
                    town_ == inputs.townRevision && grammarRevision_ == inputs.grammarRevision &&
                    houses.size() * 2 < t.houses.size() + 2;
    for (uint32_t house : houses) {
        require(house < t.houses.size(), "a house of the town");
        possible = possible && house < plots_.size() && plots_[house].generation < 255;
    }
    if (!possible) return grow(inputs);
    if (Status counted = countHouses(); !counted) return counted;
    std::vector<RoofPlot> before = plots_;
    Set& set = sets_.drawn();
    Undo undo([&] { takeBack(set, houses, before); });
    for (uint32_t house : houses) {
        plots_[house].at = t.plots[house].at;
        plots_[house].generation += 1;
    }
    const bool few = houses.size() <= kFewHouses;
    Result<Outcome> outcome = few ? growFew(inputs, houses) : expand(inputs, set, houses, last_);
    const bool held = outcome && outcome->complete && fits(outcome->status, set) && outcome->widest <= room_.scopes;
    if (!held) {
        Status grown = outcome ? grow(inputs) : Status(outcome.failure());
        if (grown) undo.done();
        return grown;
    }
    if (Status counted = recount(houses, *outcome); !counted) return counted;
    undo.done();
    publish(inputs, *outcome, houses);
    stats_.housesGrown += houses.size();
    return Done{};
}

// Nothing has grown: what is drawn of these houses stays, though the GPU may have been told that it was replaced.
void RoofGrowth::takeBack(const Set& set, std::span<const uint32_t> houses, std::vector<RoofPlot>& plots) noexcept {
    plots_.swap(plots);
    forgetTables();  // some may have been noted as sent
    try {
        Result<Commands> commands = Commands::begin(device_, "roofs as they were");
        if (!commands) return;
        commands->barrier(Use::compute | Use::vertex | Use::fragment, Use::transfer);
        for (uint32_t house : houses)
            if (!uploadPlot(*commands, set, house)) return;
        (void)commands->submit();
    } catch (const std::bad_alloc&) {
        // Without memory for this the next growth will show them.
    }
}

Result<RoofRecords> RoofGrowth::read() {
    RoofRecords to;
    const Set& set = sets_.drawn();
    if (Status s = allDone({readRecords(device_, set.grids, last_.grids, to.grids),
                            readRecords(device_, set.runs, last_.rows, to.runs),
                            readRecords(device_, set.regions.buffer, last_.regions, to.regions),
                            readRecords(device_, set.parts.buffer, last_.parts, to.parts),
                            readRecords(device_, set.planes.buffer, last_.planes, to.planes)});
        !s)
        return s.failure();
    to.plots = plots_;
    return to;
}

Result<std::unique_ptr<RoofGrowth>> RoofGrowth::create(Device& device) {
    std::unique_ptr<RoofGrowth> growth(new RoofGrowth(device));
    if (Status s = growth->setUp(); !s) return s.failure();
    return growth;
}

}  // namespace espalier
