// Expansion of roofs on the GPU (Buron 2013 §3). In: atoms and a rule map by address. Out: grids and their rows' runs.
// Waves are recorded ahead as indirect dispatches, as many as the last expansion took; should that be too few, all.
// What ran out of room is grown again with more, into a second set of buffers, so that the last good roofs stand until
// the new ones are complete. Single houses are grown behind the others, whose records stay; their old ones are told by
// their generation.
#include <algorithm>
#include <cstddef>
#include <new>

#include "runtime/core/check.hpp"
#include "runtime/core/undo.hpp"
#include "runtime/roof_growth/house_tables.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
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
// Read back: the status, the waves, what houses have read.
constexpr uint64_t kReadsAt = sizeof(RoofStatus) + kRoofWaves * sizeof(RoofWave);

}  // namespace

Status RoofGrowth::setUp() {
    return ensure(noWords_, "no roof grammar", kUniformMapWords * 4);
}

// Kernels for what the grammar uses.
Status RoofGrowth::makeKernels(const RuleMap& grammar, bool fetches) {
    const RuleMapRef map = grammar.ref();
    Kind kind{words_.size() > kUniformMapWords * 4, !fetches, kind_.uses};
    for (uint32_t i = 0; i < map.ruleCount; ++i) {
        kind.uses |= 1u << roofKind(map.rules.v[i]);
        if (map.rules.v[i].startLayers) kind.uses |= kRoofUsesLayers;
    }
    for (uint32_t i = 0; i < map.symbolCount; ++i)
        if (map.symbols.v[i].layers) kind.uses |= kRoofUsesLayers;
    kind.uses |= kCommonRules | (kind.uses & kRareRules ? kRareRules : 0);
    if (derive_ && kind == kind_) return Done{};
    kind_ = kind;
    derive_ = {};
    return makeCompute(device_, {{derive_, "roof_growth/derive.comp",
                                  exactly({{kConstantTablesByAddress, kind.mapByAddress},
                                           {kConstantRoofUses, kind.uses},
                                           {kConstantRecordsByAddress, kind.recordsByAddress}}),
                                  kRoofGroup}});
}

RoofEnv RoofGrowth::environment(const RoofInputs& inputs, const Set& set) const {
    RoofEnv env{};
    env.map = addressOf<RuleMapBuf>(map_);
    env.atoms = addressOf<RoofAtomBuf>(atoms_.buffer);
    env.pieces = addressOf<RoofPieceBuf>(pieces_.buffer);
    env.regions = addressOf<RoofRegionBuf>(set.regions.buffer);
    env.parts = addressOf<RoofPartBuf>(set.parts.buffer);
    env.planes = addressOf<Vec4Buf>(set.planes.buffer);
    env.shapes = addressOf<RoofScopeBuf>(scopes_[0]);
    env.next = addressOf<RoofScopeBuf>(scopes_[1]);
    env.grids = addressOf<RoofGridBuf>(set.grids);
    env.runs = addressOf<RoofRunBuf>(set.runs);
    env.meshes = addressOf<RoofMeshBuf>(meshes_);
    env.status = addressOf<RoofStatusBuf>(status_);
    env.waves = addressOf<RoofWaveBuf>(waves_);
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

void RoofGrowth::record(Commands& commands, const Texels& texels, uint32_t waves) {
    {
        // One pass: on software devices each time stamp wakes all threads, which one house would feel.
        Pass pass(commands, "roof expand");
        for (uint32_t w = 0; w < waves; ++w) {
            pass.dispatchIndirect(derive_, waves_, w * sizeof(RoofWave) + offsetof(RoofWave, groups), w,
                                  {env_, map_, kind_.mapByAddress ? noWords_ : words_, texels.atoms, texels.regions,
                                   texels.pieces, texels.shapes[w & 1], texels.parts, texels.planes});
            pass.barrier(Use::compute | Use::indirect, Use::compute | Use::indirect | Use::transfer | Use::vertex);
        }
    }
    commands.copy(status_, readback_, sizeof(RoofStatus));
    commands.copy(waves_, readback_, kRoofWaves * sizeof(RoofWave), 0, sizeof(RoofStatus));
    if (!plots_.empty()) commands.copy(houseReads_, readback_, plots_.size() * 4, 0, kReadsAt);
    commands.barrier(Use::transfer, Use::host);
}

RoofGrowth::Outcome RoofGrowth::readBack() {
    Outcome outcome;
    outcome.ms = device_.milliseconds("roof expand");
    std::memcpy(&outcome.status, readback_.mapped(), sizeof(RoofStatus));
    std::array<RoofWave, kRoofWaves> waves;
    std::memcpy(static_cast<void*>(waves.data()), readback_.mapped() + sizeof(RoofStatus), sizeof(waves));
    reads_.resize(plots_.size());
    std::memcpy(reads_.data(), readback_.mapped() + kReadsAt, reads_.size() * 4);
    for (const RoofWave& w : waves) {
        outcome.waves += w.count > 0 ? 1 : 0;
        outcome.widest = std::max(outcome.widest, w.count);
    }
    return outcome;
}

Result<RoofGrowth::Outcome> RoofGrowth::expand(const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses,
                                               RoofStatus status, uint32_t waves) {
    if (houses.empty())
        if (Status s = makeRoom(set); !s) return s.failure();
    Result<Commands> commands = Commands::begin(device_, "roofs");
    if (!commands) return commands.failure();
    if (Status s = uploadGrammar(*commands, inputs); !s) return s.failure();
    if (Status s = uploadTables(*commands, *inputs.town, set); !s) return s.failure();
    if (Status s = uploadStarts(*commands, *inputs.town, houses); !s) return s.failure();
    if (Status s = uploadHouses(*commands, inputs, set, houses); !s) return s.failure();
    if (Status s = uploadLayers(*commands, inputs, set); !s) return s.failure();
    room_.scopes = std::max(room_.scopes, startCount_);
    for (Buffer& scopes : scopes_)
        if (Status s = ensure(scopes, "roof scopes", room_.scopes * sizeof(RoofScope)); !s) return s.failure();

    std::array<RoofWave, kRoofWaves> queues;
    queues.fill({0, {0, 1, 1}});
    queues[0] = {startCount_, {(startCount_ + kRoofGroup - 1) / kRoofGroup, 1, 1}};
    const RoofEnv env = environment(inputs, set);
    if (Status s = allDone({commands->upload(waves_, std::as_bytes(std::span(queues))),
                            commands->upload(status_, std::as_bytes(std::span(&status, 1))),
                            commands->upload(env_, std::as_bytes(std::span(&env, 1)))});
        !s)
        return s.failure();
    commands->barrier(Use::transfer, Use::compute | Use::indirect);
    const bool fetches = mayFetch(inputs, set);
    if (Status s = makeKernels(*inputs.grammar, fetches); !s) return s.failure();
    Result<Texels> texels = viewRecords(set, fetches);
    if (!texels) return texels.failure();
    record(*commands, *texels, waves);
    if (Status s = commands->finish(); !s) return s.failure();
    device_.collect();
    Outcome outcome = readBack();
    outcome.complete = outcome.waves <= waves;
    return outcome;
}

Result<RoofGrowth::Outcome> RoofGrowth::expandWhole(const RoofInputs& inputs, Set& set,
                                                    std::span<const uint32_t> houses, RoofStatus status) {
    Result<Outcome> outcome = expand(inputs, set, houses, status, wavesAhead_);
    if (outcome && !outcome->complete) outcome = expand(inputs, set, houses, status, kRoofWaves - 1);
    if (outcome)
        wavesAhead_ = std::min(houses.empty() ? outcome->waves : std::max(wavesAhead_, outcome->waves), kRoofWaves - 1);
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
    const Set& set = sets_[front_];
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
    stats_.expandMs = outcome.ms;
    stats_.bytes = uint64_t(last_.grids) * sizeof(RoofGrid) + uint64_t(last_.rows) * sizeof(RoofRun) +
                   (last_.regions - own_.regions) * sizeof(RoofRegion) + (last_.parts - own_.parts) * sizeof(RoofPart) +
                   (last_.planes - own_.planes) * sizeof(vec4);
    stats_.reservedBytes = reserved();
}

uint64_t RoofGrowth::reserved() const {
    uint64_t bytes = 0;
    for (const Set& s : sets_)
        bytes += s.grids.size() + s.runs.size() + s.plots.size() + s.regions.buffer.size() + s.parts.buffer.size() +
                 s.planes.buffer.size();
    for (const Buffer* b : {&atoms_.buffer, &pieces_.buffer, &scopes_[0], &scopes_[1]}) bytes += b->size();
    return bytes;
}

void RoofGrowth::trim() {
    const auto fit = [](uint32_t& room, uint32_t needed, uint32_t least) {
        room = std::min<uint64_t>(room, std::max<uint64_t>(needed + needed / 2ull, least));
    };
    const RoofRoom least;
    fit(room_.scopes, widest_, least.scopes);
    fit(room_.grids, last_.grids, least.grids);
    fit(room_.rows, last_.rows, least.rows);
    fit(room_.regions, last_.regions, least.regions);
    fit(room_.parts, last_.parts, least.parts);
    fit(room_.planes, last_.planes, least.planes);
    sets_[1 - front_] = {};
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
        Result<Outcome> outcome = expandWhole(inputs, sets_[1 - front_], {}, status);
        if (!outcome) return outcome.failure();
        RoofStatus made = outcome->status;
        made.regions -= own_.regions;
        made.parts -= own_.parts;
        made.planes -= own_.planes;
        Result<bool> held = room_.hold(made, outcome->widest, startCount_);
        if (!held) return held.failure();
        if (*held) {
            front_ = 1 - front_;
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
    Set& set = sets_[front_];
    Undo undo([&] { takeBack(set, houses, before); });
    for (uint32_t house : houses) {
        plots_[house].at = t.plots[house].at;
        plots_[house].generation += 1;
    }
    const bool few = houses.size() <= kFewHouses;
    Result<Outcome> outcome = few ? growFew(inputs, houses) : expandWhole(inputs, set, houses, last_);
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
    const Set& set = sets_[front_];
    auto fetch = [&](auto& values, const Buffer& buffer, uint32_t count) -> Status {
        if (count == 0) return Done{};
        auto got = readVector<typename std::decay_t<decltype(values)>::value_type>(device_, buffer, 0, count);
        if (!got) return got.failure();
        values = std::move(*got);
        return Done{};
    };
    if (Status s = allDone({fetch(to.grids, set.grids, last_.grids), fetch(to.runs, set.runs, last_.rows),
                            fetch(to.regions, set.regions.buffer, last_.regions),
                            fetch(to.parts, set.parts.buffer, last_.parts),
                            fetch(to.planes, set.planes.buffer, last_.planes)});
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
