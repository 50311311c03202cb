#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/scene/scene.hpp"

namespace espalier::scene {

struct SceneParam {
    std::string name;
    std::array<float, 3> value{};
    uint32_t count = 1;
    std::string place;  // "file:line:column", for messages
};

struct SceneGrammar {
    std::string file;
    std::vector<SceneParam> params;
    std::vector<Seed> seeds;
};

// A scene file as it is written (docs/scene_format.md), with paths made relative to the caller's folder.
struct SceneFile {
    std::string surface;
    std::vector<SceneGrammar> grammars;
    std::vector<std::pair<std::string, std::string>> layers;
    bool hasCamera = false;
    std::array<float, 3> eye{}, target{};
    float fov = 0;  // degrees, 0: not said

    std::optional<std::array<float, 3>> sunDirection, sunColour, skyColour, groundColour, background, horizon;
    float sunIntensity = 1, exposure = 0;

    void applyLook(EspLook& look) const;
};

// False: `error` holds a line "file:line:column: message" for every mistake found.
bool readSceneFile(const std::string& path, SceneFile& out, std::string& error);

}  // namespace espalier::scene
