// A scene's JSON -> SceneFile. Every key is checked; what isn't known is an error, so that a misspelt key isn't
// passed over.
#include "tools/scene/scene_file.hpp"

#include <algorithm>
#include <cmath>

#include "tools/scene/hash.hpp"
#include "tools/scene/json_checks.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

class Reader : JsonChecks {
  public:
    Reader(std::string path, SceneFile& out) : JsonChecks(std::move(path)), out_(out) {}
    using JsonChecks::errors;

    void readScene(const Json& json) {
        if (!readVersion(json)) return;
        if (!isObject(json, "a scene",
                      {"project",  "follows", "surface", "surfaces", "town",      "pruned",   "walk",
                       "grammars", "filled",  "layers",  "camera",   "bookmarks", "sun",      "sky",
                       "ground",   "site",    "pieces",  "graphs",   "wind",      "exposure", "locked_layers"}))
            return;
        if (json.find("follows")) word(json, "follows", out_.follows);
        if (const Json* graphs = json.find("graphs")) readGraphs(*graphs);
        readSurfaces(json);
        // A scene of graphs alone grows nothing.
        const Json* grammars = out_.graphs.empty() ? need(json, "grammars") : json.find("grammars");
        if (grammars) {
            if (grammars->kind != Json::Kind::list || (grammars->items.empty() && out_.graphs.empty()))
                fail(*grammars, "'grammars' must be a list of at least one");
            for (const Json& grammar : grammars->items) readGrammar(grammar);
        }
        if (const Json* town = json.find("town")) readTown(*town);
        if (const Json* site = json.find("site")) out_.site = file(*site);
        if (const Json* pieces = json.find("pieces")) out_.pieces = file(*pieces);
        if (const Json* pruned = json.find("pruned")) readPruned(*pruned);
        if (const Json* walk = json.find("walk");
            walk && (walk->kind != Json::Kind::text || !walkNamed(walk->text, out_.walk)))
            fail(*walk, "'walk' must be \"intrinsic\" or \"paper\"");
        if (const Json* filled = json.find("filled")) {
            if (filled->kind != Json::Kind::object) fail(*filled, "'filled' must be an object");
            for (const auto& [name, value] : filled->members) readFilled(name, value);
        }
        if (const Json* layers = json.find("layers")) {
            if (layers->kind != Json::Kind::object) fail(*layers, "'layers' must be an object");
            for (const auto& [name, picture] : layers->members) readLayer(name, picture);
        }
        if (const Json* locked = list(json, "locked_layers"))
            for (const Json& layer : locked->items) {
                if (layer.kind != Json::Kind::text) fail(layer, "'locked_layers' must be names of layers");
                out_.lockedLayers.push_back(layer.text);
            }
        if (const Json* camera = json.find("camera")) readCamera(*camera);
        if (const Json* bookmarks = list(json, "bookmarks"))
            for (const Json& bookmark : bookmarks->items) readBookmark(bookmark);
        if (const Json* sun = json.find("sun");
            sun && isObject(*sun, "'sun'", {"direction", "colour", "intensity", "hour", "shadows"})) {
            number(*sun, "hour", 0, 24, out_.hour);
            flag(*sun, "shadows", out_.shadows);
            if (vector(*sun, "direction", out_.sunDirection) && *out_.sunDirection == std::array<float, 3>{})
                fail(*sun->find("direction"), "'direction' must not be 0");
            vector(*sun, "colour", out_.sunColour);
            number(*sun, "intensity", 0, 1e4f, out_.sunIntensity);
        }
        if (const Json* sky = json.find("sky");
            sky && isObject(*sky, "'sky'", {"colour", "ground", "background", "horizon"})) {
            vector(*sky, "colour", out_.skyColour);
            vector(*sky, "ground", out_.groundColour);
            vector(*sky, "background", out_.background);
            vector(*sky, "horizon", out_.horizon);
        }
        if (const Json* ground = json.find("ground");
            ground && isObject(*ground, "'ground'", {"kind", "level", "overgrows"})) {
            number(*ground, "level", -1e5f, 1e5f, out_.groundLevel.emplace(0.f));
            flag(*ground, "overgrows", out_.groundOvergrows);
            if (const Json* kind = ground->find("kind");
                kind && (kind->kind != Json::Kind::text || !groundNamed(kind->text, out_.ground) ||
                         out_.ground == ESP_GROUND_NONE))
                fail(*kind, "'kind' must be \"meadow\" or \"studio\"");
        }
        if (const Json* wind = json.find("wind"); wind && isObject(*wind, "'wind'", {"velocity", "gusts"})) {
            vector(*wind, "velocity", out_.wind);
            number(*wind, "gusts", 0, 1, out_.gusts);
        }
        number(json, "exposure", -kMostExposure, kMostExposure, out_.exposure);
    }

  private:
    // False: nothing else of the file can be judged.
    bool readVersion(const Json& json) {
        const Json* version = json.find("project");
        if (!version) return true;
        if (version->kind != Json::Kind::number || version->number < 1 ||
            version->number != std::floor(version->number) || version->number > 1e6) {
            fail(*version, "'project' must be the version of the project's format, a whole number");
            return false;
        }
        out_.project = int(version->number);
        if (out_.project <= SceneFile::kProjectVersion) return true;
        fail(*version, "this project was saved by a newer Espalier (format " + std::to_string(out_.project) +
                           "); this one reads up to " + std::to_string(SceneFile::kProjectVersion));
        return false;
    }
    void readGraphs(const Json& json) {
        if (json.kind != Json::Kind::list || json.items.empty())
            fail(json, "'graphs' must be a list of at least one file");
        for (const Json& graph : json.items) {
            if (graph.kind != Json::Kind::object) {
                out_.graphs.push_back({file(graph)});
                continue;
            }
            if (!isObject(graph, "a graph", {"file", "text", "runs"})) continue;
            SceneGraph& read = out_.graphs.emplace_back();
            if (const Json* name = need(graph, "file")) read.file = file(*name);
            lines(graph, "text", read.text);
            if (lines(graph, "runs", read.runs) && !read.text) fail(graph, "'runs' needs a 'text'");
        }
    }
    void readSurfaces(const Json& json) {
        const Json* one = json.find("surface");
        const Json* many = json.find("surfaces");
        if (one && many) fail(*one, "'surface' and 'surfaces' exclude each other");
        if (one) out_.surfaces.push_back({file(*one), {}});
        if (!one && !many && !json.find("town") && out_.graphs.empty()) fail(json, "'surface' is missing");
        if (!many) return;
        if (many->kind != Json::Kind::list) fail(*many, "'surfaces' must be a list");
        for (const Json& surface : many->items) {
            if (!isObject(surface, "a surface",
                          {"file", "position", "turn", "scale", "mirror", "drawn", "hidden", "locked", "fields"}))
                continue;
            SceneSurface& placed = out_.surfaces.emplace_back();
            if (const Json* name = need(surface, "file")) placed.file = file(*name);
            readPlace(surface, placed.placing);
            number(surface, "scale", 1e-6f, 1e6f, placed.placing.scale);
            flag(surface, "mirror", placed.placing.mirror);
            flag(surface, "drawn", placed.drawn);
            flag(surface, "hidden", placed.hidden);
            flag(surface, "locked", placed.locked);
            if (const Json* fields = surface.find("fields")) readFields(*fields, placed.fields);
        }
    }
    void readFields(const Json& json, std::vector<SceneField>& fields) {
        if (json.kind != Json::Kind::object) return (void)fail(json, "'fields' must be an object");
        for (const auto& [called, said] : json.members) {
            if (!isObject(said, "a field", {"drift", "lean", "exact", "mode", "passes", "file", "elements", "strokes"}))
                continue;
            SceneField& field = fields.emplace_back();
            field.name = called;
            std::optional<std::array<float, 3>> drift;
            vector(said, "drift", drift);
            field.drift = drift.value_or(field.drift);
            number(said, "lean", 0, 1e6f, field.lean);
            flag(said, "exact", field.exact);
            if (const Json* mode = said.find("mode")) {
                field.summed = mode->text == "rbf";
                if (mode->text != "solve" && !field.summed) fail(*mode, "'mode' must be \"solve\" or \"rbf\"");
                if (field.summed && field.exact) fail(*mode, "a field of the mode \"rbf\" can't be exact");
            }
            whole(said, "passes", field.passes, 10000);
            if (const Json* elements = list(said, "elements"))
                for (const Json& element : elements->items) readElement(element, field.elements.emplace_back());
            if (const Json* name = said.find("file")) field.file = file(*name);
            if (const Json* strokes = list(said, "strokes"))
                for (const Json& stroke : strokes->items) readStroke(stroke, field.strokes.emplace_back());
        }
    }
    void readStroke(const Json& json, SceneStroke& stroke) {
        if (!isObject(json, "a stroke", {"brush", "radius", "strength", "points"})) return;
        EspFieldBrush known;
        if (json.find("brush")) word(json, "brush", stroke.brush);
        if (!fieldBrushNamed(stroke.brush, known)) fail(json, "'brush' must be \"comb\" or \"smooth\"");
        number(json, "radius", 0, 1e9f, stroke.radius);
        number(json, "strength", 0, 1, stroke.strength);
        if (const Json* points = list(json, "points"))
            for (const Json& point : points->items)
                if (!numbers(point, stroke.points.emplace_back())) fail(point, "a point must be three numbers");
    }
    void readElement(const Json& json, SceneElement& element) {
        if (!isObject(json, "an element", {"kind", "position", "direction", "radius"})) return;
        EspElementKind known;
        if (json.find("kind")) word(json, "kind", element.kind);
        if (!elementNamed(element.kind, known)) fail(json, "there is no element of the kind '" + element.kind + "'");
        if (const Json* at = need(json, "position"); at && !numbers(*at, element.position))
            fail(*at, "'position' must be three numbers");
        if (const Json* to = json.find("direction"); to && !numbers(*to, element.direction))
            fail(*to, "'direction' must be three numbers");
        number(json, "radius", 0, 1e9f, element.radius);
    }
    void readPlace(const Json& json, Placing& placing) {
        if (const Json* at = json.find("position"); at && !numbers(*at, placing.position))
            fail(*at, "'position' must be three numbers");
        float degrees = 0;
        number(json, "turn", -360, 360, degrees);
        placing.turn = turnOfDegrees(degrees);
    }
    void readTown(const Json& json) {
        if (!isObject(json, "'town'", {"file", "grammar", "position", "turn", "ground", "houses", "marks"})) return;
        SceneTown& town = out_.town.emplace();
        if (const Json* name = need(json, "file")) town.file = file(*name);
        readPlace(json, town.placing);
        index(json, "grammar", out_.grammars.size(), town.grammar);
        if (const Json* houses = list(json, "houses"))
            for (const Json& house : houses->items) readHouse(house, town.houses.emplace_back());
        if (const Json* marks = list(json, "marks"))
            for (const Json& mark : marks->items) readMark(mark, town.marks.emplace_back());
        const Json* ground = json.find("ground");
        if (!ground) return;
        std::array<float, 3> colour{};
        if (ground->kind == Json::Kind::flag)
            town.ground = ground->flag;
        else if (numbers(*ground, colour))
            town.groundColour = colour;
        else
            fail(*ground, "'ground' must be true, false or a colour of three numbers");
    }
    void readMark(const Json& json, HouseMark& mark) {
        if (!isObject(json, "a mark", {"house", "id", "hidden", "locked"})) return;
        if (need(json, "house")) whole(json, "house", mark.index);
        if (json.find("id")) word(json, "id", mark.id);
        flag(json, "hidden", mark.hidden);
        flag(json, "locked", mark.locked);
    }
    void readHouse(const Json& json, House& house) {
        if (!isObject(json, "a house",
                      {"house", "id", "shape", "slope", "eave_height", "edges", "corners", "rings", "look"}))
            return;
        EspRoofShape known;
        if (need(json, "house")) whole(json, "house", house.index);
        if (json.find("id")) word(json, "id", house.id);
        word(json, "shape", house.shape);
        if (!shapeNamed(house.shape, known)) fail(json, "there is no roof of the kind '" + house.shape + "'");
        number(json, "slope", 0, 100, house.slope);
        number(json, "eave_height", 0, 1000, house.eaveHeight);
        if (const Json* edges = list(json, "edges"))
            for (const Json& edge : edges->items) {
                if (!isObject(edge, "an edge", {"edge", "end", "slope"})) continue;
                House::Edge& own = house.edges.emplace_back();
                whole(edge, "edge", own.edge);
                word(edge, "end", own.end);
                number(edge, "slope", 0, 100, own.slope);
            }
        if (const Json* corners = list(json, "corners"))
            for (const Json& corner : corners->items)
                if (!numbers(corner, house.corners.emplace_back())) fail(corner, "a corner must be two numbers");
        if (const Json* rings = list(json, "rings")) readRings(*rings, house);
        if (const Json* look = json.find("look")) readLook(*look, house.look.emplace());
    }
    void readLook(const Json& json, HouseLook& look) {
        if (!isObject(json, "a house's look", {"covering", "colour", "overhang", "chimneys"})) return;
        EspCovering covering;
        EspChimneys chimneys;
        if (json.find("covering")) word(json, "covering", look.covering);
        if (!coveringNamed(look.covering, covering)) fail(json, "there is no covering '" + look.covering + "'");
        if (json.find("chimneys")) word(json, "chimneys", look.chimneys);
        if (!chimneysNamed(look.chimneys, chimneys)) fail(json, "'chimneys' must be \"any\", \"none\" or \"all\"");
        number(json, "overhang", 0, 1, look.overhang);
        std::optional<std::array<float, 3>> colour;
        vector(json, "colour", colour);
        if (colour) look.colour.assign(colour->begin(), colour->end());
    }
    void readRings(const Json& json, House& house) {
        size_t left = house.corners.size();
        for (const Json& count : json.items) {
            const bool fits = count.kind == Json::Kind::number && count.number >= 3 && count.number <= double(left) &&
                              count.number == std::floor(count.number);
            if (!fits) return fail(count, "a ring must have three or more of the corners, each ring others");
            house.rings.push_back(uint32_t(count.number));
            left -= house.rings.back();
        }
        if (left > 0) fail(json, std::to_string(left) + " corners are of no ring");
    }
    // Keys have 64 bits, more than a number of JSON holds.
    void readPruned(const Json& json) {
        if (json.kind != Json::Kind::list) fail(json, "'pruned' must be a list of keys");
        for (const Json& key : json.items) {
            const auto value = key.kind == Json::Kind::text ? keyNamed(key.text) : std::nullopt;
            if (value)
                out_.pruned.push_back(*value);
            else
                fail(key, "a branch's key must be 16 hexadecimal digits");
        }
    }
    void needLayersName(const std::string& name, const Json& json) {
        if (std::string why; !isLayersName(name, why)) fail(json, why);
    }
    void readFilled(const std::string& name, const Json& json) {
        needLayersName(name, json);
        if (json.kind == Json::Kind::number && json.number >= 0 && json.number <= 1)
            out_.filled.push_back({name, float(json.number)});
        else
            fail(json, "a layer is filled with a number from 0 to 1");
    }
    void readLayer(const std::string& name, const Json& json) {
        needLayersName(name, json);
        if (json.kind != Json::Kind::list) return out_.layers.push_back({name, file(json), -1});
        for (const Json& picture : json.items) {
            if (!isObject(picture, "a layer's picture", {"surface", "town", "file", "over", "low", "side"})) continue;
            int surface = 0;
            bool town = false;
            flag(picture, "town", town);
            if (town)
                surface = SceneLayer::kTown;
            else
                index(picture, "surface", out_.surfaces.size(), surface);
            if (town && !out_.town) fail(picture, "the scene has no town");
            const Json* over = picture.find("over");
            if (over && town) fail(*over, "a town has no bakes");
            if (const Json* on = need(picture, "file"))
                out_.layers.push_back({name, file(*on), surface, over ? file(*over) : "", readSquare(picture, town)});
        }
    }
    std::optional<TownSquare> readSquare(const Json& picture, bool town) {
        const Json* low = picture.find("low");
        if (!low && !picture.find("side")) return {};
        if (!town) fail(picture, "only a town's layers have 'low' and 'side'");
        TownSquare square;
        if (need(picture, "side")) number(picture, "side", 1e-3f, 1e9f, square.side);
        if (need(picture, "low") && !numbers(*low, square.low)) fail(*low, "'low' must be two numbers");
        return square;
    }
    void params(const Json& json, std::vector<SceneParam>& out) {
        const Json* found = json.find("params");
        if (!found) return;
        if (found->kind != Json::Kind::object) fail(*found, "'params' must be an object");
        for (const auto& [name, value] : found->members) {
            SceneParam param;
            if (readParam(name, value, param)) out.push_back(param);
        }
    }
    void readGrammar(const Json& json) {
        if (!isObject(json, "a grammar", {"file", "text", "grows", "params", "looks", "seeds"})) return;
        SceneGrammar& grammar = out_.grammars.emplace_back();
        if (const Json* name = need(json, "file")) grammar.file = file(*name);
        lines(json, "text", grammar.text);
        if (lines(json, "grows", grammar.grows) && !json.find("text")) fail(json, "'grows' needs a 'text'");
        params(json, grammar.params);
        if (const Json* looks = json.find("looks")) {
            if (looks->kind != Json::Kind::object) fail(*looks, "'looks' must be an object");
            for (const auto& [name, look] : looks->members) readLook(name, look, grammar.looks);
        }
        if (const Json* seeds = list(json, "seeds"))
            for (const Json& seed : seeds->items) readSeed(grammar, seed);
    }
    void readLook(const std::string& name, const Json& json, std::vector<TerminalLook>& looks) {
        if (!isObject(json, "a look", {"mesh", "picture", "colour"})) return;
        TerminalLook look{name, {}, {}, {}};
        if (const Json* mesh = json.find("mesh")) look.mesh = file(*mesh);
        if (const Json* picture = json.find("picture")) look.picture = file(*picture);
        std::optional<std::array<float, 3>> colour;
        if (vector(json, "colour", colour)) look.colour.assign(colour->begin(), colour->end());
        if (std::ranges::any_of(look.colour, [](float c) { return !(c >= 0 && c <= 1); }))
            fail(*json.find("colour"), "'colour' must be of 0 to 1");
        if (look.plain()) fail(json, "a look needs a 'mesh', a 'picture' or a 'colour'");
        looks.push_back(std::move(look));
    }
    bool readParam(const std::string& name, const Json& value, SceneParam& param) {
        param.value.name = name;
        param.place = place(value);
        if (value.kind == Json::Kind::number)
            param.value.value[0] = float(value.number);
        else if (value.kind == Json::Kind::flag)
            param.value.value[0] = value.flag;
        else if (numbers(value, param.value.value))
            param.value.count = 3;
        else
            fail(value, "'" + name + "' must be a number, true, false or three numbers");
        return value.kind == Json::Kind::number || value.kind == Json::Kind::flag || param.value.count == 3;
    }
    void readSeed(SceneGrammar& grammar, const Json& json) {
        if (!isObject(json, "a seed", {"position", "direction", "seed", "params", "frozen", "hidden", "line", "place"}))
            return;
        Seed seed;
        seed.number = uint32_t(grammar.seeds.size() + 1);
        if (const Json* position = need(json, "position"); position && !numbers(*position, seed.position))
            fail(*position, "'position' must be three numbers");
        if (const Json* direction = json.find("direction"); direction && !numbers(*direction, seed.direction))
            fail(*direction, "'direction' must be three numbers");
        if (const Json* n = json.find("seed")) {
            if (n->kind != Json::Kind::number || n->number < 0 || n->number > 4294967295.0 ||
                n->number != std::floor(n->number))
                fail(*n, "'seed' must be a whole number from 0 to 4294967295");
            else
                seed.number = uint32_t(n->number);
        }
        whole(json, "place", seed.place, 1u << 24);
        flag(json, "hidden", seed.hidden);
        if (const Json* line = list(json, "line"))
            for (const Json& point : line->items)
                if (!numbers(point, seed.line.emplace_back()))
                    fail(point, "a point of a 'line' must be six numbers: position and normal");
        if (const Json* frozen = json.find("frozen")) seed.frozenFile = file(*frozen);
        std::vector<SceneParam> own;
        params(json, own);
        for (const SceneParam& param : own) seed.params.push_back(param.value);
        grammar.seeds.push_back(seed);
    }
    // False: neither is said.
    bool readView(const Json& json, std::array<float, 3>& from, std::array<float, 3>& to) {
        std::optional<std::array<float, 3>> eye, target;
        vector(json, "eye", eye);
        vector(json, "target", target);
        if (eye.has_value() != target.has_value()) fail(json, "'eye' and 'target' belong together");
        if (!eye || !target) return false;
        from = *eye;
        to = *target;
        if (*eye == *target) fail(json, "'eye' and 'target' are the same point");
        return true;
    }
    void readBookmark(const Json& json) {
        if (!isObject(json, "a bookmark", {"digit", "eye", "target", "fov"})) return;
        Bookmark bookmark;
        float fov = 40;
        if (need(json, "digit")) whole(json, "digit", bookmark.digit, kMostBookmarks);
        if (bookmark.digit == 0) fail(json, "'digit' must be a whole number from 1 to 9");
        if (!readView(json, bookmark.eye, bookmark.target)) fail(json, "a bookmark needs 'eye' and 'target'");
        number(json, "fov", kLeastFov, kMostFov, fov);
        bookmark.fov = fovOfDegrees(fov);
        if (std::ranges::find(out_.bookmarks, bookmark.digit, &Bookmark::digit) != out_.bookmarks.end())
            fail(json, "two bookmarks have this digit");
        out_.bookmarks.push_back(bookmark);
    }
    void readCamera(const Json& json) {
        if (!isObject(json, "'camera'", {"eye", "target", "fov"})) return;
        out_.hasCamera = readView(json, out_.eye, out_.target);
        out_.fov = 40;
        number(json, "fov", kLeastFov, kMostFov, out_.fov);
    }

    SceneFile& out_;
};

}  // namespace

void SceneFile::applyLook(EspLook& look) const {
    const auto set = [](float* to, const std::optional<std::array<float, 3>>& from) {
        if (from) std::ranges::copy(*from, to);
    };
    set(look.sunDirection, sunDirection);
    for (int i = 0; i < 3; ++i) look.sunColour[i] = (sunColour ? (*sunColour)[i] : look.sunColour[i]) * sunIntensity;
    set(look.skyColour, skyColour);
    set(look.groundColour, groundColour);
    set(look.background, background);
    set(look.horizon, horizon);
    set(look.wind, wind);
    look.gusts = gusts;
    look.exposure = exposure;
    look.shadows = shadows;
    look.ground = groundLevel ? ground : ESP_GROUND_NONE;
    look.groundLevel = groundLevel.value_or(0);
    look.groundOvergrows = groundOvergrows;
}

bool readSceneFile(const std::string& path, SceneFile& out, std::string& error) {
    std::string text;
    return readText(path, text, error) && readSceneText(path, text, out, error);
}

bool readSceneText(const std::string& path, const std::string& text, SceneFile& out, std::string& error) {
    Json json;
    if (!readJson(text, json, error)) {
        error = path + ":" + error;
        return false;
    }
    Reader reader(path, out);
    reader.readScene(json);
    error = reader.errors();
    return error.empty();
}

}  // namespace espalier::scene
