#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tools/scene/fields.hpp"
#include "tools/scene/kept_file.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/town.hpp"

namespace espalier::scene {

// What a user asks for on a command line.
struct Request {
    std::string file;                                         // SCENE.json or SURFACE.glb
    std::vector<std::pair<std::string, std::string>> layers;  // name and picture, drawn in the model's UVs
    std::string grammar;                                      // takes the place of the scene's first grammar
    std::optional<uint32_t> seed;  // the seeds' numbers are this, this + 1 ... instead of the scene's own
    uint32_t times = 1;  // that each seed is planted, with other numbers: to see how it goes with more of them
    EspGrowDef grow = esp::defaults<EspGrowDef>();  // but for `walk`, which the scene's file says
    std::optional<EspWalkMode> walk;                // instead of that
    // Told before each part of a scene that may take long: what it is, and the share of all that is done, 0 to 1.
    std::function<void(const std::string& part, float share)> told = {};
};

// How a surface stands in the scene: scaled evenly, turned about the vertical, moved.
struct Placing {
    std::array<float, 3> position{};
    float turn = 0;  // radians, counterclockwise from above
    float scale = 1;
    bool mirror = false;  // left becomes right, before it is turned; no town's
    EspTransform transform() const;
    bool operator==(const Placing&) const = default;
};

// Where a point or, without its position, a direction goes when what it belongs to is moved.
std::array<float, 3> carried(const std::array<float, 3>& v, const Placing& from, const Placing& to, bool isPoint);

struct LoadedSurface {
    std::string file;
    Placing placing;
    bool drawn = true;                    // false: it is ground only, and something else draws it
    bool hidden = false, locked = false;  // in the editor: not seen; stays where it is
    EspSurface id{};
    std::shared_ptr<const KeptFile> kept = {};  // as it was loaded; null: it couldn't be kept
    std::vector<SceneField> fields = {};
};

// A house that is hidden or locked in the editor: not seen; stays as it is.
struct HouseMark {
    uint32_t index = 0;
    std::string id = {};  // that a project knows it by, as House::id
    bool hidden = false, locked = false;
    bool operator==(const HouseMark&) const = default;
};

// A town of the scene.
struct SceneTown {
    std::string file;
    int grammar = -1;  // index into Scene::grammars; -1: the first that makes roofs
    Placing placing;   // of scale 1
    bool ground = true;
    std::optional<std::array<float, 3>> groundColour;
    std::vector<House> houses = {};     // that aren't as the file says, by index
    std::vector<HouseMark> marks = {};  // by index
    HouseMark mark(uint32_t house) const;
    void setMark(const HouseMark& mark);  // one that says nothing goes
    bool operator==(const SceneTown&) const = default;
};

struct ParamValue {
    std::string name;
    std::array<float, 3> value{};
    uint32_t count = 1;  // 3: a colour
    bool operator==(const ParamValue&) const = default;
};

// How one kind of terminal of a grammar looks, such as its leaves, in place of the shipped meshes.
struct TerminalLook {
    std::string terminal;       // "leaf", "bark" ...: a name that espTerminalName gives
    std::string mesh, picture;  // files; empty: as shipped
    std::vector<float> colour;  // linear, three; empty: as shipped
    bool plain() const { return mesh.empty() && picture.empty() && colour.empty(); }
    bool operator==(const TerminalLook&) const = default;
};

struct LoadedGrammar {
    std::string file;                      // where it came from; what it includes lies beside it
    std::string text;                      // as it stands in the editor; it may have mistakes
    std::string grows;                     // the text that was compiled last and grows
    std::string error;                     // of `text`; empty: it grows
    std::string warnings;                  // of `text` while it grows, a line each
    std::vector<ParamValue> unset;         // while `text` has mistakes: values of parameters that only it may have
    std::vector<TerminalLook> looks = {};  // by terminal, none plain; of a project, also those whose files are lost
    EspGrammar id{};
};

// A procedural graph.
struct LoadedGraph {
    std::string file;   // where it came from, or is to be written to; what it reads lies beside it
    std::string text;   // as it stands in the editor; it may have mistakes
    std::string runs;   // the text that was compiled last, and runs
    std::string error;  // of `text`; empty: it runs
    EspGraph id{};
};

// A plant that stands as it is, as espReadFrozen gave it.
using FrozenPlant = std::shared_ptr<const std::vector<std::byte>>;

struct Seed {
    uint32_t key = 0;      // tells the seeds of an opened scene apart, from 1
    uint32_t grammar = 0;  // index into Scene::grammars
    std::array<float, 3> position{}, direction{0, 1, 0};
    uint32_t number = 1;
    std::vector<ParamValue> params;  // in place of its grammar's
    FrozenPlant frozen = {};         // null: it grows
    std::string frozenFile;          // where a scene file keeps that
    bool hidden = false;             // nothing grows from it until it is shown
    // The line that its plant was led along, point by point: position and normal, world. Its directions are painted.
    std::vector<std::array<float, 6>> line = {};
    uint32_t place = 0;  // in a scene file: among the seeds of all its grammars
    EspSeed planted{};
};

// A picture for a layer: drawn in the model's UVs and laid on every surface, or in the walk's UVs of one of them.
struct SceneLayer {
    std::string name, file;
    static constexpr int kTown = -2;
    int surface = -1;  // index into SceneFile::surfaces; -1: all, in the model's UVs; kTown: seen from above, north up
    std::string over = {};  // of a surface: the bake that it was painted over, named by its hash; empty: isn't known
    std::optional<TownSquare> square = {};  // of the town: what it was painted over; none: what the layers lie over now
};

constexpr float kMostExposure = 20;             // stops, up or down
constexpr float kLeastFov = 1, kMostFov = 170;  // degrees
constexpr float kGraphRate = 30, kMostGraphRate = 1000;
constexpr uint32_t kMostGraphFrame = 16777216;
constexpr float kOwnSun = -1;  // no hour: the scene's own light

// A view that is kept under a digit.
struct Bookmark {
    uint32_t digit = 1;  // 1 to 9
    std::array<float, 3> eye{}, target{};
    float fov = .7f;  // radians
    bool operator==(const Bookmark&) const = default;
};
constexpr uint32_t kMostBookmarks = 9;

// A scene whose surfaces, grammars and layers are in a context. Seeds are planted by plantAll.
struct Scene {
    std::string name;
    bool project = false;  // its file is a project's, or an autosave
    std::vector<LoadedSurface> surfaces;
    std::vector<LoadedGrammar> grammars;
    std::vector<Seed> seeds;
    std::optional<SceneTown> town;
    struct PlannedRoof {
        std::string shape;
        float slope = 0;
        float eaveHeight = 0;
    };
    std::vector<PlannedRoof> plannedRoofs;  // [house] as the town's file says
    std::string site;                       // file of what furnishes it; empty: nothing does
    std::string pieces;                     // palette of patterns; empty: the shipped one
    std::vector<LoadedGraph> graphs;
    uint32_t graphFrame = 0;       // that the graphs show
    float graphRate = kGraphRate;  // frames a second of their time
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    std::vector<std::string> layers;  // that grammars read; then those that are painted and that none reads any more
    std::vector<std::string> colourLayers;  // those of them that are colours (tools/scene/layers.hpp)
    std::vector<std::string> lockedLayers;  // by name: they can't be painted
    std::vector<std::string> notes;         // what of the file couldn't be kept, a line each
    std::vector<SceneLayer> unread;         // of a project: pictures that couldn't be read, and are kept as they are
    std::map<uint32_t, std::string> unreadPlants;  // likewise files of frozen plants, by seeds' keys; they grow
    EspCamera camera{};
    std::vector<Bookmark> bookmarks;  // by digit
    EspLook ownLook{};                // as the file says
    EspLook look{};                   // that, with the light of the hour
    float hour = kOwnSun;             // of the day, 0 to 24; what the light is made from unless it is kOwnSun
    std::string viewLayer;            // of look.view ESP_VIEW_LAYER; look.viewLayer is left alone
};

// Reads the scene or project (docs/scene_format.md; of a project also its folder) or the bare surface, for which the
// default ivy is taken, fitted to the model's size, with seeds around its foot and a camera that shows everything.
// False: `error` tells file, place and cause, and the context may hold parts of the scene.
bool openScene(EspContext* context, const Request& request, Scene& out, std::string& error);
// Its file's or folder's name, also of one that a shell has completed with a slash.
std::string lastPart(const std::string& file);
// Whether it is worth trying: false, with why, of what is plainly none of these. Reads the file itself, not what it
// names.
bool mayOpen(const std::string& file, std::string& error);

// What to set of a picture that is drawn in a surface's walk UVs: as espReadLayer gave it, or resampled if it is of
// another size. `out` refers to name and picture.
EspResult walkLayer(EspContext* context, EspSurface surface, const std::string& name, const GreyPicture& picture,
                    EspLayerDef& out);

// Takes away all seeds and plants the scene's. False: `error` tells how many couldn't be, and of the first its place
// and why; their Seed::planted is zero, the others grow.
bool plantAll(EspContext* context, Scene& scene, std::string& error);

// Gives the grammar another text. False: it has mistakes, told in grammar.error, and the last good one keeps growing.
bool setText(EspContext* context, LoadedGrammar& grammar, const std::string& text);

// False: `error` says why, and it looks as before.
bool setLook(EspContext* context, EspGrammar grammar, const TerminalLook& look, std::string& error);
// The list with this look in place of the terminal's own; a plain one goes.
void putLook(std::vector<TerminalLook>& looks, const TerminalLook& look);

// Of a scene with a town, what that grows by: the grammar that it names, or the first that makes roofs. False: none
// does.
bool setTownGrammar(EspContext* context, const Scene& scene, std::string& error);

// Values of a grammar's parameters that suit a model of that size (`scale`, `reach`), instead of a wall of some metres:
// what is smaller is a model of something large. side: the largest of its extents; metres.
std::vector<ParamValue> fittingParams(const EspContext* context, EspGrammar grammar, float side, float height);

// Of a model's largest side: as it is, or as what is far too small or large is shown, so that ivy on it is ivy.
float livingScale(float side);

// Values that aren't the grammar's own.
std::vector<ParamValue> changedParams(const EspContext* context, EspGrammar grammar);

// The folder with the content that is installed beside the running program.
std::string contentFolder();

// shaded, charts, normals, lod, layer. False: there is no such view.
bool viewNamed(const std::string& name, EspView& out);
const char* nameOf(EspView view);
// intrinsic, paper. False: there is no such walk.
bool groundNamed(const std::string& name, EspGround& out);
const char* nameOf(EspGround ground);
bool walkNamed(const std::string& name, EspWalkMode& out);
const char* nameOf(EspWalkMode walk);

// Sets the frame that the scene's graphs show, of so many a second. Takes effect with the next espUpdate.
bool setGraphTime(EspContext* context, Scene& scene, uint32_t frame, float rate, std::string& error);
// A graph that comes to the scene: its file and text are set. Nodes that wait for wires are no mistakes.
bool compileGraph(EspContext* context, const Scene& scene, LoadedGraph& graph, std::string& error);
// Gives the graph another text. False: it has mistakes, told in graph.error, and the last good one goes on running.
bool setText(EspContext* context, LoadedGraph& graph, const std::string& text);

// The camera turned about its target and the vertical.
EspCamera turned(const EspCamera& camera, float radians);

}  // namespace espalier::scene
