// SceneFile -> JSON, the inverse of scene_file.cpp.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "tools/scene/json_out.hpp"
#include "tools/scene/scene_file.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

using nlohmann::ordered_json;

using Beside = std::function<std::string(const std::string&)>;

ordered_json linesOf(const std::string& text) {
    ordered_json lines = ordered_json::array();
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

ordered_json placedJson(const std::string& file, const Placing& p) {
    ordered_json json{{"file", file}};
    if (p.position != std::array<float, 3>{}) json["position"] = shortestList(p.position);
    if (p.turn != 0) json["turn"] = shortest(degreesOf(p.turn, turnOfDegrees));
    if (p.scale != 1) json["scale"] = shortest(p.scale);
    if (p.mirror) json["mirror"] = true;
    return json;
}

ordered_json townJson(const SceneTown& town, const std::string& file) {
    ordered_json json = placedJson(file, town.placing);
    if (town.grammar >= 0) json["grammar"] = town.grammar;
    for (const House& house : town.houses) {
        ordered_json& out = json["houses"].emplace_back(ordered_json{{"house", house.index},
                                                                     {"shape", house.shape},
                                                                     {"slope", shortest(house.slope)},
                                                                     {"eave_height", shortest(house.eaveHeight)}});
        if (!house.id.empty()) out["id"] = house.id;
        for (const House::Edge& edge : house.edges)
            out["edges"].push_back({{"edge", edge.edge}, {"end", edge.end}, {"slope", shortest(edge.slope)}});
        for (const auto& corner : house.corners) out["corners"].push_back(shortestList(corner));
        if (!house.rings.empty()) out["rings"] = house.rings;
        if (!house.look) continue;
        ordered_json& look = out["look"] = {{"covering", house.look->covering},
                                            {"overhang", shortest(house.look->overhang)},
                                            {"chimneys", house.look->chimneys}};
        for (float channel : house.look->colour) look["colour"].push_back(shortest(channel));
    }
    for (const HouseMark& mark : town.marks) {
        ordered_json& out = json["marks"].emplace_back(ordered_json{{"house", mark.index}});
        if (!mark.id.empty()) out["id"] = mark.id;
        if (mark.hidden) out["hidden"] = true;
        if (mark.locked) out["locked"] = true;
    }
    if (!town.ground)
        json["ground"] = false;
    else if (town.groundColour)
        json["ground"] = shortestList(*town.groundColour);
    return json;
}

ordered_json fieldJson(const SceneField& field, const Beside& beside) {
    ordered_json json{{"drift", shortestList(field.drift)}, {"lean", shortest(field.lean)}};
    if (field.summed) json["mode"] = "rbf";
    if (field.summed || field.passes != kUsualPasses) json["passes"] = field.passes;
    if (!field.file.empty()) json["file"] = beside(field.file);
    if (field.exact) json["exact"] = true;
    for (const SceneElement& e : field.elements) {
        ordered_json& out = json["elements"].emplace_back(ordered_json{
            {"kind", e.kind}, {"position", shortestList(e.position)}, {"direction", shortestList(e.direction)}});
        if (e.radius > 0) out["radius"] = shortest(e.radius);
    }
    for (const SceneStroke& s : field.strokes) {
        ordered_json& out = json["strokes"].emplace_back(
            ordered_json{{"brush", s.brush}, {"radius", shortest(s.radius)}, {"strength", shortest(s.strength)}});
        for (const auto& point : s.points) out["points"].push_back(shortestList(point));
    }
    return json;
}

ordered_json valueJson(const ParamValue& value) {
    return value.count == 3 ? shortestList(value.value) : shortest(value.value[0]);
}

ordered_json graphJson(const SceneGraph& graph, const Beside& beside) {
    if (!graph.text) return beside(graph.file);
    ordered_json json{{"file", beside(graph.file)}, {"text", linesOf(*graph.text)}};
    if (graph.runs) json["runs"] = linesOf(*graph.runs);
    return json;
}

ordered_json grammarJson(const SceneGrammar& grammar, const Beside& beside) {
    ordered_json json{{"file", beside(grammar.file)}};
    if (grammar.text) json["text"] = linesOf(*grammar.text);
    if (grammar.grows) json["grows"] = linesOf(*grammar.grows);
    ordered_json& params = json["params"] = ordered_json::object();
    for (const SceneParam& param : grammar.params) params[param.value.name] = valueJson(param.value);
    for (const TerminalLook& look : grammar.looks) {
        ordered_json& out = json["looks"][look.terminal] = ordered_json::object();
        if (!look.mesh.empty()) out["mesh"] = beside(look.mesh);
        if (!look.picture.empty()) out["picture"] = beside(look.picture);
        for (float channel : look.colour) out["colour"].push_back(shortest(channel));
    }
    ordered_json& seeds = json["seeds"] = ordered_json::array();
    for (const Seed& seed : grammar.seeds) {
        ordered_json& out = seeds.emplace_back(ordered_json{{"position", shortestList(seed.position)},
                                                            {"direction", shortestList(seed.direction)},
                                                            {"seed", seed.number}});
        if (seed.hidden) out["hidden"] = true;
        for (const auto& point : seed.line) out["line"].push_back(shortestList(point));
        if (seed.place) out["place"] = seed.place;
        if (!seed.frozenFile.empty()) out["frozen"] = beside(seed.frozenFile);
        for (const ParamValue& own : seed.params) out["params"][own.name] = valueJson(own);
    }
    return json;
}

}  // namespace

std::string writeSceneText(const std::string& path, const SceneFile& file) {
    namespace fs = std::filesystem;
    const fs::path folder = absolutePath(path).parent_path();
    const auto beside = [&](const std::string& name) {
        const fs::path near = absolutePath(name).lexically_normal().lexically_relative(folder.lexically_normal());
        return near.empty() ? absolutePath(name).string() : near.string();
    };
    ordered_json json;
    if (file.project) json["project"] = file.project;
    if (!file.follows.empty()) json["follows"] = file.follows;
    if (file.surfaces.empty() && !file.town) json["surfaces"] = ordered_json::array();  // it waits for models
    for (const SceneSurface& surface : file.surfaces) {
        json["surfaces"].push_back(placedJson(beside(surface.file), surface.placing));
        if (!surface.drawn) json["surfaces"].back()["drawn"] = false;
        if (surface.hidden) json["surfaces"].back()["hidden"] = true;
        if (surface.locked) json["surfaces"].back()["locked"] = true;
        for (const SceneField& field : surface.fields)
            json["surfaces"].back()["fields"][field.name] = fieldJson(field, beside);
    }
    if (file.town) json["town"] = townJson(*file.town, beside(file.town->file));
    if (!file.site.empty()) json["site"] = beside(file.site);
    if (!file.pieces.empty()) json["pieces"] = beside(file.pieces);
    for (const SceneGraph& graph : file.graphs) json["graphs"].push_back(graphJson(graph, beside));
    if (file.walk != ESP_WALK_INTRINSIC) json["walk"] = nameOf(file.walk);
    for (uint64_t branch : file.pruned) {
        char key[20];
        std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(branch));
        json["pruned"].push_back(key);
    }
    json["grammars"] = ordered_json::array();
    for (const SceneGrammar& grammar : file.grammars) json["grammars"].push_back(grammarJson(grammar, beside));
    for (const auto& [name, value] : file.filled) json["filled"][name] = shortest(value);
    if (!file.lockedLayers.empty()) json["locked_layers"] = file.lockedLayers;
    for (const SceneLayer& layer : file.layers) {
        if (layer.surface == SceneLayer::kTown) {
            ordered_json picture{{"town", true}, {"file", beside(layer.file)}};
            if (layer.square) {
                picture["low"] = shortestList(layer.square->low);
                picture["side"] = shortest(layer.square->side);
            }
            json["layers"][layer.name].push_back(std::move(picture));
        } else if (layer.surface < 0)
            json["layers"][layer.name] = beside(layer.file);
        else {
            ordered_json picture{{"surface", layer.surface}, {"file", beside(layer.file)}};
            if (!layer.over.empty()) picture["over"] = beside(layer.over);
            json["layers"][layer.name].push_back(std::move(picture));
        }
    }
    if (file.hasCamera)
        json["camera"] = {
            {"eye", shortestList(file.eye)}, {"target", shortestList(file.target)}, {"fov", shortest(file.fov)}};
    for (const Bookmark& bookmark : file.bookmarks) {
        const float fov = std::clamp(degreesOf(bookmark.fov, fovOfDegrees), kLeastFov, kMostFov);
        json["bookmarks"].push_back({{"digit", bookmark.digit},
                                     {"eye", shortestList(bookmark.eye)},
                                     {"target", shortestList(bookmark.target)},
                                     {"fov", shortest(fov)}});
    }
    const auto vector = [](ordered_json& to, const char* name, const std::optional<std::array<float, 3>>& value) {
        if (value) to[name] = shortestList(*value);
    };
    ordered_json sun = ordered_json::object(), sky = ordered_json::object();
    vector(sun, "direction", file.sunDirection);
    vector(sun, "colour", file.sunColour);
    if (file.sunIntensity != 1) sun["intensity"] = shortest(file.sunIntensity);
    if (file.hour != kOwnSun) sun["hour"] = shortest(file.hour);
    if (!file.shadows) sun["shadows"] = false;
    vector(sky, "colour", file.skyColour);
    vector(sky, "ground", file.groundColour);
    vector(sky, "background", file.background);
    vector(sky, "horizon", file.horizon);
    if (!sun.empty()) json["sun"] = sun;
    if (!sky.empty()) json["sky"] = sky;
    if (file.groundLevel) json["ground"] = {{"level", shortest(*file.groundLevel)}};
    if (file.groundLevel && file.ground != ESP_GROUND_MEADOW) json["ground"]["kind"] = nameOf(file.ground);
    if (file.groundLevel && !file.groundOvergrows) json["ground"]["overgrows"] = false;
    if (file.wind) {
        vector(json["wind"], "velocity", file.wind);
        json["wind"]["gusts"] = shortest(file.gusts);
    }
    if (file.exposure != 0) json["exposure"] = shortest(file.exposure);
    return textOf(json, 1) + "\n";
}

}  // namespace espalier::scene
