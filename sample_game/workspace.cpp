// The way of an action to the document, and what is in hand.
#include "sample_game/workspace.hpp"

#include <algorithm>
#include <cmath>

#include "sample_game/field_tool.hpp"
#include "tools/scene/layers.hpp"

namespace sample {

glm::vec3 vec(const float* v) {
    return {v[0], v[1], v[2]};
}
glm::vec3 vec(const std::array<float, 3>& v) {
    return {v[0], v[1], v[2]};
}
std::array<float, 3> array(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

void tangents(glm::vec3 normal, glm::vec3& u, glm::vec3& v) {
    u = glm::normalize(glm::cross(normal, std::abs(normal.y) < .9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0)));
    v = glm::cross(normal, u);
}

void Workspace::fitBrush() {
    constexpr float kLeast = .002f, kMost = .15f;  // of what is painted
    const auto fit = [](float& radius, float size) {
        if (size > 0)
            radius = std::clamp(std::clamp(radius, kLeast * size, kMost * size), kSmallestBrush, kLargestBrush);
    };
    if (!scene().surfaces.empty()) fit(brush.radius, reach());
    if (const auto of = town()) fit(brush.townRadius, of->layerSide);
}

namespace {

// Most plants may grow anew by it, and that may take long.
bool reachesFar(const espalier::document::Action& action) {
    using namespace espalier::document;
    constexpr size_t kMany = 8;
    const auto is = [&]<class... Kinds>() { return (std::holds_alternative<Kinds>(action) || ...); };
    if (const auto* changed = std::get_if<ChangeSeeds>(&action)) return changed->seeds.size() >= kMany;
    if (const auto* added = std::get_if<AddSeeds>(&action)) return added->seeds.size() >= kMany;
    return is.operator()<SetParam, SetText, SetWalk, FillLayer, LoadLayer, Undo, Redo>();
}

}  // namespace

bool Workspace::perform(const espalier::document::Action& action, uint32_t gesture) {
    // News stands while one looks around.
    const bool looks = std::holds_alternative<espalier::document::SetCamera>(action) ||
                       std::holds_alternative<espalier::document::SetGraphTime>(action);
    if (!looks) error.clear(), message.clear();
    redraw = true;
    growsWide |= reachesFar(action);
    const bool back = std::holds_alternative<espalier::document::Undo>(action);
    const bool again = std::holds_alternative<espalier::document::Redo>(action);
    const char* name = back ? document->undoName() : again ? document->redoName() : nullptr;
    const std::string done = name ? std::string(back ? "Undone: " : "Done again: ") + name : "";
    if (!document->perform(action, error, gesture)) return false;
    if (name) message = done;
    return true;
}

void Workspace::takeBack(uint32_t gesture) {
    if (document->undoGesture() == gesture && perform(espalier::document::Undo{})) message.clear();
}

void Layout::noteRecent(const std::string& file) {
    constexpr size_t kMost = 10;
    std::erase(recent, file);
    recent.insert(recent.begin(), file);
    if (recent.size() > kMost) recent.resize(kMost);
}

void Workspace::choose(Tool chosen) {
    if (chosen == Tool::paint && tool != Tool::paint) seePaint(true);
    if (chosen != Tool::paint && tool == Tool::paint) seePaint(false);
    tool = chosen;
}

void Workspace::setEditing(bool edits) {
    if (tool == Tool::paint && edits != editing) seePaint(edits);
    editing = edits;
    redraw = true;
}

void Workspace::seePaint(bool seen) {
    const EspView view = scene().look.view;
    if (seen && view == ESP_VIEW_SHADED && !brush.layer.empty() && !townLayer(brush.layer)) showLayer(true);
    if (!seen && view == ESP_VIEW_LAYER) showLayer(false);
}

void Workspace::showAtlas(bool shown) {
    if (scene().surfaces.empty()) return say("No surface is here: an atlas is one's, and roofs have none");
    layout.atlas = shown;
}

bool Workspace::blows() const {
    const float* wind = scene().look.wind;
    return wind[0] != 0 || wind[1] != 0 || wind[2] != 0;
}

bool Workspace::readStats() {
    if (espReadStats(context.get(), &stats) == ESP_OK && espReadRoofStats(context.get(), &roofs) == ESP_OK) return true;
    error = espLastError(context.get());
    return false;
}

Workspace::Hands Workspace::hands() const {
    Hands all{brush.layer, plantGrammar, openGrammar, house, houseEdge, {}, {}, 0};
    all.view = {espalier::scene::nameOf(scene().look.view), scene().viewLayer};
    EspHouseInfo info;
    if (house && espHouseInfo(context.get(), *house, &info) == ESP_OK)
        all.houseId = info.id, all.houseCorners = info.cornerCount;
    return all;
}

void Workspace::takeUp(const Hands& hands) {
    redraw = true;
    (void)document->perform(hands.view, error);
    if (std::ranges::find(scene().layers, hands.layer) != scene().layers.end()) brush.layer = hands.layer;
    if (hands.plantGrammar < scene().grammars.size()) plantGrammar = hands.plantGrammar;
    if (hands.openGrammar < scene().grammars.size()) openGrammar = hands.openGrammar;
    if (!hands.house) return;
    EspHouseInfo info;
    const auto is = [&](uint32_t i) {
        return espHouseInfo(context.get(), i, &info) == ESP_OK && hands.houseId == info.id;
    };
    if (is(*hands.house)) house = hands.house;
    for (uint32_t i = 0; !house && !hands.houseId.empty() && i < espHouseCount(context.get()); ++i)
        if (is(i)) house = i;
    if (house && hands.houseCorners == info.cornerCount) houseEdge = hands.houseEdge;
}

bool Workspace::townLayer(const std::string& name) const {
    return espalier::scene::isTownsAlone(context.get(), scene(), channelsOf(scene(), name)[0]);
}

// Over surfaces what is painted is seen by its view, over roofs by what it does to them, unless it is asked for.
void Workspace::chooseLayer(const std::string& name) {
    using espalier::document::SetView;
    const bool seen = scene().look.view == ESP_VIEW_LAYER;
    brush.layer = name;
    if (townLayer(name) ? seen && townLayer(scene().viewLayer) : seen || tool == Tool::paint)
        perform(SetView{"layer", name});
    else if (seen)
        perform(SetView{"shaded", ""});
}

void Workspace::showLayer(bool seen) {
    perform(espalier::document::SetView{seen ? "layer" : "shaded", seen ? brush.layer : ""});
}

void Workspace::followLayers() {
    const auto& layers = scene().layers;
    const auto there = [&](const std::string& name) { return std::ranges::find(layers, name) != layers.end(); };
    if (!there(brush.layer)) brush.layer = layers.empty() ? "" : layers.front();
    const EspView shown = scene().look.view;
    const bool stays = shown == ESP_VIEW_FIELD ? std::ranges::count(designedFields(*this), scene().viewLayer) > 0
                                               : shown != ESP_VIEW_LAYER || there(scene().viewLayer);
    if (stays) return;
    const bool seen = tool == Tool::paint && !brush.layer.empty() && !townLayer(brush.layer);
    const espalier::document::SetView view{seen ? "layer" : "shaded", seen ? brush.layer : ""};
    redraw = true;
    (void)document->perform(view, error);  // what was said of the text stays
}

std::optional<EspHit> Workspace::pick(glm::vec2 at) const {
    const Ray ray = rayThrough(at);
    EspHit found;
    if (espPick(context.get(), &ray.origin.x, &ray.direction.x, &found) != ESP_OK) return {};
    return found;
}

}  // namespace sample
