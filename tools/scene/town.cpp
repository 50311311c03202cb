// Houses as records, in and out of the plugin.
#include "tools/scene/town.hpp"

#include <algorithm>

namespace espalier::scene {

Ring ringOf(const House& house, size_t corner) {
    Ring ring{0, house.corners.size(), 0};
    if (house.rings.empty()) return ring;
    for (ring.end = house.rings[0]; corner >= ring.end && ring.number + 1 < house.rings.size();) {
        ring.first = ring.end;
        ring.end += house.rings[++ring.number];
    }
    return ring;
}

House houseNow(const EspContext* context, uint32_t index) {
    House house;
    house.index = index;
    EspHouseInfo info;
    EspHouseLook look;
    if (espHouseInfo(context, index, &info) != ESP_OK || espHouseLook(context, index, &look) != ESP_OK) return house;
    house.shape = nameOf(info.shape);
    house.slope = info.slope;
    house.eaveHeight = info.eaveHeight - info.baseHeight;
    house.look = HouseLook{nameOf(look.covering), {}, look.overhang, nameOf(look.chimneys)};
    if (look.coloured) house.look->colour.assign(std::begin(look.colour), std::end(look.colour));
    std::vector<std::array<float, 2>> corners(info.cornerCount);
    std::vector<EspHouseEdge> edges(info.edgeCount);
    if (espHouseShape(context, index, corners.empty() ? nullptr : corners[0].data(), edges.data()) != ESP_OK)
        return house;
    house.corners = std::move(corners);
    house.rings.resize(info.ringCount);
    if (espHouseRings(context, index, house.rings.data()) != ESP_OK) house.rings.clear();
    for (const EspHouseEdge& edge : edges)
        house.edges.push_back({edge.edge, edge.gable < 0 ? "" : edge.gable ? "gable" : "eave", edge.slope});
    return house;
}

House completed(const EspContext* context, House house) {
    const House now = houseNow(context, house.index);
    if (!house.look) house.look = now.look;
    if (house.eaveHeight == 0) house.eaveHeight = now.eaveHeight;
    if (house.corners.empty()) {
        house.corners = now.corners;
        house.rings = now.rings;
    } else if (house.rings.empty() && !now.rings.empty()) {  // courtyards stay
        house.rings = now.rings;
        house.rings[0] = uint32_t(house.corners.size());
        house.corners.insert(house.corners.end(), now.corners.begin() + now.rings[0], now.corners.end());
    }
    return house;
}

namespace {

constexpr uint32_t kMostEdge = 1000000;  // that a scene file may name

bool lookOf(const HouseLook& look, EspHouseLook& out, std::string& error) {
    const auto fail = [&](const std::string& message) {
        error = message;
        return false;
    };
    out = {};
    if (!coveringNamed(look.covering, out.covering)) return fail("there is no covering '" + look.covering + "'");
    if (!chimneysNamed(look.chimneys, out.chimneys))
        return fail("chimneys are 'any', 'none' or 'all', not '" + look.chimneys + "'");
    if (!look.colour.empty() && look.colour.size() != 3) return fail("a roof's colour is three numbers, or none");
    out.coloured = look.colour.size() == 3;
    if (out.coloured) std::ranges::copy(look.colour, out.colour);
    out.overhang = look.overhang;
    return true;
}

}  // namespace

bool setHouse(EspContext* context, const House& house, std::string& error) {
    EspHouseDef def{};
    if (!shapeNamed(house.shape, def.shape)) {
        error = "there is no roof of the kind '" + house.shape + "'";
        return false;
    }
    std::vector<EspHouseEdge> edges;
    for (const House::Edge& edge : house.edges) {
        if (edge.end != "" && edge.end != "gable" && edge.end != "eave") {
            error = "an edge carries a 'gable' or an 'eave', not '" + edge.end + "'";
            return false;
        }
        if (edge.edge > kMostEdge) {
            error = "there is no edge " + std::to_string(edge.edge);
            return false;
        }
        edges.push_back({edge.edge, edge.end.empty() ? -1 : edge.end == "gable", edge.slope});
    }
    EspHouseLook look;
    if (house.look && !lookOf(*house.look, look, error)) return false;
    def.look = house.look ? &look : nullptr;
    def.slope = house.slope;
    def.eaveHeight = house.eaveHeight;
    def.edges = edges.data();
    def.edgeCount = uint32_t(edges.size());
    def.corners = house.corners.empty() ? nullptr : house.corners[0].data();
    def.cornerCount = uint32_t(house.corners.size());
    def.rings = house.rings.data();
    def.ringCount = uint32_t(house.rings.size());
    if (espSetHouse(context, house.index, &def) == ESP_OK) return true;
    error = espLastError(context);
    return false;
}

std::optional<TownSquare> squareOf(const EspContext* context) {
    EspTownInfo info;
    if (espHouseCount(context) == 0 || espTownInfo(context, &info) != ESP_OK) return {};
    return TownSquare{{info.layerLow[0], info.layerLow[1]}, info.layerSide};
}

std::vector<TownLayer> townLayers(const EspContext* context) {
    std::vector<TownLayer> layers;
    EspGrammar grammar{};
    if (espHouseCount(context) == 0 || espTownGrammar(context, &grammar) != ESP_OK) return layers;
    for (uint32_t i = 0; i < espLayerCount(context, grammar); ++i)
        layers.push_back({espLayerName(context, grammar, i), espLayerFill(context, grammar, i)});
    for (uint32_t i = 0; i < espTownLayerCount(context); ++i) {
        const std::string name = espTownLayerName(context, i);
        const auto known = std::ranges::find(layers, name, &TownLayer::name);
        if (known != layers.end())
            known->painted = true;
        else
            layers.push_back({name, 0, true});
    }
    return layers;
}

}  // namespace espalier::scene
