// Which layers a scene has, those of colours put together.
#include "tools/scene/layers.hpp"

#include <algorithm>
#include <iterator>
#include <locale>
#include <sstream>

#include "tools/scene/town.hpp"

namespace espalier::scene {
namespace {

constexpr const char* kChannels[3] = {".r", ".g", ".b"};

bool holds(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

// Whether "tint.r", "tint.g" and "tint.b" are there, and no numbers by the name "tint", for which another grammar may
// have it.
bool areColour(const std::vector<std::string>& names, const std::string& stem) {
    return !holds(names, stem) && std::ranges::all_of(kChannels, [&](const char* c) { return holds(names, stem + c); });
}

// "tint" for each of these three; else the name.
std::string whole(const std::vector<std::string>& names, const std::string& name) {
    const std::string stem = name.size() < 3 ? "" : name.substr(0, name.size() - 2);
    const bool channel = std::ranges::any_of(kChannels, [&](const char* c) { return name == stem + c; });
    return channel && !stem.empty() && areColour(names, stem) ? stem : name;
}

}  // namespace

bool isColour(const Scene& scene, const std::string& layer) {
    return holds(scene.colourLayers, layer);
}

bool readsLayer(const Scene& scene, const std::string& name) {
    return holds(scene.layers, name) || std::ranges::any_of(scene.colourLayers, [&](const auto& colour) {
               return holds(channelsOf(scene, colour), name);
           });
}

bool isTownsAlone(const EspContext* context, const Scene& scene, const std::string& channel) {
    EspGrammar town{};
    if (espHouseCount(context) == 0 || espTownGrammar(context, &town) != ESP_OK) return false;
    for (const LoadedGrammar& grammar : scene.grammars)
        for (uint32_t i = 0; grammar.id.id != town.id && i < espLayerCount(context, grammar.id); ++i)
            if (channel == espLayerName(context, grammar.id, i)) return false;
    const std::vector<TownLayer> layers = townLayers(context);
    return std::ranges::find(layers, channel, &TownLayer::name) != layers.end();
}

std::vector<std::string> channelsOf(const Scene& scene, const std::string& layer) {
    if (!isColour(scene, layer)) return {layer};
    return {layer + kChannels[0], layer + kChannels[1], layer + kChannels[2]};
}

void noteLayers(const EspContext* context, Scene& scene) {
    std::vector<std::string> declared;
    for (const LoadedGrammar& grammar : scene.grammars)
        for (uint32_t i = 0; i < espLayerCount(context, grammar.id); ++i)
            declared.push_back(espLayerName(context, grammar.id, i));
    // Numbers that were painted by a name which has become a colour's wait unseen for a text that reads them.
    std::vector<std::string> names = declared, painted;
    const auto note = [&](const std::string& name) {
        if (!areColour(declared, name)) painted.push_back(name);
    };
    for (uint32_t i = 0; i < espPaintedLayerCount(context); ++i) note(espPaintedLayerName(context, i));
    for (uint32_t i = 0; i < espTownLayerCount(context); ++i) note(espTownLayerName(context, i));
    std::ranges::sort(painted);  // not by when each was painted, which a project doesn't know
    names.insert(names.end(), painted.begin(), painted.end());
    scene.layers.clear();
    scene.colourLayers.clear();
    for (const std::string& name : names) {
        const std::string layer = whole(names, name);
        if (holds(scene.layers, layer)) continue;
        scene.layers.push_back(layer);
        if (layer != name) scene.colourLayers.push_back(layer);
    }
}

float fillOf(const EspContext* context, const Scene& scene, const std::string& layer) {
    if (float value; espLayerFilled(context, layer.c_str(), &value)) return value;
    for (const LoadedGrammar& grammar : scene.grammars)
        for (uint32_t i = 0; i < espLayerCount(context, grammar.id); ++i)
            if (espLayerName(context, grammar.id, i) == layer) return espLayerFill(context, grammar.id, i);
    return 0;
}

std::string labelOf(const EspContext* context, const Scene& scene, const std::string& layer) {
    for (const LoadedGrammar& grammar : scene.grammars)
        for (uint32_t i = 0; i < espLayerCount(context, grammar.id); ++i)
            if (const std::string label = espLayerLabel(context, grammar.id, i);
                !label.empty() && espLayerName(context, grammar.id, i) == layer)
                return label;
    return "";
}

LayerWords labelWords(const std::string& label) {
    LayerWords words;
    for (size_t at = label.find(": "); at != std::string::npos; at = label.find(',', at + 1)) {
        const std::string text = label.substr(at + 1, label.find(',', at + 1) - at - 1);
        std::istringstream part(text);
        part.imbue(std::locale::classic());
        NamedValue named;
        if (part >> named.value >> std::ws && std::getline(part, named.name) && named.value >= 0 && named.value <= 1)
            words.values.push_back(named);
        else if (const size_t begin = text.find_first_not_of(' '); begin != std::string::npos)
            words.note += (words.note.empty() ? "" : ", ") + text.substr(begin);
    }
    return words;
}

bool readChannels(const std::string& path, bool colour, std::vector<GreyPicture>& out, std::string& error) {
    if (colour) return readColours(path, out, error);
    out.resize(1);
    return readGrey(path, out[0], error);
}

}  // namespace espalier::scene
