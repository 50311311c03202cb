// The chosen house: kind of roof, pitch, height, and what its chosen edge has of its own.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::House;
using espalier::scene::HouseLook;
using espalier::scene::houseNow;

constexpr float kDegrees = 180 / 3.14159265f;
constexpr float kUsualPitch = 40;                       // degrees, where a pitch of its own begins
constexpr float kLowestWalls = 1, kHighestWalls = 100;  // metres
constexpr const char* kTitles[] = {"Hip",  "Gable",   "Half-hip", "Pyramid",
                                   "Shed", "Gambrel", "Mansard",  "Flat"};  // by EspRoofShape

struct Edit {
    bool changed = false;
    uint32_t gesture = 0;
    void note(Workspace& work, bool now) {
        if (!now) return;
        changed = true;
        gesture = widgetGesture(work);
    }
};

// A pitch as the designer thinks of it, in degrees; slope 0: none of its own.
void pitch(Workspace& work, Edit& edit, const char* label, float& slope) {
    ImGui::PushID(label);
    bool own = slope > 0;
    const bool switched = ImGui::Checkbox(label, &own);
    toolTip("A pitch of its own; without it the kind of roof decides");
    edit.note(work, switched);
    if (switched) slope = own ? std::tan(kUsualPitch / kDegrees) : 0;
    if (own) {
        float degrees = std::atan(slope) * kDegrees;
        ImGui::SameLine(ImGui::GetFontSize() * 6.2f);
        ImGui::SetNextItemWidth(-1);
        const bool moved = slider("##degrees", &degrees, 5, 80, "%.0f\u00b0");
        edit.note(work, moved);
        if (moved) slope = std::tan(degrees / kDegrees);
    }
    ImGui::PopID();
}

// One pitch means the same for both.
bool pitchedAlike(const std::string& kind, const std::string& other) {
    const auto even = [](const std::string& of) {
        return of == "hip" || of == "gable" || of == "half-hip" || of == "pyramid";
    };
    return kind == other || (even(kind) && even(other));
}

// A pitch that the user has set stays, and the plan's among kinds that are pitched alike. Others come with their own.
void chooseKind(const Workspace& work, House& house, const std::string& kind) {
    const auto& planned = work.scene().plannedRoofs[house.index];
    const bool set = house.slope > 0 && house.slope != planned.slope;
    if (!set && kind != house.shape) house.slope = pitchedAlike(kind, planned.shape) ? planned.slope : 0;
    house.shape = kind;
}

// A flat roof has the same edge all around, a shed one that is low; what others carry is chosen edge by edge.
const char* endTitle(const std::string& end, const std::string& shape) {
    if (end.empty()) return "As the kind says";
    return end == "gable" ? "Gable" : shape == "shed" ? "Low side" : "Eave";
}
bool carriesEnds(const House& house) {
    return house.shape != "flat";
}
bool carriesPitches(const House& house) {
    return house.shape != "flat" && house.shape != "shed";
}

void edgePanel(Workspace& work, Edit& edit, House& house) {
    const uint32_t number = *work.houseEdge;
    auto own = std::find_if(house.edges.begin(), house.edges.end(),
                            [&](const House::Edge& edge) { return edge.edge == number; });
    House::Edge edge = own == house.edges.end() ? House::Edge{number, "", 0} : *own;
    ImGui::Text("Edge %u of %zu", number + 1, house.corners.size());
    constexpr const char* kEnds[] = {"", "gable", "eave"};
    const bool shed = house.shape == "shed";
    ImGui::BeginDisabled(!carriesEnds(house));
    rowLabel("Carries");
    if (beginCombo("##end", endTitle(edge.end, house.shape))) {
        for (const char* end : kEnds)
            if (!(shed && end == std::string("gable")) &&
                ImGui::Selectable(endTitle(end, house.shape), edge.end == end)) {
                edge.end = end;
                edit.note(work, true);
            }
        ImGui::EndCombo();
    }
    ImGui::EndDisabled();
    toolTip(shed ? "The edge that the roof falls to; the others are walls" : "What the roof does over the chosen edge");
    ImGui::BeginDisabled(edge.end == "gable" || !carriesPitches(house));  // a wall
    ImGui::PushID(int(number));
    const bool plain = edge.slope == 0;
    pitch(work, edit, "Pitch##edge", edge.slope);
    if (plain && edge.slope > 0 && edge.end.empty()) edge.end = "eave";  // where the kind has a gable it no longer does
    ImGui::PopID();
    ImGui::EndDisabled();
    if (!edit.changed) return;
    if (shed && edge.end == "eave") std::erase_if(house.edges, [](const House::Edge& e) { return e.end == "eave"; });
    own = std::find_if(house.edges.begin(), house.edges.end(), [&](const House::Edge& e) { return e.edge == number; });
    if (own == house.edges.end())
        house.edges.push_back(edge);
    else
        *own = edge;
    std::erase_if(house.edges, [](const House::Edge& e) { return e.end.empty() && e.slope == 0; });
}

// What covers the roof, its colour, overhang and chimneys.
void lookPanel(Workspace& work, Edit& edit, HouseLook& look) {
    struct Choice {
        const char *name, *title;
    };
    const auto choose = [&](const char* label, std::string& chosen, std::span<const Choice> choices, const char* tip) {
        rowLabel(label);
        const auto now = std::ranges::find(choices, chosen, [](const Choice& c) { return std::string(c.name); });
        ImGui::PushID(label);
        if (beginCombo("##choice", now == choices.end() ? chosen.c_str() : now->title)) {
            for (const Choice& choice : choices)
                if (ImGui::Selectable(choice.title, chosen == choice.name)) {
                    chosen = choice.name;
                    edit.note(work, true);
                }
            ImGui::EndCombo();
        }
        ImGui::PopID();
        toolTip(tip);
    };
    constexpr Choice kCoverings[] = {{"any", "As the grammar says"},   {"tiles", "Tiles of any kind"},
                                     {"plain_tiles", "Plain tiles"},   {"pan_tiles", "Pan tiles"},
                                     {"barrel_tiles", "Barrel tiles"}, {"slate", "Slate"},
                                     {"metal", "Metal sheets"},        {"copper", "Copper"}};
    constexpr Choice kChimneys[] = {{"any", "As the grammar says"}, {"none", "None"}, {"all", "On every ridge"}};
    choose("Covering", look.covering, kCoverings, "What lies on the roof; the grammar draws it");
    bool coloured = !look.colour.empty();
    const bool switched = ImGui::Checkbox("Colour", &coloured);
    toolTip("A colour of its own for the covering");
    edit.note(work, switched);
    if (switched) look.colour = coloured ? std::vector<float>{.19f, .066f, .04f} : std::vector<float>{};
    if (coloured) {
        ImGui::SameLine(ImGui::GetFontSize() * 6.2f);
        ImGui::SetNextItemWidth(-1);
        edit.note(work, editColour("##colour", look.colour.data()));
    }
    bool overhangs = look.overhang > 0;
    const bool own = ImGui::Checkbox("Overhang", &overhangs);
    toolTip("How far the eaves reach over the walls; without it the grammar decides");
    edit.note(work, own);
    if (own) look.overhang = overhangs ? .4f : 0;
    if (overhangs) {
        ImGui::SameLine(ImGui::GetFontSize() * 6.2f);
        ImGui::SetNextItemWidth(-1);
        edit.note(work, slider("##overhang", &look.overhang, .02f, 1, "%.2f m"));
    }
    choose("Chimneys", look.chimneys, kChimneys, "On ridges that are long enough");
}

}  // namespace

void housesPanel(Workspace& work) {
    EspHouseInfo info;
    if (!work.house || espHouseInfo(work.context.get(), *work.house, &info) != ESP_OK) {
        ImGui::TextDisabled("%s", espHouseCount(work.context.get()) ? "Click a house" : "This scene has no town");
        return;
    }
    const auto& town = work.scene().town;
    if (!town) return ImGui::TextDisabled("A graph has made these houses, and changes them");
    House house = houseNow(work.context.get(), *work.house);
    ImGui::BeginDisabled(town->mark(*work.house).locked);
    ImGui::PushID(int(*work.house));  // what is typed is this one's
    ImGui::Text("%s", info.id);
    ImGui::SameLine();
    ImGui::TextDisabled("ridge %.1f m", info.ridgeHeight - info.baseHeight);
    Edit edit;
    rowLabel("Roof");
    if (beginCombo("##kind", kTitles[info.shape])) {
        for (int i = 0; i < int(std::size(kTitles)); ++i)
            if (ImGui::Selectable(kTitles[i], i == int(info.shape))) {
                chooseKind(work, house, espalier::scene::nameOf(EspRoofShape(i)));
                edit.note(work, true);
            }
        ImGui::EndCombo();
    }
    toolTip("Of the whole house; a chosen edge may differ");
    if (info.note[0]) hint(info.note);
    const float planned = work.scene().plannedRoofs[*work.house].eaveHeight;
    const float lowest = planned > 0 ? std::min(kLowestWalls, planned) : kLowestWalls;
    edit.note(work,
              labelledSlider("Walls", &house.eaveHeight, lowest, std::max(kHighestWalls, planned), "%.1f m", true));
    toolTip("Height of the eaves above the house's foot");
    ImGui::BeginDisabled(house.shape == "flat");
    pitch(work, edit, "Pitch", house.slope);
    ImGui::EndDisabled();
    if (house.look) lookPanel(work, edit, *house.look);
    if (work.houseEdge && *work.houseEdge < house.corners.size()) {
        ImGui::Separator();
        edgePanel(work, edit, house);
    } else {
        aside("Click an edge of the outline for a gable or a pitch of its own");
    }
    if (edit.changed) work.perform(SetHouse{house}, edit.gesture);
    ImGui::BeginDisabled(!std::ranges::count(town->houses, *work.house, &House::index));
    if (ImGui::Button("Reset to plan", {-1, 0})) work.perform(ResetHouse{*work.house});
    toolTip("Back to what the town's file says");
    ImGui::EndDisabled();
    if (std::ranges::any_of(work.scene().surfaces, [](const auto& surface) { return !surface.drawn; })) {
        aside("Plants keep to walls as they were baked: they don't follow an outline.");
    }
    ImGui::PopID();
    ImGui::EndDisabled();
}

}  // namespace sample
