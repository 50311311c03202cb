// The layers that grammars read: one is chosen for the brush, and what is done with it as a whole.
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "sample_game/panels.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

using namespace espalier::document;

struct Layer {
    std::string name, label, readers;
    std::vector<float> fill = {};  // where nothing was painted; three of a layer of colours
    bool town = false, painted = false;
    bool colour() const { return fill.size() == 3; }
};

bool painted(const Workspace& work, const std::string& name) {
    for (uint32_t i = 0; i < espPaintedLayerCount(work.context.get()); ++i)
        if (name == espPaintedLayerName(work.context.get(), i)) return true;
    return false;
}

// Over surfaces first, then over the town.
std::vector<Layer> layersOf(const Workspace& work) {
    std::vector<Layer> layers;
    const EspContext* context = work.context.get();
    for (const std::string& name : work.scene().layers) {
        const std::vector<std::string> channels = channelsOf(work.scene(), name);
        Layer layer{
            name, "", "", std::vector<float>(channels.size()), work.townLayer(name), painted(work, channels[0])};
        for (uint32_t g = 0; g < work.scene().grammars.size(); ++g) {
            const EspGrammar grammar = work.scene().grammars[g].id;
            for (uint32_t i = 0; i < espLayerCount(context, grammar); ++i) {
                if (channels[0] != espLayerName(context, grammar, i)) continue;
                for (size_t c = 0; layer.readers.empty() && c < channels.size(); ++c)
                    layer.fill[c] = espLayerFill(context, grammar, i + uint32_t(c));
                layer.readers += (layer.readers.empty() ? "" : ", ") + grammarName(work.scene(), g);
            }
        }
        layer.label = espalier::scene::labelOf(context, work.scene(), channels[0]);
        layers.push_back(layer);
    }
    for (const auto& known : espalier::scene::townLayers(context))
        for (Layer& layer : layers)
            layer.painted |= layer.town && channelsOf(work.scene(), layer.name)[0] == known.name && known.painted;
    std::stable_partition(layers.begin(), layers.end(), [](const Layer& layer) { return !layer.town; });
    return layers;
}

bool isSeen(const Workspace& work, const Layer& layer) {
    return work.scene().look.view == ESP_VIEW_LAYER && work.scene().viewLayer == layer.name;
}

void chosenLayer(Workspace& work, const Layer& layer) {
    const float gap = ImGui::GetStyle().ItemSpacing.x / 2;
    const float width = (ImGui::GetContentRegionAvail().x - gap * 4) / 5;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {2 * work.scale, ImGui::GetStyle().FramePadding.y});
    const auto button = [&](const char* label, const char* tip, bool on = false) {
        const bool pressed = chosenButton(label, on, {width, 0});
        toolTip(tip);
        ImGui::SameLine(0, gap);
        return pressed;
    };
    const Brush& brush = work.brush;
    // Named by what they make of the layer; what it is then is said, too.
    const auto fill = [&](const FillLayer& action, const std::string& now) {
        if (work.perform(action))
            work.say("All of " + layer.name + " is " + now + " now; Ctrl+Z brings back what was painted");
    };
    if (layer.colour()) {
        if (button("Plain", "The whole layer gets the grammar's own colour: nothing is stained"))
            fill({layer.name, 0, layer.fill}, "plain");
        if (button("Fill", "The whole layer gets the brush's colour"))
            fill({layer.name, 0, {std::begin(brush.colour), std::end(brush.colour)}}, "the brush's colour");
    } else {
        char value[16];
        std::snprintf(value, sizeof value, "%.2g", double(brush.value));
        if (button("All 0", "The whole layer gets 0, whatever was painted")) fill({layer.name, 0}, "0");
        if (button(("All " + std::string(value) + "###fill").c_str(), "The whole layer gets the brush's value"))
            fill({layer.name, brush.value}, value);
    }
    if (button("Import", layer.town ? "A picture (.png, .exr) of the town from above, north up, as Export writes it"
                                    : "A picture (.png, .exr) over the surface's atlas (F5), as Export writes it"))
        askForLayer(layer.name, true);
    if (button("Export", layer.town ? "Writes the layer as it is seen from above, north up"
                                    : "Writes the layer as a picture over the surface's atlas (F5)"))
        askForLayer(layer.name, false);
    const bool seen = isSeen(work, layer);
    if (button("Show", layer.town ? "Shows what is painted on the roofs (V)" : "Shows what is painted on the model (V)",
               seen))
        work.perform(SetView{seen ? "shaded" : "layer", seen ? "" : layer.name});
    ImGui::PopStyleVar();
    ImGui::NewLine();
    ImGui::PushTextWrapPos(0);
    const bool changesNothing = !layer.painted && !layer.colour() && brush.value == layer.fill[0];
    if (changesNothing) {
        char text[200];
        std::snprintf(text, sizeof text,
                      "All of %s is %.2g, and the brush paints %.2g: a stroke changes nothing. Press All 0 first.",
                      layer.name.c_str(), layer.fill[0], brush.value);
        hint(text);
    }
    // A line in either case, so that the first stroke moves nothing from under the mouse.
    const char* now = layer.painted ? "Painted" : "Nothing is painted";
    if (layer.colour())
        ImGui::TextDisabled("%s.", now);
    else if (!changesNothing)
        ImGui::TextDisabled("%s: %s %.2g.", now, layer.painted ? "elsewhere it is" : "all of it is", layer.fill[0]);
    // What values mean stands beside the brush, where that is.
    std::string note = espalier::scene::labelWords(layer.label).note;
    if (const size_t rest = layer.label.find(": "); rest != std::string::npos && work.tool != Tool::paint)
        note = layer.label.substr(rest + 2);
    if (!note.empty()) note[0] = char(std::toupper(static_cast<unsigned char>(note[0])));
    if (!note.empty()) ImGui::TextDisabled("%s.", note.c_str());
    if (layer.town) ImGui::TextDisabled("Drag over the roofs: paint falls straight down.");
    ImGui::PopTextWrapPos();
}

// The eye lays what is painted over the model or the roofs.
void layerBoxes(Workspace& work, const Layer& layer) {
    const float close = ImGui::GetStyle().ItemInnerSpacing.x / 2;
    const auto& scene = work.scene();
    bool seen = isSeen(work, layer);
    if (eyeBox("##seen", &seen)) work.perform(SetView{seen ? "layer" : "shaded", seen ? layer.name : ""});
    toolTip("Shows what is painted, in place of the picture");
    ImGui::SameLine(0, close);
    bool locked = std::ranges::find(scene.lockedLayers, layer.name) != scene.lockedLayers.end();
    if (lockBox("##locked", &locked)) work.perform(LockLayer{layer.name, locked});
    toolTip("Locked: it stays as it is painted");
    ImGui::SameLine(0, close);
}

}  // namespace

void layersPanel(Workspace& work) {
    const std::vector<Layer> layers = layersOf(work);
    if (layers.empty()) {
        ImGui::TextWrapped("No grammar here reads a layer. One that says\n  context mask = 1\ncan be painted.");
        return;
    }
    for (const Layer& layer : layers) {
        if (layer.town && (&layer == &layers.front() || !(&layer)[-1].town)) ImGui::TextDisabled("Over the roofs:");
        ImGui::PushID(layer.name.c_str());
        layerBoxes(work, layer);
        const bool chosen = work.brush.layer == layer.name;
        if (ImGui::RadioButton(layer.name.c_str(), chosen)) work.chooseLayer(layer.name);
        const std::string tip = layer.readers.empty()
                                    ? "Painted, but no grammar reads it now"
                                    : (layer.label.empty() ? "" : layer.label + "\n") + "Read by " + layer.readers;
        toolTip(tip.c_str());
        ImGui::SameLine(ImGui::GetFontSize() * 10);
        const std::string what =
            layer.readers.empty() ? "no grammar reads it" : layer.label.substr(0, layer.label.find(':'));
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
        label(what.c_str());
        ImGui::PopStyleColor();
        ImGui::PopID();
    }
    const auto chosen = std::ranges::find(layers, work.brush.layer, &Layer::name);  // rows stay where they are
    if (chosen == layers.end()) return;
    chosenLayer(work, *chosen);
    if (chosen->name == "mask" && !chosen->readers.empty())
        aside("A path up a wall: T and a drag. By paint: All 0, drag up the wall; then S and a click at its foot.");
}

}  // namespace sample
