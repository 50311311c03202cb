// Expansion of roofs on the GPU (Buron 2013 §3). In: atoms and a rule map by address. Out: grids and their rows' runs.
// Waves are recorded ahead as indirect dispatches, empty ones cost nothing. What ran out of room is grown again with
// more, into a second set of buffers, so that the last good roofs stand until the new ones are complete. Single houses
// are grown behind the others, whose records stay; their old ones are told by their generation.
#include "runtime/roof/roof_growth.hpp"

#include <algorithm>
#include <cstddef>

#include "runtime/core/check.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/program.hpp"
#include "shaders/shared/roof_tables.h"

namespace espalier {
namespace {

constexpr uint32_t kWaves = kMaxRoofDepth + 2;
constexpr int kMostAttempts = 12;
// Read back: the status, the waves, what houses have read.
constexpr uint64_t kReadsAt = sizeof(RoofStatus) + kWaves * sizeof(RoofWave);

template <class Buf>
Buf addressOf(const Buffer& buffer) {
    Buf b{};
    b.v = reinterpret_cast<decltype(b.v)>(buffer.address());
    return b;
}

class GpuRoofs final : public RoofGrowth {
  public:
    explicit GpuRoofs(Device& device) : device_(device) {}

    Status setUp() {
        if (Status s = ensure(noWords_, "no roof grammar", kUniformMapWords * 4); !s) return s;
        return make(runs_, "roof/runs.comp", false);
    }
    Status grow(const RoofInputs& inputs) override;
    Status growHouses(const RoofInputs& inputs, std::span<const uint32_t> houses) override;
    Status showLayers(const RoofInputs& inputs) override;
    std::span<const uint32_t> reads() const override { return reads_; }
    RoofView view() const override { return view_; }
    RoofStats stats() const override { return stats_; }
    Result<RoofRecords> read() override;

  private:
    struct Set {
        Buffer grids, runs, regions, parts, planes;
    };
    struct Outcome {
        RoofStatus status;
        uint32_t waves = 0, widest = 0;
        double ms = 0;
    };
    Status make(Program& program, const char* shader, bool byAddress) {
        Result<Program> made =
            Program::compute(device_, shader, {.exact = true, .constants = {{0, byAddress}, {1, uses_}}});
        if (!made) return made.failure();
        requireEqual(made->localSize()[0], kRoofGroup, "local size of a roof kernel");
        program = std::move(*made);
        return Done{};
    }
    // The kernel for what the grammar uses.
    Status makeDerive(const RuleMap& grammar, bool byAddress) {
        const RuleMapRef map = grammar.ref();
        uint32_t uses = uses_;
        for (uint32_t i = 0; i < map.ruleCount; ++i) {
            uses |= 1u << roofKind(map.rules.v[i]);
            if (map.rules.v[i].startLayers) uses |= kRoofUsesLayers;
        }
        for (uint32_t i = 0; i < map.symbolCount; ++i)
            if (map.symbols.v[i].layers) uses |= kRoofUsesLayers;
        if (derive_ && uses == uses_ && byAddress == derivesByAddress_) return Done{};
        uses_ = uses;
        derivesByAddress_ = byAddress;
        derive_ = {};
        return make(derive_, "roof/derive.comp", byAddress);
    }
    Status ensure(Buffer& buffer, const char* name, uint64_t bytes, BufferUse use = BufferUse::device) {
        if (buffer && buffer.size() >= bytes) return Done{};
        buffer = {};
        // What may be bound as a uniform buffer stays as small as that.
        const uint64_t spare = bytes > kUniformMapWords * 4 ? bytes / 8 : 0;
        Result<Buffer> made = Buffer::create(device_, name, bytes + spare, use);
        if (!made) return made.failure();
        buffer = std::move(*made);
        return Done{};
    }
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
    Status makeRoom(Set& set);
    Status uploadTables(Commands& commands, const RoofTables& t, const Set& set, Counts& sent);
    Status uploadGrammar(Commands& commands, const RoofInputs& inputs);
    Status uploadLayers(Commands& commands, const RoofInputs& inputs);
    Status uploadHouses(Commands& commands, const RoofInputs& inputs, std::span<const uint32_t> houses);
    // houses: those to grow, none: all.
    Result<Outcome> expand(const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses, RoofStatus status,
                           Counts& sent);
    void publish(const RoofInputs& inputs, const Outcome& outcome);

    Device& device_;
    Program derive_, runs_;
    uint32_t uses_ = 0;  // what derive_ is specialised to: it only grows, so that edits seldom make a kernel
    bool derivesByAddress_ = false;
    RoofRoom room_;
    Set sets_[2];
    uint32_t front_ = 0;
    Buffer atoms_, pieces_, words_, noWords_, map_, meshes_, scopes_[2], status_, waves_, env_, generations_,
        houseReads_, means_, layerTable_, readback_;
    Buffer layers_[kRoofLayers];
    uint64_t grammarRevision_ = 0;
    Counts own_, sent_;  // of the town's tables: room, and what the published set holds
    std::vector<uint32_t> generationOf_, reads_;
    RoofStatus last_{};
    RoofView view_;
    RoofStats stats_;
};

Status GpuRoofs::makeRoom(Set& set) {
    const uint64_t houses = std::max<uint64_t>(generationOf_.size(), 1);
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
    } rows[] = {{set.grids, "roof grids", room_.grids * sizeof(RoofGrid)},
                {set.runs, "roof runs", room_.rows * sizeof(RoofRun)},
                {set.regions, "roof regions", (own_.regions + room_.regions) * sizeof(RoofRegion)},
                {set.parts, "roof parts", (own_.parts + room_.parts) * sizeof(RoofPart)},
                {set.planes, "roof planes", (own_.planes + room_.planes) * sizeof(vec4)},
                {status_, "roof status", sizeof(RoofStatus)},
                {waves_, "roof waves", kWaves * sizeof(RoofWave)},
                {env_, "roof environment", sizeof(RoofEnv)},
                {atoms_, "roof atoms", own_.atoms * sizeof(RoofAtom)},
                {pieces_, "roof pieces", own_.pieces * sizeof(RoofPiece)},
                {generations_, "roof generations", houses * 4},
                {houseReads_, "what roofs read", houses * 4},
                {means_, "roof layers' means", houses * kRoofLayers * 4}};
    for (const auto& r : rows)
        if (Status s = ensure(r.buffer, r.name, r.bytes); !s) return s;
    return ensure(readback_, "roof readback", kReadsAt + houses * 4, BufferUse::readback);
}

// What the town's tables hold beyond what was sent before.
Status GpuRoofs::uploadTables(Commands& commands, const RoofTables& t, const Set& set, Counts& sent) {
    auto send = [&](const Buffer& buffer, const auto& all, uint32_t& from) -> Status {
        const uint32_t begin = from;
        from = uint32_t(all.size());
        if (begin >= all.size()) return Done{};
        return commands.upload(buffer, std::as_bytes(std::span(all).subspan(begin)), begin * sizeof(all[0]));
    };
    Status steps[] = {send(atoms_, t.atoms, sent.atoms), send(pieces_, t.pieces, sent.pieces),
                      send(set.regions, t.regions, sent.regions), send(set.parts, t.parts, sent.parts),
                      send(set.planes, t.planes, sent.planes)};
    for (Status& s : steps)
        if (!s) return s;
    return Done{};
}

Status GpuRoofs::uploadGrammar(Commands& commands, const RoofInputs& inputs) {
    if (grammarRevision_ == inputs.grammarRevision) return Done{};
    auto send = [&](Buffer& buffer, const char* name, auto span, uint64_t least = 16) -> Status {
        auto bytes = std::as_bytes(span);
        if (Status s = ensure(buffer, name, std::max<uint64_t>(bytes.size(), least)); !s) return s;
        return bytes.empty() ? Status(Done{}) : commands.upload(buffer, bytes);
    };
    if (Status s = send(words_, "roof grammar", inputs.grammar->words(), kUniformMapWords * 4); !s) return s;
    const RuleMapRef ref = inputs.grammar->refAt(words_.address());
    if (Status s = send(map_, "roof rule map", std::span(&ref, 1)); !s) return s;
    if (Status s = send(meshes_, "roof mesh bounds", inputs.meshes); !s) return s;
    grammarRevision_ = inputs.grammarRevision;
    return Done{};
}

// Layers whose rows have changed, and the table by which kernels find them. Painting may add a layer, never a site.
Status GpuRoofs::uploadLayers(Commands& commands, const RoofInputs& inputs) {
    std::vector<RoofLayer> table(kRoofLayers);
    const uint64_t row = uint64_t(inputs.site.size) * sizeof(float);
    for (uint32_t i = 0; i < kRoofLayers; ++i) {
        const RoofInputs::Layer& layer = inputs.layers[i];
        table[i].fill = inputs.fill(i);
        if (!layer.texels) continue;
        const bool fresh = !layers_[i] || layers_[i].size() < row * inputs.site.size;
        if (Status s = ensure(layers_[i], "roof layer", row * inputs.site.size); !s) return s;
        const uint32_t first = fresh ? 0 : std::min(layer.firstRow, inputs.site.size);
        const uint32_t count = fresh ? inputs.site.size : std::min(layer.rowCount, inputs.site.size - first);
        const auto texels = std::as_bytes(std::span(layer.texels, size_t(inputs.site.size) * inputs.site.size));
        if (count > 0)
            if (Status s = commands.upload(layers_[i], texels.subspan(first * row, count * row), first * row); !s)
                return s;
        table[i].texels = addressOf<FloatBuf>(layers_[i]);
    }
    if (Status s = ensure(layerTable_, "roof layers", kRoofLayers * sizeof(RoofLayer)); !s) return s;
    return commands.upload(layerTable_, table);
}

Status GpuRoofs::showLayers(const RoofInputs& inputs) {
    Result<Commands> commands = Commands::begin(device_, "roof layers");
    if (!commands) return commands.failure();
    commands->barrier(Use::compute | Use::vertex | Use::fragment, Use::transfer);
    if (Status s = uploadLayers(*commands, inputs); !s) return s;
    Result<uint64_t> submitted = commands->submit();
    if (!submitted) return submitted.failure();
    view_.layers = addressOf<RoofLayerBuf>(layerTable_);
    view_.site = inputs.site;
    return Done{};
}

// What is kept of each house that grows.
Status GpuRoofs::uploadHouses(Commands& commands, const RoofInputs& inputs, std::span<const uint32_t> houses) {
    constexpr uint64_t kMeans = kRoofLayers * sizeof(float);
    const std::vector<float> values = inputs.filledMeans(generationOf_.size());
    const auto generations = std::as_bytes(std::span(generationOf_)), means = std::as_bytes(std::span(values));
    if (houses.empty() && !values.empty()) {
        commands.fill(houseReads_, 0);
        if (Status s = commands.upload(generations_, generations); !s) return s;
        return commands.upload(means_, means);
    }
    for (uint32_t house : houses) {
        commands.fill(houseReads_, 0, house * 4, 4);
        if (Status s = commands.upload(generations_, generations.subspan(house * 4, 4), house * 4); !s) return s;
        if (Status s = commands.upload(means_, means.subspan(house * kMeans, kMeans), house * kMeans); !s) return s;
    }
    return Done{};
}

Result<GpuRoofs::Outcome> GpuRoofs::expand(const RoofInputs& inputs, Set& set, std::span<const uint32_t> houses,
                                           RoofStatus status, Counts& sent) {
    const RoofTables& t = *inputs.town;
    std::vector<RoofScope> start;
    const uint32_t symbol = inputs.grammar->startSymbol();
    for (uint32_t house : houses) appendStartShapes(t, house, symbol, start);
    for (uint32_t h = 0; houses.empty() && h < t.houses.size(); ++h) appendStartShapes(t, h, symbol, start);
    room_.scopes = std::max(room_.scopes, uint32_t(start.size()));
    if (houses.empty())
        if (Status s = makeRoom(set); !s) return s.failure();
    for (Buffer& scopes : scopes_)
        if (Status s = ensure(scopes, "roof scopes", room_.scopes * sizeof(RoofScope)); !s) return s.failure();
    Result<Commands> commands = Commands::begin(device_, "roofs");
    if (!commands) return commands.failure();
    if (Status s = uploadGrammar(*commands, inputs); !s) return s.failure();
    if (Status s = uploadTables(*commands, t, set, sent); !s) return s.failure();
    if (Status s = uploadHouses(*commands, inputs, houses); !s) return s.failure();
    if (Status s = uploadLayers(*commands, inputs); !s) return s.failure();

    RoofEnv env{};
    env.map = addressOf<RuleMapBuf>(map_);
    env.atoms = addressOf<RoofAtomBuf>(atoms_);
    env.pieces = addressOf<RoofPieceBuf>(pieces_);
    env.regions = addressOf<RoofRegionBuf>(set.regions);
    env.parts = addressOf<RoofPartBuf>(set.parts);
    env.planes = addressOf<Vec4Buf>(set.planes);
    env.shapes = addressOf<RoofScopeBuf>(scopes_[0]);
    env.next = addressOf<RoofScopeBuf>(scopes_[1]);
    env.grids = addressOf<RoofGridBuf>(set.grids);
    env.runs = addressOf<RoofRunBuf>(set.runs);
    env.meshes = addressOf<RoofMeshBuf>(meshes_);
    env.status = addressOf<RoofStatusBuf>(status_);
    env.waves = addressOf<RoofWaveBuf>(waves_);
    env.generations = addressOf<UintBuf>(generations_);
    env.layers = addressOf<RoofLayerBuf>(layerTable_);
    env.means = addressOf<FloatBuf>(means_);
    env.reads = addressOf<UintBuf>(houseReads_);
    env.site = inputs.site;
    env.words = words_.address();
    env.shapeRoom = room_.scopes;
    env.gridRoom = uint32_t(set.grids.size() / sizeof(RoofGrid));
    env.rowRoom = uint32_t(set.runs.size() / sizeof(RoofRun));
    env.regionRoom = uint32_t(set.regions.size() / sizeof(RoofRegion));
    env.partRoom = uint32_t(set.parts.size() / sizeof(RoofPart));
    env.planeRoom = uint32_t(set.planes.size() / sizeof(vec4));
    env.firstGrid = status.grids;

    std::vector<RoofWave> waves(kWaves, RoofWave{0, {0, 1, 1}});
    waves[0] = {uint32_t(start.size()), {uint32_t((start.size() + kRoofGroup - 1) / kRoofGroup), 1, 1}};
    // One group more than records fill, since the first new one needn't begin a group.
    status.gridGroups[0] = status.gridGroups[1] = status.gridGroups[2] = 1;
    const std::vector<RoofStatus> statuses{status};
    const std::vector<RoofEnv> envs{env};
    Status steps[] = {start.empty() ? Status(Done{}) : commands->upload(scopes_[0], start),
                      commands->upload(waves_, waves), commands->upload(status_, statuses),
                      commands->upload(env_, envs)};
    for (Status& s : steps)
        if (!s) return s.failure();
    commands->barrier(Use::transfer, Use::compute | Use::indirect);
    const bool byAddress = words_.size() > kUniformMapWords * 4;
    if (Status s = makeDerive(*inputs.grammar, byAddress); !s) return s.failure();
    {
        Pass pass(*commands, "roof expand");
        for (uint32_t w = 0; w + 1 < kWaves; ++w) {
            pass.dispatchIndirect(derive_, waves_, w * sizeof(RoofWave) + offsetof(RoofWave, groups), w,
                                  {env_, map_, byAddress ? noWords_ : words_});
            pass.barrier(Use::compute | Use::indirect, Use::compute | Use::indirect);
        }
    }
    {
        Pass pass(*commands, "roof rows");
        pass.dispatchIndirect(runs_, status_, offsetof(RoofStatus, gridGroups), {}, {env_});
        pass.barrier(Use::compute, Use::transfer | Use::compute | Use::vertex);
    }
    commands->copy(status_, readback_, sizeof(RoofStatus));
    commands->copy(waves_, readback_, kWaves * sizeof(RoofWave), 0, sizeof(RoofStatus));
    if (!generationOf_.empty()) commands->copy(houseReads_, readback_, generationOf_.size() * 4, 0, kReadsAt);
    commands->barrier(Use::transfer, Use::host);
    if (Status s = commands->finish(); !s) return s.failure();
    device_.collect();
    Outcome outcome;
    outcome.ms = device_.milliseconds("roof expand") + device_.milliseconds("roof rows");
    std::memcpy(&outcome.status, readback_.mapped(), sizeof(RoofStatus));
    std::memcpy(static_cast<void*>(waves.data()), readback_.mapped() + sizeof(RoofStatus), kWaves * sizeof(RoofWave));
    reads_.resize(generationOf_.size());
    std::memcpy(reads_.data(), readback_.mapped() + kReadsAt, reads_.size() * 4);
    for (const RoofWave& w : waves) {
        outcome.waves += w.count > 0 ? 1 : 0;
        outcome.widest = std::max(outcome.widest, w.count);
    }
    return outcome;
}

void GpuRoofs::publish(const RoofInputs& inputs, const Outcome& outcome) {
    const Set& set = sets_[front_];
    last_ = outcome.status;
    view_.grids = addressOf<RoofGridBuf>(set.grids);
    view_.runs = addressOf<RoofRunBuf>(set.runs);
    view_.regions = addressOf<RoofRegionBuf>(set.regions);
    view_.parts = addressOf<RoofPartBuf>(set.parts);
    view_.planes = addressOf<Vec4Buf>(set.planes);
    view_.meshes = addressOf<RoofMeshBuf>(meshes_);
    view_.generations = addressOf<UintBuf>(generations_);
    view_.layers = addressOf<RoofLayerBuf>(layerTable_);
    view_.site = inputs.site;
    view_.gridCount = last_.grids;
    view_.rowCount = last_.rows;
    view_.tileCount = last_.touched;
    view_.clippedCount = last_.touched - last_.whole;
    view_.revision += 1;
    const RoofTables& t = *inputs.town;
    view_.low = glm::vec3(1e9f);
    view_.high = -view_.low;
    for (const RoofTables::House& house : t.houses)
        for (uint32_t i = house.firstAtom; i < house.firstAtom + house.atomCount; ++i) {
            const RoofAtom& atom = t.atoms[i];
            for (float along : {0.0f, atom.eaveLength})
                for (float up : {0.0f, atom.wallHeight + atom.height}) {
                    const glm::vec3 p = atom.foot + atom.tangent * along + glm::vec3(0, up, 0);
                    view_.low = glm::min(view_.low, p);
                    view_.high = glm::max(view_.high, p);
                }
        }
    stats_.houses = uint32_t(t.houses.size());
    stats_.atoms = uint32_t(t.atoms.size());
    stats_.grids = last_.grids;
    stats_.terminals = last_.terminals;
    stats_.tiles = last_.touched;
    stats_.clipped = last_.touched - last_.whole;
    stats_.waves = outcome.waves;
    stats_.stopped = last_.stopped;
    stats_.expansions += 1;
    stats_.hash = uint64_t(last_.hash[1]) << 32 | last_.hash[0];
    stats_.expandMs = outcome.ms;
    stats_.bytes = uint64_t(last_.grids) * sizeof(RoofGrid) + uint64_t(last_.rows) * sizeof(RoofRun) +
                   (last_.regions - own_.regions) * sizeof(RoofRegion) + (last_.parts - own_.parts) * sizeof(RoofPart) +
                   (last_.planes - own_.planes) * sizeof(vec4);
    stats_.reservedBytes = 0;
    for (const Set& s : sets_)
        stats_.reservedBytes += s.grids.size() + s.runs.size() + s.regions.size() + s.parts.size() + s.planes.size();
    for (const Buffer* b : {&atoms_, &pieces_, &scopes_[0], &scopes_[1], &generations_})
        stats_.reservedBytes += b->size();
}

Status GpuRoofs::grow(const RoofInputs& inputs) {
    const RoofTables& t = *inputs.town;
    generationOf_.assign(t.houses.size(), 0);
    own_ = Counts::of(t).withSlack();
    stats_.overflow = 0;
    for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
        RoofStatus status{};
        status.regions = own_.regions;
        status.parts = own_.parts;
        status.planes = own_.planes;
        Counts sent;
        Result<Outcome> outcome = expand(inputs, sets_[1 - front_], {}, status, sent);
        if (!outcome) return outcome.failure();
        RoofStatus made = outcome->status;
        made.regions -= own_.regions;
        made.parts -= own_.parts;
        made.planes -= own_.planes;
        if (room_.hold(made, outcome->widest)) {
            front_ = 1 - front_;
            sent_ = sent;
            publish(inputs, *outcome);
            stats_.housesGrown += t.houses.size();
            return Done{};
        }
        stats_.overflow += 1;
    }
    return Failure("roofs", "the grammar makes more shapes of these houses than memory holds");
}

Status GpuRoofs::growHouses(const RoofInputs& inputs, std::span<const uint32_t> houses) {
    const RoofTables& t = *inputs.town;
    if (houses.empty()) return Done{};
    // A generation has eight bits, and what has gone is swept out by growing all anew when room runs out.
    bool possible = view_.revision != 0 && generationOf_.size() == t.houses.size() && own_.holds(Counts::of(t)) &&
                    grammarRevision_ == inputs.grammarRevision && houses.size() * 2 < t.houses.size() + 2;
    for (uint32_t house : houses) {
        require(house < t.houses.size(), "a house of the town");
        possible = possible && house < generationOf_.size() && generationOf_[house] < 255;
    }
    if (!possible) return grow(inputs);
    for (uint32_t house : houses) generationOf_[house] += 1;
    Set& set = sets_[front_];
    Result<Outcome> outcome = expand(inputs, set, houses, last_, sent_);
    if (!outcome) return outcome.failure();
    const RoofStatus& s = outcome->status;
    const bool held = s.grids <= set.grids.size() / sizeof(RoofGrid) && s.rows <= set.runs.size() / sizeof(RoofRun) &&
                      s.regions <= set.regions.size() / sizeof(RoofRegion) &&
                      s.parts <= set.parts.size() / sizeof(RoofPart) && s.planes <= set.planes.size() / sizeof(vec4) &&
                      outcome->widest <= room_.scopes;
    if (!held) return grow(inputs);
    publish(inputs, *outcome);
    stats_.housesGrown += houses.size();
    return Done{};
}

Result<RoofRecords> GpuRoofs::read() {
    RoofRecords to;
    const Set& set = sets_[front_];
    auto fetch = [&](auto& values, const Buffer& buffer, uint32_t count) -> Status {
        if (count == 0) return Done{};
        auto got = readVector<typename std::decay_t<decltype(values)>::value_type>(device_, buffer, 0, count);
        if (!got) return got.failure();
        values = std::move(*got);
        return Done{};
    };
    Status steps[] = {fetch(to.grids, set.grids, last_.grids), fetch(to.runs, set.runs, last_.rows),
                      fetch(to.regions, set.regions, last_.regions), fetch(to.parts, set.parts, last_.parts),
                      fetch(to.planes, set.planes, last_.planes)};
    for (Status& s : steps)
        if (!s) return s.failure();
    return to;
}

}  // namespace

Result<std::unique_ptr<RoofGrowth>> RoofGrowth::create(Device& device) {
    auto growth = std::make_unique<GpuRoofs>(device);
    if (Status s = growth->setUp(); !s) return s.failure();
    return std::unique_ptr<RoofGrowth>(std::move(growth));
}

}  // namespace espalier
