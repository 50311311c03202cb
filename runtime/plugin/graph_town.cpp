// In: footprints and expressions of a graph. Out: the context's town, and layers over it.
#include "runtime/plugin/graph_town.hpp"

#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/town_growth.hpp"
#include "shaders/shared/node_function.h"

namespace espalier {
namespace {

Version numberOf(const EspContext& context) {
    return context.town ? context.town->number : 0;
}

// Rows from north to south, as espSetTownLayer takes them.
std::vector<float> texelsOf(const CoverWish& wish, const EspTownInfo& town) {
    const uint32_t side = town.layerTexels;
    const float step = town.layerSide / float(side);
    std::vector<float> texels(size_t(side) * side);
    std::vector<uint32_t> code = wish.code;
    const UintBuf words{code.data()};
    parallelFor(side, 16, [&](size_t begin, size_t end) {
        for (size_t row = begin; row < end; ++row)
            for (uint32_t column = 0; column < side; ++column) {
                const glm::vec3 place(town.layerLow[0] + (float(column) + 0.5f) * step, town.groundHeight,
                                      town.layerLow[1] + (float(row) + 0.5f) * step);
                const float value = runFunction(words, uint32_t(code.size()), place, wish.inputs).x;
                texels[row * side + column] = value > 0 ? std::min(value, 1.0f) : 0;
            }
    });
    return texels;
}

}  // namespace

bool GraphTown::due(const EspContext& context) const {
    return (town_ || !layers_.empty()) && number_ != numberOf(context);
}

void GraphTown::update(EspContext& context, const NodeEvaluation& graph, std::vector<GraphTrouble>& troubles) {
    TownRef town;
    std::map<std::string, std::pair<CoverRef, std::string>> covers;
    for (const NodeEvaluation::Shown& shown : graph.shownValues()) {
        if (!shown.value) continue;
        const std::string& node = graph.graph().nodes[shown.node].name;
        if (const auto* wish = std::get_if<CoverRef>(shown.value)) covers[(*wish)->layer] = {*wish, node};
        const auto* wish = std::get_if<TownRef>(shown.value);
        if (!wish) continue;
        std::string why = town ? "a scene has one town, and the graph shows another" : bringTown(context, *wish);
        if (!town) town = *wish;
        if (!why.empty()) troubles.push_back({node, std::move(why)});
    }
    if (!town) dropTown(context);
    const bool another = number_ != numberOf(context);
    number_ = numberOf(context);
    std::map<std::string, CoverRef, std::less<>> before = std::exchange(layers_, {});
    for (const auto& [name, cover] : covers) {
        const auto known = before.find(name);
        const bool lies = !another && known != before.end() && *known->second == *cover.first;
        if (std::string why = lies ? std::string() : lay(context, cover.first); !why.empty())
            troubles.push_back({cover.second, std::move(why)});
        layers_[name] = cover.first;
        if (known != before.end()) before.erase(known);
    }
    for (const auto& [name, cover] : before) {
        const float fill = context.town ? fillOverTown(context, name) : 0;
        if (context.town) espSetTownLayer(&context, name.c_str(), &fill, 1, 1, nullptr);
    }
}

// "", or why it doesn't stand as wished.
std::string GraphTown::bringTown(EspContext& context, const TownRef& wish) {
    const bool stands = town_ && number_ == numberOf(context);
    if (!stands && context.town) return "the scene has a town already";
    if (const std::string why = grammar_.bring(context, wish->rules); !why.empty()) return why;
    if (stands && town_->text == wish->text && town_->file == wish->file) {
        town_ = wish;
        return {};
    }
    EspTownDef def = {};
    def.structSize = sizeof def;
    espDefaultTownDef(&def);
    def.grammar = grammar_.id();
    def.name = wish->file.c_str();
    def.text = wish->text.data();
    def.length = wish->text.size();
    if (espLoadTown(&context, &def) != ESP_OK) return context.error;
    town_ = wish;
    return {};
}

void GraphTown::dropTown(EspContext& context) {
    if (town_ && context.town && number_ == numberOf(context)) espRemoveTown(&context);
    town_ = nullptr;
    grammar_.drop(context);
}

std::string GraphTown::lay(EspContext& context, const CoverRef& wish) {
    if (!context.town) return "there is no town for the layer '" + wish->layer + "'";
    EspTownInfo info = {};
    info.structSize = sizeof info;
    if (espTownInfo(&context, &info) != ESP_OK) return context.error;
    const std::vector<float> texels = texelsOf(*wish, info);
    const EspResult set =
        espSetTownLayer(&context, wish->layer.c_str(), texels.data(), info.layerTexels, info.layerTexels, nullptr);
    return set == ESP_OK ? std::string() : context.error;
}

void GraphTown::removeAll(EspContext& context) {
    layers_.clear();
    dropTown(context);
}

}  // namespace espalier
