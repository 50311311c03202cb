// Surfaces, grammars and graphs that come to an open scene, and what takes them back.
#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/document/document.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::document {

namespace {

// As espLoadSurface takes it.
bool canStand(const scene::Placing& place) {
    constexpr float kFarthest = 1e9f, kSmallest = 1e-6f, kLargest = 1e6f;
    const auto near = [](float metres) { return std::abs(metres) <= kFarthest; };
    return std::ranges::all_of(place.position, near) && std::isfinite(place.turn) && place.scale >= kSmallest &&
           place.scale <= kLargest;
}
// Position and normal.
std::array<float, 6> carriedPoint(const std::array<float, 6>& point, const scene::Placing& from,
                                  const scene::Placing& to) {
    const auto position = scene::carried({point[0], point[1], point[2]}, from, to, true);
    const auto normal = scene::carried({point[3], point[4], point[5]}, from, to, false);
    return {position[0], position[1], position[2], normal[0], normal[1], normal[2]};
}

constexpr float kMostRadius = 1e9f;  // metres, as espSetField takes it

void carry(scene::SceneElement& element, const scene::Placing& from, const scene::Placing& to) {
    element.position = scene::carried(element.position, from, to, true);
    element.direction = scene::carried(element.direction, from, to, false);
    element.radius = std::min(element.radius * (to.scale / from.scale), kMostRadius);
}

constexpr const char* kNoPlace = "a surface stands up to 1e9 m away and has a scale of 1e-6 to 1e6";

}  // namespace

bool Document::carryOut(const AddSurface& action, std::vector<Action>& back, std::string& error) {
    scene::LoadedSurface surface{scene::absolutePath(action.file).string(),
                                 {action.position, action.turn, action.scale, action.mirror}};
    if (!canStand(surface.placing)) {
        error = kNoPlace;
        return false;
    }
    if (!scene::isSurface(surface.file, error)) return false;
    if (!scene::loadSurface(context_, scene_, surface, error)) return false;
    scene_.surfaces.push_back(std::move(surface));
    back.push_back(DropLast{DropLast::Kind::surface});
    return true;
}

// Takes a surface's elements to where it will stand. Fails where one of them can't be there.
bool Document::carryFields(uint32_t surface, const scene::Placing& to, std::string& error) {
    const scene::Placing from = scene_.surfaces[surface].placing;
    for (scene::SceneField field : std::vector(scene_.surfaces[surface].fields)) {
        if (field.elements.empty()) continue;
        for (scene::SceneElement& element : field.elements) carry(element, from, to);
        if (!changeField(surface, field.name, field, error)) return false;
    }
    return true;
}

bool Document::carryOut(const PlaceSurface& action, std::vector<Action>& back, std::string& error) {
    const scene::Placing place{action.position, action.turn, action.scale, action.mirror};
    if (action.surface >= scene_.surfaces.size() || !canStand(place)) {
        error = action.surface >= scene_.surfaces.size() ? "there is no surface " + std::to_string(action.surface)
                                                         : kNoPlace;
        return false;
    }
    scene::LoadedSurface& surface = scene_.surfaces[action.surface];
    if (surface.locked) {
        error = scene::lastPart(surface.file) + " is locked, and stays where it is";
        return false;
    }
    ChangeSeeds seeds;  // that stand on it, as they are
    for (const scene::Seed& seed : scene_.seeds)
        if (EspHit hit; espNearest(context_, seed.position.data(), &hit) == ESP_OK && hit.surface.id == surface.id.id)
            seeds.seeds.push_back(recordOf(seed));
    const std::vector<scene::SceneField> fields = surface.fields;
    const EspTransform moved = place.transform();
    if (!carryFields(action.surface, place, error) || failed(espMoveSurface(context_, surface.id, &moved), error)) {
        std::string unheard;
        for (const scene::SceneField& field : fields) (void)changeField(action.surface, field.name, field, unheard);
        return false;
    }
    const scene::Placing before = std::exchange(surface.placing, place);
    for (const SeedRecord& record : seeds.seeds) {
        scene::Seed& seed = scene_.seeds[indexOf(record.key)];
        seed.position = scene::carried(record.position, before, place, true);
        seed.direction = scene::carried(record.direction, before, place, false);
        for (auto& point : seed.line) point = carriedPoint(point, before, place);
    }
    // Plants that went along as they were would be others than those that grow there.
    std::string unplanted;
    (void)plant(unplanted);
    // Taken back from the last to the first: seeds and elements get their own places to the bit.
    for (scene::SceneField stood : fields) {
        if (stood.elements.empty()) continue;
        stood.strokes.clear();  // which stay where they are on the surface
        back.push_back(SetField{action.surface, std::move(stood)});
    }
    if (!seeds.seeds.empty()) back.push_back(std::move(seeds));
    back.push_back(PlaceSurface{action.surface, before.position, before.turn, before.scale, before.mirror});
    return true;
}

bool Document::carryOut(const AddGrammar& action, std::vector<Action>& back, std::string& error) {
    scene::LoadedGrammar grammar;
    grammar.file = scene::absolutePath(action.file).string();
    if (!scene::compileFile(context_, grammar, error)) return false;
    scene_.grammars.push_back(std::move(grammar));
    noteLayers(context_, scene_);
    back.push_back(DropLast{DropLast::Kind::grammar});
    return true;
}

bool Document::carryOut(const AddGraph& action, std::vector<Action>& back, std::string& error) {
    scene::LoadedGraph graph{scene::absolutePath(action.file).string(), action.text, {}, {}, {}};
    if (!scene::compileGraph(context_, scene_, graph, error)) return false;
    scene_.graphs.push_back(std::move(graph));
    back.push_back(DropLast{DropLast::Kind::graph});
    return true;
}

bool Document::carryOut(const DropLast& action, std::vector<Action>& back, std::string& error) {
    if (action.kind == DropLast::Kind::graph) {
        const scene::LoadedGraph& last = scene_.graphs.back();
        if (failed(espDestroyGraph(context_, last.id), error)) return false;
        back.push_back(AddGraph{last.file, last.text});
        scene_.graphs.pop_back();
        return true;
    }
    if (action.kind == DropLast::Kind::grammar) {
        const scene::LoadedGrammar& last = scene_.grammars.back();
        if (failed(espDestroyGrammar(context_, last.id), error)) return false;
        back.push_back(AddGrammar{last.file});
        scene_.grammars.pop_back();
        noteLayers(context_, scene_);
        return true;
    }
    const scene::LoadedSurface& last = scene_.surfaces.back();
    if (failed(espDestroySurface(context_, last.id), error)) return false;
    back.push_back(
        AddSurface{last.file, last.placing.position, last.placing.turn, last.placing.scale, last.placing.mirror});
    scene_.surfaces.pop_back();
    return true;
}

}  // namespace espalier::document
