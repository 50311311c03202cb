// What expansion of roofs reads is sent to the GPU: room for records, the town's tables and the grammar when they have
// changed, painted layers by their rows, what is kept of each house.
#include <algorithm>

#include "runtime/core/undo.hpp"
#include "runtime/gpu/limits.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
#include "shaders/shared/roof_tables.h"

namespace espalier {

Status RoofGrowth::ensure(Buffer& buffer, const char* name, uint64_t bytes) {
    if (buffer && buffer.size() >= bytes) return Done{};
    // What may be bound as a uniform buffer stays as small as that.
    static_assert(kUniformMapWords * 4 == kUniformBytes);
    const uint64_t spare = bytes > kUniformMapWords * 4 ? bytes / 8 : 0;
    return ensureRoom(device_, buffer, name, bytes + spare);
}

Status RoofGrowth::ensure(Table& table, const char* name, uint64_t bytes) {
    const VkBuffer before = table.buffer.handle();
    Status made = ensure(table.buffer, name, bytes);
    if (table.buffer.handle() != before) table.held = 0;
    return made;
}

Status RoofGrowth::makeRoom(Set& set) {
    const uint64_t houses = std::max<uint64_t>(plots_.size(), 1);
    const struct {
        Table& table;
        const char* name;
        uint64_t bytes;
    } tables[] = {{set.regions, "roof regions", (own_.regions + room_.regions) * sizeof(RoofRegion)},
                  {set.parts, "roof parts", (own_.parts + room_.parts) * sizeof(RoofPart)},
                  {set.planes, "roof planes", (own_.planes + room_.planes) * sizeof(vec4)},
                  {atoms_, "roof atoms", own_.atoms * sizeof(RoofAtom)},
                  {pieces_, "roof pieces", own_.pieces * sizeof(RoofPiece)}};
    for (const auto& r : tables)
        if (Status s = ensure(r.table, r.name, r.bytes); !s) return s;
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
    } rows[] = {{set.grids, "roof grids", room_.grids * sizeof(RoofGrid)},
                {set.runs, "roof runs", room_.rows * sizeof(RoofRun)},
                {status_, "roof status", sizeof(RoofStatus)},
                {waves_, "roof waves", kRoofWaves * sizeof(Wave)},
                {env_, "roof environment", sizeof(RoofEnv)},
                {set.plots, "roof plots", houses * sizeof(RoofPlot)},
                {houseReads_, "what roofs read", houses * 4},
                {means_, "roof layers' means", houses * kRoofLayers * 4}};
    for (const auto& r : rows)
        if (Status s = ensure(r.buffer, r.name, r.bytes); !s) return s;
    return Done{};
}

// What is worked out of the town's tables once, not at each expansion.
void RoofGrowth::noticeTown(const RoofInputs& inputs) {
    const RoofTables& t = *inputs.town;
    const bool other = inputs.townRevision == 0 || inputs.townRevision != town_;
    if (other) forgetTables();
    if (!other && t.houses == ranges_) return;
    ranges_.clear();  // until all is worked out
    townStarts_.clear();
    startsSent_ = false;
    boxes_.resize(t.houses.size());
    for (uint32_t h = 0; h < t.houses.size(); ++h) {
        appendStarts(t, h, townStarts_);
        measure(t, h);
    }
    ranges_ = t.houses;
    town_ = inputs.townRevision;
}

void RoofGrowth::forgetTables() {
    for (Table* t : {&atoms_, &pieces_}) t->held = 0;
    for (Set& set : sets_.sets)
        for (Table* t : {&set.regions, &set.parts, &set.planes}) t->held = 0;
    startsSent_ = false;
    for (auto& [name, layer] : layers_) layer.sent = false;
}

// What the town's tables hold beyond what was sent before.
Status RoofGrowth::uploadTables(Commands& commands, const RoofTables& t, Set& set) {
    auto send = [&](Table& to, const auto& all) -> Status {
        const uint32_t begin = to.held;
        to.held = uint32_t(all.size());
        if (begin >= all.size()) return Done{};
        return commands.upload(to.buffer, std::as_bytes(std::span(all).subspan(begin)), begin * sizeof(all[0]));
    };
    return allDone({send(atoms_, t.atoms), send(pieces_, t.pieces), send(set.regions, t.regions),
                    send(set.parts, t.parts), send(set.planes, t.planes)});
}

// The atoms of the first wave. houses: that grow, none: all.
Status RoofGrowth::uploadStarts(Commands& commands, const RoofTables& t, std::span<const uint32_t> houses) {
    std::vector<uint32_t> some;
    for (uint32_t house : houses) appendStarts(t, house, some);
    const std::vector<uint32_t>& starts = houses.empty() ? townStarts_ : some;
    startCount_ = uint32_t(starts.size());
    if (houses.empty() && startsSent_) return Done{};
    startsSent_ = houses.empty();
    if (Status s = ensure(starts_, "roof starts", std::max<uint64_t>(starts.size() * 4, 16)); !s) return s;
    return starts.empty() ? Status(Done{}) : commands.upload(starts_, starts);
}

Status RoofGrowth::uploadGrammar(Commands& commands, const RoofInputs& inputs) {
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

// Layers whose rows have changed, and the table by which the set's kernels find them. Painting may add a layer, never a
// site.
Status RoofGrowth::uploadLayers(Commands& commands, const RoofInputs& inputs, Set& set) {
    std::vector<RoofLayer> table(kRoofLayers);
    const uint64_t row = uint64_t(inputs.site.size) * sizeof(float);
    const std::vector<ContextInfo>& contexts = inputs.grammar->contexts();
    for (uint32_t i = 0; i < std::min<size_t>(contexts.size(), kRoofLayers); ++i) {
        const RoofInputs::Layer& layer = inputs.layers[i];
        table[i].fill = contexts[i].fill;
        LayerTexels& kept = layers_[contexts[i].name];
        if (!layer.texels) kept.sent = false;
        if (!layer.texels) continue;
        const bool fresh = !kept.sent || !kept.buffer || kept.buffer.size() < row * inputs.site.size;
        kept.sent = false;
        if (Status s = ensure(kept.buffer, "roof layer", row * inputs.site.size); !s) return s;
        const uint32_t first = fresh ? 0 : std::min(layer.firstRow, inputs.site.size);
        const uint32_t count = fresh ? inputs.site.size : std::min(layer.rowCount, inputs.site.size - first);
        const auto texels = std::as_bytes(std::span(layer.texels, size_t(inputs.site.size) * inputs.site.size));
        if (count > 0)
            if (Status s = commands.upload(kept.buffer, texels.subspan(first * row, count * row), first * row); !s)
                return s;
        kept.sent = true;
        table[i].texels = addressOf<FloatBuf>(kept.buffer);
    }
    if (Status s = ensure(set.layers, "roof layers", kRoofLayers * sizeof(RoofLayer)); !s) return s;
    return commands.upload(set.layers, table);
}

void RoofGrowth::forgetLayersBut(std::span<const ContextInfo> read) {
    std::erase_if(layers_, [&](const auto& layer) {
        return std::ranges::none_of(read, [&](const ContextInfo& context) { return context.name == layer.first; });
    });
}

Status RoofGrowth::showLayers(const RoofInputs& inputs) {
    Undo undo([this] { forgetTables(); });
    Result<Commands> commands = Commands::begin(device_, "roof layers");
    if (!commands) return commands.failure();
    commands->barrier(Use::compute | Use::vertex | Use::fragment, Use::transfer);
    if (Status s = uploadLayers(*commands, inputs, sets_.drawn()); !s) return s;
    Result<uint64_t> submitted = commands->submit();
    if (!submitted) return submitted.failure();
    undo.done();
    view_.layers = addressOf<RoofLayerBuf>(sets_.drawn().layers);
    view_.site = inputs.site;
    return Done{};
}

// What is kept of each house that grows. Layers are known to grammars that declare them only.
Status RoofGrowth::uploadHouses(Commands& commands, const RoofInputs& inputs, const Set& set,
                                std::span<const uint32_t> houses) {
    const bool layered = !inputs.grammar->contexts().empty();
    if (houses.empty() && !plots_.empty()) {
        commands.fill(houseReads_, 0, 0, plots_.size() * 4);
        if (Status s = commands.upload(set.plots, plots_); !s) return s;
        return layered ? commands.upload(means_, inputs.filledMeans(plots_.size())) : Status(Done{});
    }
    for (uint32_t house : houses) {
        const RoofInputs::Means means = inputs.meansOf(house);
        commands.fill(houseReads_, 0, house * 4, 4);
        if (Status s = uploadPlot(commands, set, house); !s) return s;
        if (layered)
            if (Status s = commands.upload(means_, std::as_bytes(std::span(means)), house * sizeof(means)); !s)
                return s;
    }
    return Done{};
}

Status RoofGrowth::uploadPlot(Commands& commands, const Set& set, uint32_t house) {
    const auto plots = std::as_bytes(std::span(plots_));
    return commands.upload(set.plots, plots.subspan(house * sizeof(RoofPlot), sizeof(RoofPlot)),
                           house * sizeof(RoofPlot));
}

}  // namespace espalier
