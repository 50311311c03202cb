// Painting, filling and importing layers, and what takes it back: the plugin's own records of strokes.
#include <algorithm>
#include <cmath>

#include "tools/document/document.hpp"
#include "tools/document/fields.hpp"
#include "tools/document/layer_history.hpp"
#include "tools/scene/named.hpp"

namespace espalier::document {
namespace {

bool modeNamed(const std::string& name, EspBrushMode& mode) {
    constexpr const char* kModes[] = {"paint", "erase", "smooth"};
    return scene::valueNamed(kModes, name, mode);
}

Picture pictureIn(const Picture& known, const std::string& file, std::string& error) {
    if (known) return known;
    const auto read = std::make_shared<scene::GreyPicture>();
    return readGrey(file, *read, error) ? read : nullptr;
}

}  // namespace

bool brushOf(const StrokeBegin& stroke, EspBrush& brush, std::string& error) {
    brush = espDefaultBrush();
    brush.layer = stroke.layer.c_str();
    if (!modeNamed(stroke.mode, brush.mode)) {
        error = "there is no brush that does '" + stroke.mode + "'";
        return false;
    }
    brush.radius = stroke.radius;
    brush.value = stroke.value;
    brush.strength = stroke.strength;
    brush.hardness = stroke.hardness;
    std::copy(stroke.slope.begin(), stroke.slope.end(), brush.slopeRange);
    std::copy(stroke.height.begin(), stroke.height.end(), brush.heightRange);
    brush.limitSoftness = stroke.softness;
    brush.frontOnly = stroke.frontOnly;
    return true;
}

size_t keptBytes(Action& action) {
    FieldBytes fields;
    std::visit([&](auto& a) { a.fields(fields); }, action);
    size_t bytes = sizeof(Action) + fields.bytes();
    // What runs don't know of:
    const auto frozen = [&](const scene::FrozenPlant& plant) { bytes += plant ? plant->size() : 0; };
    if (const auto* swap = std::get_if<SwapStroke>(&action))
        bytes += size_t(espStrokeBytes(swap->stroke->context, swap->stroke->stroke));
    if (const auto* restore = std::get_if<RestoreFrozen>(&action))
        for (const auto& plant : restore->plants) bytes += sizeof plant, frozen(plant.second);
    if (const auto* add = std::get_if<AddSeeds>(&action))
        for (const SeedRecord& seed : add->seeds) frozen(seed.frozen);
    if (const auto* text = std::get_if<SetText>(&action)) bytes += text->grows.size();
    return bytes;
}

bool Document::readLayer(size_t surface, const std::string& layer, scene::GreyPicture& out, std::string& error) const {
    const EspSurface id = scene_.surfaces[surface].id;
    uint32_t side = 0;
    if (failed(espReadLayer(context_, id, layer.c_str(), nullptr, &side), error)) return false;
    out.width = out.height = side;
    out.texels.resize(size_t(side) * side);
    return !failed(espReadLayer(context_, id, layer.c_str(), out.texels.data(), &side), error);
}

bool Document::readTownLayer(const std::string& layer, scene::GreyPicture& out, std::string& error) const {
    uint32_t side = 0;
    if (failed(espReadTownLayer(context_, layer.c_str(), nullptr, &side), error)) return false;
    out.width = out.height = side;
    out.texels.resize(size_t(side) * side);
    return !failed(espReadTownLayer(context_, layer.c_str(), out.texels.data(), &side), error);
}

bool Document::carryOut(const StrokeBegin& action, std::vector<Action>&, std::string& error) {
    EspBrush brush;
    if (!brushOf(action, brush, error)) return false;
    strokeHasDabs_ = false;
    strokeName_ = nameOf(action);
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

bool Document::carryOut(const LoadLayer& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    const Picture picture = pictureIn(action.picture, action.file, error);
    if (!picture) return false;
    EspLayerDef def;
    EspStroke stroke{};
    if (failed(scene::walkLayer(context_, scene_.surfaces[action.surface].id, action.layer, *picture, def), error) ||
        failed(espImportLayer(context_, &def, &stroke), error))
        return false;
    back.push_back(SwapStroke{std::make_shared<StrokeRecord>(context_, stroke)});
    return true;
}

bool Document::carryOut(const LoadTownLayer& action, std::vector<Action>& back, std::string& error) {
    const Picture picture = pictureIn(action.picture, action.file, error);
    EspStroke stroke{};
    if (!picture || failed(espSetTownLayer(context_, action.layer.c_str(), picture->texels.data(), picture->width,
                                           picture->height, &stroke),
                           error))
        return false;
    back.push_back(SwapStroke{std::make_shared<StrokeRecord>(context_, stroke)});
    return true;
}

}  // namespace espalier::document
