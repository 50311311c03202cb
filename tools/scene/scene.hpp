#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plugin_api/espalier.h"

namespace espalier::scene {

// What a user asks for on a command line.
struct Request {
    std::string file;                                         // SCENE.json or SURFACE.glb
    std::vector<std::pair<std::string, std::string>> layers;  // name and picture, drawn in the model's UVs
    std::string grammar;                                      // takes the place of the scene's first grammar
    std::optional<uint32_t> seed;  // the seeds' numbers are this, this + 1 ... instead of the scene's own
};

struct LoadedGrammar {
    std::string file;
    EspGrammar id{};
};

struct Seed {
    uint32_t grammar = 0;  // index into Scene::grammars
    std::array<float, 3> position{}, direction{0, 1, 0};
    uint32_t number = 1;
};

// A scene whose surface, grammars and layers are in a context. Seeds are planted by plantAll.
struct Scene {
    std::string name;
    EspSurface surface{};
    std::vector<LoadedGrammar> grammars;
    std::vector<Seed> seeds;
    std::vector<std::string> layers;
    EspCamera camera{};
    EspLook look{};
};

// Reads the file (docs/scene_format.md) or the bare surface, for which the default ivy is taken, fitted to the
// model's size, with seeds around its foot and a camera that shows everything. False: `error` tells file, place
// and cause, and the context may hold parts of the scene.
bool openScene(EspContext* context, const Request& request, Scene& out, std::string& error);

// Takes away all seeds and plants the scene's.
bool plantAll(EspContext* context, const Scene& scene, std::string& error);

// Compiles the grammar's file anew; on failure the old one keeps growing.
bool recompile(EspContext* context, const LoadedGrammar& grammar, std::string& error);

// The folder with the content that is installed beside the running program.
std::string contentFolder();

// The camera turned about its target and the vertical.
EspCamera turned(const EspCamera& camera, float radians);

}  // namespace espalier::scene
