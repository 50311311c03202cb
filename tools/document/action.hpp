#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "tools/document/graph_action.hpp"
#include "tools/scene/scene.hpp"

namespace espalier::document {

// What can be done to a document, each thing a plain record: the window performs them, undo is made of them, and a
// recorded run is a list of them. Indices and keys are those of scene::Scene. kName is the word for it in a run.

struct Param {
    std::string name;
    std::vector<float> value;  // one number, or three of a colour
    template <class V>
    void fields(V&& v) {
        v("name", name), v("value", value);
    }
    bool operator==(const Param&) const = default;
};
struct SetParam {
    static constexpr const char* kName = "param";
    uint32_t grammar = 0;
    Param param;
    template <class V>
    void fields(V&& v) {
        v("grammar", grammar), v("param", param);
    }
};
// The text of a grammar, and the parameters that aren't its own; all others are as the text says. (A text that lost a
// parameter and gets it back would otherwise not know its value.)
struct SetText {
    static constexpr const char* kName = "text";
    uint32_t grammar = 0;
    std::string text;
    std::vector<Param> params;
    std::string grows = {};  // what grew while the text had mistakes; kept for undo, no part of a run
    template <class V>
    void fields(V&& v) {
        v("grammar", grammar), v("text", text), v("params", params);
    }
};
struct SeedRecord {
    uint32_t key = 0;
    uint32_t grammar = 0;
    std::array<float, 3> position{}, direction{};
    uint32_t number = 1;
    std::vector<Param> params = {};  // in place of its grammar's
    scene::FrozenPlant frozen = {};  // kept for undo; no part of a run, which freezes by an action of its own
    bool hidden = false;             // likewise
    std::vector<std::array<float, 6>> line = {};  // as of scene::Seed
    template <class V>
    void fields(V&& v) {
        v("key", key), v("grammar", grammar), v("position", position), v("direction", direction), v("number", number);
        v("params", params);
        v.optional("line", line);
    }
    bool operator==(const SeedRecord&) const = default;
};
// Seeds that come: at their places in the scene's list, since the order tells seeds of one number apart.
struct AddSeeds {
    static constexpr const char* kName = "plant";
    std::vector<SeedRecord> seeds;
    std::vector<uint32_t> places;  // rising; where each stands afterwards
    template <class V>
    void fields(V&& v) {
        v("seeds", seeds), v("places", places);
    }
};
struct RemoveSeeds {
    static constexpr const char* kName = "remove_seeds";
    std::vector<uint32_t> keys;
    template <class V>
    void fields(V&& v) {
        v("keys", keys);
    }
};
struct ChangeSeeds {
    static constexpr const char* kName = "change_seeds";
    std::vector<SeedRecord> seeds;  // told apart by key
    template <class V>
    void fields(V&& v) {
        v("seeds", seeds);
    }
};
// Their plants stand as they are from now on, or grow again.
struct FreezeSeeds {
    static constexpr const char* kName = "freeze";
    std::vector<uint32_t> keys;
    bool frozen = true;
    template <class V>
    void fields(V&& v) {
        v("keys", keys), v("frozen", frozen);
    }
};
struct PruneBranch {
    static constexpr const char* kName = "prune";
    std::string branch;  // its key, 16 hexadecimal digits
    bool pruned = true;
    template <class V>
    void fields(V&& v) {
        v("branch", branch), v("pruned", pruned);
    }
};
struct SetHouse {
    static constexpr const char* kName = "house";
    scene::House house;
    template <class V>
    void fields(V&& v) {
        house.fields(v);
    }
};
// As the town's file says.
struct ResetHouse {
    static constexpr const char* kName = "reset_house";
    uint32_t house = 0;
    template <class V>
    void fields(V&& v) {
        v("house", house);
    }
};
struct SetLight {
    static constexpr const char* kName = "light";
    float hour = -1;  // 0 to 24, -1: the scene's own light
    float exposure = 0;
    bool shadows = true;
    template <class V>
    void fields(V&& v) {
        v("hour", hour), v("exposure", exposure), v("shadows", shadows);
    }
};

// What one field of one surface is made from, but for strokes of brushes.
struct SetField {
    static constexpr const char* kName = "field";
    uint32_t surface = 0;
    scene::SceneField field;
    bool said = true;  // false: as a field is of which nothing is said
    template <class V>
    void fields(V&& v) {
        v("surface", surface), v("said", said), v("field", field);
    }
};

// A stroke of a brush over a field, as its last, or more points of the last one; the field needn't have been told of.
struct BrushField {
    static constexpr const char* kName = "brush_field";
    uint32_t surface = 0;
    std::string field;
    scene::SceneStroke stroke;
    bool goesOn = false;  // with the last stroke, which is of the same brush
    template <class V>
    void fields(V&& v) {
        v("surface", surface), v("field", field), v("stroke", stroke);
        v.optional("goes_on", goesOn);
    }
};
// Keeps the first strokes of a field, and of the last of these the first points.
struct TrimField {
    static constexpr const char* kName = "trim_field";
    uint32_t surface = 0;
    std::string field;
    uint32_t strokes = 0, points = 0;
    bool said = true;  // false: as a field is of which nothing is said
    template <class V>
    void fields(V&& v) {
        v("surface", surface), v("field", field), v("strokes", strokes), v("points", points), v("said", said);
    }
};

// A surface that comes to the scene, as its last; what grows on others may go on over it.
struct AddSurface {
    static constexpr const char* kName = "surface";
    std::string file;  // that espalier-bake wrote
    std::array<float, 3> position{};
    float turn = 0, scale = 1;  // as of scene::Placing
    bool mirror = false;
    template <class V>
    void fields(V&& v) {
        v("file", file), v("position", position), v("turn", turn), v("scale", scale);
        v.optional("mirror", mirror);
    }
};
// Puts a surface elsewhere, with what is planted and painted on it, and with its fields' elements.
struct PlaceSurface {
    static constexpr const char* kName = "place_surface";
    uint32_t surface = 0;
    std::array<float, 3> position{};
    float turn = 0, scale = 1;
    bool mirror = false;
    template <class V>
    void fields(V&& v) {
        v("surface", surface), v("position", position), v("turn", turn), v("scale", scale);
        v.optional("mirror", mirror);
    }
};
// A grammar that comes to the scene, as its last.
struct AddGrammar {
    static constexpr const char* kName = "grammar";
    std::string file;
    template <class V>
    void fields(V&& v) {
        v("file", file);
    }
};

// How one kind of terminal of a grammar looks; without files and colour as shipped.
struct SetLook {
    static constexpr const char* kName = "look";
    uint32_t grammar = 0;
    std::string terminal;
    std::string mesh = {}, picture = {};  // as of scene::TerminalLook
    std::vector<float> colour = {};
    template <class V>
    void fields(V&& v) {
        v("grammar", grammar), v("terminal", terminal), v("mesh", mesh), v("picture", picture);
        v.optional("colour", colour);
    }
};

// Plants and models that are hidden, or seen again.
struct ShowPlants {
    static constexpr const char* kName = "show_plants";
    std::vector<uint32_t> keys;
    bool shown = true;
    template <class V>
    void fields(V&& v) {
        v("keys", keys), v("shown", shown);
    }
};
struct ShowSurfaces {
    static constexpr const char* kName = "show_surfaces";
    std::vector<uint32_t> surfaces;
    bool shown = true;
    template <class V>
    void fields(V&& v) {
        v("surfaces", surfaces), v("shown", shown);
    }
};
// A surface that is locked stays where it is.
struct LockSurface {
    static constexpr const char* kName = "lock_surface";
    uint32_t surface = 0;
    bool locked = true;
    template <class V>
    void fields(V&& v) {
        v("surface", surface), v("locked", locked);
    }
};
// Houses of the town likewise.
struct ShowHouses {
    static constexpr const char* kName = "show_houses";
    std::vector<uint32_t> houses;
    bool shown = true;
    template <class V>
    void fields(V&& v) {
        v("houses", houses), v("shown", shown);
    }
};
// A house that is locked stays as it is.
struct LockHouse {
    static constexpr const char* kName = "lock_house";
    uint32_t house = 0;
    bool locked = true;
    template <class V>
    void fields(V&& v) {
        v("house", house), v("locked", locked);
    }
};
// A layer that is locked can't be painted, filled or loaded.
struct LockLayer {
    static constexpr const char* kName = "lock_layer";
    std::string layer;
    bool locked = true;
    template <class V>
    void fields(V&& v) {
        v("layer", layer), v("locked", locked);
    }
};

// Keeps a view under a digit, or none.
struct SetBookmark {
    static constexpr const char* kName = "bookmark";
    uint32_t digit = 1;  // 1 to 9
    bool kept = true;
    std::array<float, 3> eye{}, target{};
    float fov = .7f;  // radians
    template <class V>
    void fields(V&& v) {
        v("digit", digit), v("kept", kept), v("eye", eye), v("target", target), v("fov", fov);
    }
};

// How all plants walk.
struct SetWalk {
    static constexpr const char* kName = "walk";
    std::string walk = "intrinsic";  // a name that scene::walkNamed knows
    template <class V>
    void fields(V&& v) {
        v("walk", walk);
    }
};

// A stroke: its brush, dabs as often as wanted, its end; one step of undo. Other edits wait for the end.
struct StrokeBegin {
    static constexpr const char* kName = "stroke";
    std::string layer;
    std::string mode = "paint";                                      // paint, erase, smooth
    float radius = .25f, value = 1, strength = .5f, hardness = .5f;  // as of EspBrush
    std::array<float, 2> slope{0, 3.1415927f};                       // radians
    std::array<float, 2> height{-1e6f, 1e6f};                        // metres
    float softness = 0;
    bool frontOnly = false;
    std::vector<float> colour = {};  // of a layer of colours, in place of the value: red, green, blue, linear
    template <class V>
    void fields(V&& v) {
        v("layer", layer), v("mode", mode), v("radius", radius), v("value", value), v("strength", strength);
        v("hardness", hardness), v("slope", slope), v("height", height), v("softness", softness);
        v("front_only", frontOnly);
        v.optional("colour", colour);
    }
    bool operator==(const StrokeBegin&) const = default;
};
struct StrokeDabs {
    static constexpr const char* kName = "dabs";
    std::vector<std::array<float, 7>> dabs;  // position, normal, pressure
    template <class V>
    void fields(V&& v) {
        v("dabs", dabs);
    }
};
struct StrokeEnd {
    static constexpr const char* kName = "stroke_end";
    template <class V>
    void fields(V&&) {}
};
struct FillLayer {
    static constexpr const char* kName = "fill";
    std::string layer;
    float value = 0;
    std::vector<float> colour = {};  // as of StrokeBegin
    template <class V>
    void fields(V&& v) {
        v("layer", layer), v("value", value);
        v.optional("colour", colour);
    }
};
// What a file holds, if it was read already: a picture for each of scene::channelsOf; no part of a run.
using Picture = std::shared_ptr<const std::vector<scene::GreyPicture>>;
// From a picture in the surface's walk UVs.
struct LoadLayer {
    static constexpr const char* kName = "load_layer";
    std::string layer, file;
    uint32_t surface = 0;
    Picture picture = nullptr;
    template <class V>
    void fields(V&& v) {
        v("layer", layer), v("file", file), v("surface", surface);
    }
};
// From a picture of the town's site, seen from above, north up.
struct LoadTownLayer {
    static constexpr const char* kName = "load_town_layer";
    std::string layer, file;
    Picture picture = nullptr;
    template <class V>
    void fields(V&& v) {
        v("layer", layer), v("file", file);
    }
};

// Not undone, but part of a run:
struct SetCamera {
    static constexpr const char* kName = "camera";
    std::array<float, 3> eye{}, target{};
    float fov = .7f;  // radians
    template <class V>
    void fields(V&& v) {
        v("eye", eye), v("target", target), v("fov", fov);
    }
};
struct SetView {
    static constexpr const char* kName = "view";
    std::string view;   // a name that scene::viewNamed knows
    std::string layer;  // of the view "layer"
    template <class V>
    void fields(V&& v) {
        v("view", view), v("layer", layer);
    }
};
// What frame the scene's graphs show, of so many a second.
struct SetGraphTime {
    static constexpr const char* kName = "time";
    uint32_t frame = 0;
    float rate = scene::kGraphRate;
    template <class V>
    void fields(V&& v) {
        v("frame", frame), v("rate", rate);
    }
};
struct Undo {
    static constexpr const char* kName = "undo";
    template <class V>
    void fields(V&&) {}
};
struct Redo {
    static constexpr const char* kName = "redo";
    template <class V>
    void fields(V&&) {}
};

// An inverse only, never part of a run: exchanges what is painted with what the stroke keeps; its own inverse.
struct SwapStroke {
    static constexpr const char* kName = "";
    std::shared_ptr<const struct StrokeRecord> stroke;
    template <class V>
    void fields(V&&) {}
};
// Likewise: the last surface, grammar or graph of the scene goes. What was planted or painted on it has gone before.
struct DropLast {
    static constexpr const char* kName = "";
    enum class Kind { surface, grammar, graph } kind = Kind::surface;
    template <class V>
    void fields(V&&) {}
};
// Likewise: plants as they were frozen, or not.
struct RestoreFrozen {
    static constexpr const char* kName = "";
    struct Plant {
        uint32_t seed = 0;           // its key
        scene::FrozenPlant records;  // null: it grows
        std::string unread;          // see Scene::unreadPlants; empty: there is none
    };
    std::vector<Plant> plants;
    template <class V>
    void fields(V&&) {}
};
using Action =
    std::variant<SetParam, SetText, AddSeeds, RemoveSeeds, ChangeSeeds, SetLight, SetWalk, StrokeBegin, StrokeDabs,
                 StrokeEnd, FillLayer, LoadLayer, FreezeSeeds, PruneBranch, SetHouse, ResetHouse, LoadTownLayer,
                 SetField, BrushField, TrimField, AddSurface, PlaceSurface, AddGrammar, SetLook, SetBookmark,
                 ShowPlants, ShowSurfaces, LockSurface, ShowHouses, LockHouse, LockLayer, AddGraph, SetGraphText,
                 AddNodes, RemoveNodes, SetNodeInput, ConnectNodes, MoveNodes, RenameNode, ShowNodes, MuteNodes,
                 SetCamera, SetView, SetGraphTime, Undo, Redo, SwapStroke, DropLast, RestoreFrozen>;

// The layer that an action begins to change; empty: none.
std::string layerOf(const Action& action);

// One line of a run: {"frame": 3, "gesture": 2, "NAME": {fields}}; see run.hpp.
struct RunLine {
    uint32_t frame = 0;
    uint32_t gesture = 0;
    Action action;
    size_t number = 0;  // in the file that it was read from, from 1
};
std::string toJson(const RunLine& line);
// False: `error` is "line:column: message".
bool fromJson(const std::string& text, RunLine& out, std::string& error);

}  // namespace espalier::document
