#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/scene/scene.hpp"

namespace espalier::scene {

// In a project's folder: what was saved, and what was kept of it since.
inline constexpr const char* kProjectFile = "project.json";
inline constexpr const char* kAutosaveFile = "autosave.json";

struct SceneParam {
    ParamValue value;
    std::string place;  // "file:line:column", for messages
};

struct SceneSurface {
    std::string file;
    Placing placing;
    bool drawn = true;
    std::vector<SceneField> fields = {};
    bool hidden = false, locked = false;
};

struct SceneGrammar {
    std::string file;
    std::optional<std::string> text;   // takes the place of the file's
    std::optional<std::string> grows;  // what grows while `text` doesn't compile
    std::vector<SceneParam> params;
    std::vector<TerminalLook> looks = {};
    std::vector<Seed> seeds;
};

struct SceneGraph {
    std::string file;
    std::optional<std::string> text = {};  // takes the place of the file's, which need not be there then
    std::optional<std::string> runs = {};  // what runs while `text` doesn't compile
    bool operator==(const SceneGraph&) const = default;
};

// A scene file as it is written (docs/scene_format.md), with paths made relative to the caller's folder.
struct SceneFile {
    // 2: `filled`, layers of colours; 3: bakes that layers lie over; 4: squares that a town's layers lie over, the
    // order of seeds among grammars, and what an autosave follows; 5: looks of terminals, bookmarks, what is hidden or
    // locked, lines, texts of graphs
    static constexpr int kProjectVersion = 5;
    int project = 0;      // version of a project file; 0: a scene that was written by hand
    std::string follows;  // of an autosave: scene::hashName of the project.json that it was made beside
    std::vector<SceneSurface> surfaces;
    std::vector<SceneGrammar> grammars;
    std::optional<SceneTown> town;
    std::string site;                // file of what furnishes the scene; empty: nothing does
    std::string pieces;              // palette that patterns place meshes of; empty: the shipped one
    std::vector<SceneGraph> graphs;  // procedural graphs
    std::vector<uint64_t> pruned;    // keys of branches, ascending
    EspWalkMode walk = ESP_WALK_INTRINSIC;
    std::vector<std::pair<std::string, float>> filled;  // layers that have one value wherever nothing is painted
    std::vector<std::string> lockedLayers;
    std::vector<SceneLayer> layers;
    bool hasCamera = false;
    std::array<float, 3> eye{}, target{};
    float fov = 0;                    // degrees, 0: not said
    std::vector<Bookmark> bookmarks;  // by digit

    std::optional<std::array<float, 3>> sunDirection, sunColour, skyColour, groundColour, background, horizon;
    float sunIntensity = 1, exposure = 0;
    std::optional<std::array<float, 3>> wind;  // metres a second; none: stillness
    float gusts = 0.7f;
    float hour = kOwnSun;
    bool shadows = true;
    std::optional<float> groundLevel;  // a ground is drawn there, to the horizon
    EspGround ground = ESP_GROUND_MEADOW;
    bool groundOvergrows = true;  // a meadow's grass grows over what of models lies almost as low

    void applyLook(EspLook& look) const;
};

// The angles that scene files state in degrees: of what is placed, and of the camera.
float turnOfDegrees(float degrees);
float fovOfDegrees(float degrees);
// The degrees that one of these reads as this angle: what a division gives may be read as its neighbour, and all that
// grows would be turned by a hair. An angle that no degrees give is that of the nearest.
float degreesOf(float angle, float (*read)(float degrees));

// False: `error` holds a line "file:line:column: message" for every mistake found.
bool readSceneFile(const std::string& path, SceneFile& out, std::string& error);
// The same of a text that is to lie at `path`.
bool readSceneText(const std::string& path, const std::string& text, SceneFile& out, std::string& error);

// The text of a scene file that lies at `path`: names of files are written relative to its folder. Reading it gives
// the same SceneFile again, but for places and the file names' spelling.
std::string writeSceneText(const std::string& path, const SceneFile& file);

}  // namespace espalier::scene
