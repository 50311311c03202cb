// Painting, filling and importing layers, and what takes it back: the plugin's own records of strokes, and tiles of
// what an import has overwritten.
#include <algorithm>
#include <cmath>

#include "tools/document/document.hpp"
#include "tools/document/layer_history.hpp"

namespace espalier::document {
namespace {

struct TileRows {
    uint32_t x, y, width, height;
};

TileRows rowsOf(uint32_t place, uint32_t side) {
    const uint32_t perRow = (side + LayerTiles::kTile - 1) / LayerTiles::kTile;
    const uint32_t x = place % perRow * LayerTiles::kTile, y = place / perRow * LayerTiles::kTile;
    return {x, y, std::min(LayerTiles::kTile, side - x), std::min(LayerTiles::kTile, side - y)};
}

bool modeNamed(const std::string& name, EspBrushMode& mode) {
    constexpr const char* kModes[] = {"paint", "erase", "smooth"};
    const auto found = std::find(std::begin(kModes), std::end(kModes), name);
    mode = EspBrushMode(found - std::begin(kModes));
    return found != std::end(kModes);
}

}  // namespace

LayerTiles LayerTiles::difference(const std::vector<float>& before, const std::vector<float>& after, uint32_t side) {
    LayerTiles tiles;
    tiles.side = side;
    const uint32_t perRow = (side + kTile - 1) / kTile;
    for (uint32_t place = 0; place < perRow * perRow; ++place) {
        const TileRows tile = rowsOf(place, side);
        bool same = true;
        for (uint32_t y = tile.y; y < tile.y + tile.height && same; ++y) {
            const size_t row = size_t(y) * side + tile.x;
            same = std::equal(&before[row], &before[row] + tile.width, &after[row]);
        }
        if (same) continue;
        tiles.places.push_back(place);
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
            const float* row = &before[size_t(y) * side + tile.x];
            tiles.texels.insert(tiles.texels.end(), row, row + tile.width);
        }
    }
    return tiles;
}

LayerTiles LayerTiles::swappedInto(std::vector<float>& into) const {
    LayerTiles other = *this;
    float* kept = other.texels.data();
    for (uint32_t place : places) {
        const TileRows tile = rowsOf(place, side);
        for (uint32_t y = tile.y; y < tile.y + tile.height; ++y, kept += tile.width)
            std::swap_ranges(kept, kept + tile.width, &into[size_t(y) * side + tile.x]);
    }
    return other;
}

size_t keptBytes(const Action& action) {
    if (const auto* swap = std::get_if<SwapStroke>(&action))
        return size_t(espStrokeBytes(swap->stroke->context, swap->stroke->stroke));
    if (const auto* swap = std::get_if<SwapTiles>(&action)) return swap->tiles->texels.size() * sizeof(float);
    if (const auto* text = std::get_if<SetText>(&action)) return text->text.size();
    return 0;
}

bool Document::readLayer(size_t surface, const std::string& layer, scene::GreyPicture& out, std::string& error) const {
    const EspSurface id = scene_.surfaces[surface].id;
    uint32_t side = 0;
    if (failed(espReadLayer(context_, id, layer.c_str(), nullptr, &side), error)) return false;
    out.width = out.height = side;
    out.texels.resize(size_t(side) * side);
    return !failed(espReadLayer(context_, id, layer.c_str(), out.texels.data(), &side), error);
}

bool Document::carryOut(const StrokeBegin& action, std::vector<Action>&, std::string& error) {
    EspBrush brush = espDefaultBrush();
    brush.layer = action.layer.c_str();
    if (!modeNamed(action.mode, brush.mode)) {
        error = "there is no brush that does '" + action.mode + "'";
        return false;
    }
    brush.radius = action.radius;
    brush.value = action.value;
    brush.strength = action.strength;
    brush.hardness = action.hardness;
    std::copy(action.slope.begin(), action.slope.end(), brush.slopeRange);
    std::copy(action.height.begin(), action.height.end(), brush.heightRange);
    brush.limitSoftness = action.softness;
    brush.frontOnly = action.frontOnly;
    strokeHasDabs_ = false;
    return !failed(espBeginStroke(context_, &brush, &stroke_), error);
}

bool Document::carryOut(const StrokeDabs& action, std::vector<Action>&, std::string& error) {
    if (!stroking()) {
        error = "no stroke has begun";
        return false;
    }
    std::vector<EspDab> dabs;
    for (const auto& d : action.dabs) dabs.push_back({{d[0], d[1], d[2]}, {d[3], d[4], d[5]}, d[6]});
    if (dabs.empty()) return true;
    strokeHasDabs_ = true;
    return !failed(espStrokeDabs(context_, stroke_, dabs.data(), uint32_t(dabs.size())), error);
}

bool Document::carryOut(const StrokeEnd&, std::vector<Action>& back, std::string& error) {
    if (!stroking()) {
        error = "no stroke has begun";
        return false;
    }
    const EspStroke ended = std::exchange(stroke_, {});
    const bool good = !failed(espEndStroke(context_, ended), error);
    const auto record = std::make_shared<StrokeRecord>(context_, ended);
    if (good && strokeHasDabs_) back.push_back(SwapStroke{record});
    return good;
}

bool Document::carryOut(const FillLayer& action, std::vector<Action>& back, std::string& error) {
    EspStroke filled{};
    if (failed(espFillLayer(context_, action.layer.c_str(), action.value, &filled), error)) return false;
    back.push_back(SwapStroke{std::make_shared<StrokeRecord>(context_, filled)});
    return true;
}

bool Document::carryOut(const SwapStroke& action, std::vector<Action>& back, std::string& error) {
    if (failed(espSwapStroke(context_, action.stroke->stroke), error)) return false;
    back.push_back(action);
    return true;
}

bool Document::setLayer(uint32_t surface, const std::string& layer, const scene::GreyPicture& picture,
                        EspLayerSpace space, std::string& error) {
    EspLayerDef def = espDefaultLayerDef();
    def.surface = scene_.surfaces[surface].id;
    def.name = layer.c_str();
    def.space = space;
    def.texels = picture.texels.data();
    def.width = picture.width;
    def.height = picture.height;
    return !failed(espSetLayer(context_, &def), error);
}

bool Document::carryOut(const LoadLayer& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    scene::GreyPicture picture, before, after;
    if (!readGrey(action.file, picture, error) || !readLayer(action.surface, action.layer, before, error) ||
        !setLayer(action.surface, action.layer, picture, action.walkUv ? ESP_LAYER_WALK_UV : ESP_LAYER_MATERIAL_UV,
                  error) ||
        !readLayer(action.surface, action.layer, after, error))
        return false;
    auto tiles = std::make_shared<LayerTiles>(LayerTiles::difference(before.texels, after.texels, before.width));
    tiles->surface = action.surface;
    tiles->layer = action.layer;
    back.push_back(SwapTiles{tiles});
    return true;
}

bool Document::carryOut(const SwapTiles& action, std::vector<Action>& back, std::string& error) {
    const LayerTiles& tiles = *action.tiles;
    scene::GreyPicture picture;
    if (!readLayer(tiles.surface, tiles.layer, picture, error)) return false;
    auto other = std::make_shared<LayerTiles>(tiles.swappedInto(picture.texels));
    if (!setLayer(tiles.surface, tiles.layer, picture, ESP_LAYER_WALK_UV, error)) return false;
    back.push_back(SwapTiles{other});
    return true;
}

}  // namespace espalier::document
