// Painting, filling and importing layers, and what takes it back: the plugin's own records of strokes.
#include <algorithm>
#include <cmath>

#include "plugin_api/espalier.hpp"
#include "tools/document/document.hpp"
#include "tools/document/fields.hpp"
#include "tools/document/layer_history.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/named.hpp"

namespace espalier::document {
namespace {

bool modeNamed(const std::string& name, EspBrushMode& mode) {
    constexpr const char* kModes[] = {"paint", "erase", "smooth"};
    return scene::valueNamed(kModes, name, mode);
}

Picture pictureIn(const Picture& known, const scene::Scene& scene, const std::string& layer, const std::string& file,
                  std::string& error) {
    if (known && known->size() == channelsOf(scene, layer).size()) return known;
    const auto read = std::make_shared<std::vector<scene::GreyPicture>>();
    return readChannels(file, isColour(scene, layer), *read, error) ? read : nullptr;
}

// What one channel of a layer is painted with.
float valueOf(const std::vector<float>& colour, float value, size_t channel) {
    return channel < colour.size() ? colour[channel] : value;
}

}  // namespace

bool brushOf(const StrokeBegin& stroke, EspBrush& brush, std::string& error) {
    brush = esp::defaults<EspBrush>();
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
        for (const auto& plant : restore->plants) bytes += sizeof plant + plant.unread.size(), frozen(plant.records);
    if (const auto* add = std::get_if<AddSeeds>(&action))
        for (const SeedRecord& seed : add->seeds) frozen(seed.frozen);
    if (const auto* text = std::get_if<SetText>(&action)) bytes += text->grows.size();
    if (const auto* text = std::get_if<SetGraphText>(&action)) bytes += text->runs.size();
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

bool Document::mayPaint(const std::string& layer, std::string& error) const {
    if (!scene::isLayersName(layer, error)) return false;
    if (std::ranges::find(scene_.lockedLayers, layer) == scene_.lockedLayers.end()) return true;
    error = "the layer '" + layer + "' is locked, and stays as it is painted";
    return false;
}

bool Document::carryOut(const StrokeBegin& action, std::vector<Action>&, std::string& error) {
    EspBrush brush;
    if (!mayPaint(action.layer, error) || !brushOf(action, brush, error)) return false;
    strokeName_ = nameOf(*this, action);
    const std::vector<std::string> channels = channelsOf(scene_, action.layer);
    for (size_t c = 0; c < channels.size(); ++c) {
        brush.layer = channels[c].c_str();
        brush.value = valueOf(action.colour, action.value, c);
        EspStroke stroke{};
        if (failed(espBeginStroke(context_, &brush, &stroke), error)) {
            for (const OpenStroke& begun : std::exchange(strokes_, {})) espDestroyStroke(context_, begun.stroke);
            return false;
        }
        strokes_.push_back({channels[c], stroke});
    }
    return true;
}

bool Document::carryOut(const StrokeDabs& action, std::vector<Action>&, std::string& error) {
    if (!stroking()) {
        error = "no stroke has begun";
        return false;
    }
    std::vector<EspDab> dabs;
    for (const auto& d : action.dabs) dabs.push_back({{d[0], d[1], d[2]}, {d[3], d[4], d[5]}, d[6]});
    if (dabs.empty()) return true;
    return std::ranges::all_of(strokes_, [&](const OpenStroke& open) {
        return !failed(espStrokeDabs(context_, open.stroke, dabs.data(), uint32_t(dabs.size())), error);
    });
}

bool Document::carryOut(const StrokeEnd&, std::vector<Action>& back, std::string& error) {
    if (!stroking()) {
        error = "no stroke has begun";
        return false;
    }
    bool good = true, changed = false;
    for (const auto& ended : std::exchange(strokes_, {})) {
        const auto& [channel, stroke] = ended;
        const EspStroke id = stroke;  // clang 14 hands no structured binding to a lambda
        good = !failed(espEndStroke(context_, stroke), error) && good;
        changed = changed || espStrokeBytes(context_, stroke) > 0;
        back.push_back(keepStroke(stroke, channel, [&](int surface) {
            const EspSurface town{};
            return espStrokePainted(context_, id, surface < 0 ? town : scene_.surfaces[size_t(surface)].id) != 0;
        }));
    }
    if (good && changed) return true;
    takeBack(back);  // no step of undo, where no texel has changed: layers that it has made go
    return good;
}

// What undoes an ended stroke of a channel. Pictures that couldn't be read give way where it covers their surface, or
// the town.
Action Document::keepStroke(EspStroke ended, const std::string& channel,
                            const std::function<bool(int surface)>& covers) {
    std::vector<scene::SceneLayer> unread;
    for (const scene::SceneLayer& picture : scene_.unread)
        if (picture.name == channel && covers(picture.surface)) unread.push_back(picture);
    const auto record = std::make_shared<StrokeRecord>(context_, ended, std::move(unread));
    exchangeUnread(*record);
    return SwapStroke{record};
}

// While a stroke is undone the pictures that it has covered wait again.
void Document::exchangeUnread(const StrokeRecord& stroke) {
    for (const scene::SceneLayer& picture : stroke.unread) {
        const auto same = [&](const scene::SceneLayer& other) {
            return other.name == picture.name && other.surface == picture.surface;
        };
        if (std::erase_if(scene_.unread, same) == 0) scene_.unread.push_back(picture);
    }
}

bool Document::carryOut(const FillLayer& action, std::vector<Action>& back, std::string& error) {
    if (!mayPaint(action.layer, error)) return false;
    const std::vector<std::string> channels = channelsOf(scene_, action.layer);
    for (size_t c = 0; c < channels.size(); ++c) {
        EspStroke filled{};
        const float value = valueOf(action.colour, action.value, c);
        if (failed(espFillLayer(context_, channels[c].c_str(), value, &filled), error)) return takeBack(back);
        back.push_back(keepStroke(filled, channels[c], [](int) { return true; }));
    }
    return true;
}

// Of several channels some were painted before one failed.
bool Document::takeBack(std::vector<Action>& back) {
    for (const Action& swap : back) {
        const StrokeRecord& record = *std::get<SwapStroke>(swap).stroke;
        espSwapStroke(context_, record.stroke);
        exchangeUnread(record);
    }
    back.clear();
    return false;
}

bool Document::carryOut(const SwapStroke& action, std::vector<Action>& back, std::string& error) {
    if (failed(espSwapStroke(context_, action.stroke->stroke), error)) return false;
    exchangeUnread(*action.stroke);
    back.push_back(action);
    return true;
}

bool Document::carryOut(const LoadLayer& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    if (!mayPaint(action.layer, error)) return false;
    const Picture picture = pictureIn(action.picture, scene_, action.layer, action.file, error);
    if (!picture) return false;
    const std::vector<std::string> channels = channelsOf(scene_, action.layer);
    const EspSurface surface = scene_.surfaces[action.surface].id;
    for (size_t c = 0; c < channels.size(); ++c) {
        EspLayerDef def;
        EspStroke stroke{};
        if (failed(scene::walkLayer(context_, surface, channels[c], (*picture)[c], def), error) ||
            failed(espImportLayer(context_, &def, &stroke), error))
            return takeBack(back);
        back.push_back(keepStroke(stroke, channels[c], [&](int place) { return place == int(action.surface); }));
    }
    return true;
}

bool Document::carryOut(const LoadTownLayer& action, std::vector<Action>& back, std::string& error) {
    if (!mayPaint(action.layer, error)) return false;
    const Picture picture = pictureIn(action.picture, scene_, action.layer, action.file, error);
    if (!picture) return false;
    const std::vector<std::string> channels = channelsOf(scene_, action.layer);
    for (size_t c = 0; c < channels.size(); ++c) {
        const scene::GreyPicture& p = (*picture)[c];
        EspStroke stroke{};
        if (failed(espSetTownLayer(context_, channels[c].c_str(), p.texels.data(), p.width, p.height, &stroke), error))
            return takeBack(back);
        back.push_back(keepStroke(stroke, channels[c], [](int place) { return place == scene::SceneLayer::kTown; }));
    }
    return true;
}

}  // namespace espalier::document
