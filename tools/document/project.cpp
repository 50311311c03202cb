// A document -> a folder. What makes it safe: files of layers are named by what they hold and never rewritten, and
// project.json, which names them, is replaced in one step.
#include "tools/document/project.hpp"

#include <filesystem>

#include "tools/document/durable.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/scene_file.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;
using scene::SceneFile;

constexpr const char* kProject = "project.json";
constexpr const char* kAutosave = "autosave.json";
constexpr float kDegrees = 180 / 3.14159265f;

std::array<float, 3> three(const float* v) {
    return {v[0], v[1], v[2]};
}

void describeLook(const scene::Scene& scene, SceneFile& out) {
    const EspLook& own = scene.ownLook;
    out.sunDirection = three(own.sunDirection);
    out.sunColour = three(own.sunColour);
    out.skyColour = three(own.skyColour);
    out.groundColour = three(own.groundColour);
    out.background = three(own.background);
    out.horizon = three(own.horizon);
    out.hour = scene.hour;
    out.exposure = scene.look.exposure;
    out.shadows = scene.look.shadows != 0;
    out.hasCamera = true;
    out.eye = three(scene.camera.eye);
    out.target = three(scene.camera.target);
    out.fov = scene.camera.fovY * kDegrees;
}

SceneFile describe(const Document& document) {
    const scene::Scene& scene = document.scene();
    SceneFile out;
    out.project = SceneFile::kProjectVersion;
    for (const scene::LoadedSurface& surface : scene.surfaces) out.surfaces.push_back({surface.file, surface.placing});
    for (size_t i = 0; i < scene.grammars.size(); ++i) {
        const scene::LoadedGrammar& grammar = scene.grammars[i];
        scene::SceneGrammar& described = out.grammars.emplace_back();
        described.file = grammar.file;
        described.text = grammar.text;
        if (grammar.text != grammar.grows) described.grows = grammar.grows;
        for (const scene::ParamValue& value : scene::changedParams(document.context(), grammar.id))
            described.params.push_back({value, {}});
        for (const scene::Seed& seed : scene.seeds)
            if (seed.grammar == i) described.seeds.push_back(seed);
    }
    describeLook(scene, out);
    return out;
}

bool makeFolder(const std::string& folder, std::string& error) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) error = folder + ": can't be made: " + code.message();
    return !code;
}

// What interrupted saves have left behind.
void sweep(const fs::path& folder) {
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().filename().string().rfind(kUnfinished, 0) == 0) fs::remove(entry.path(), ignored);
}

bool save(const Document& document, const std::string& folder, const char* name, std::string& error) {
    const std::string path = (fs::path(folder) / name).string();
    return makeFolder(folder, error) && writeTextDurably(path, writeSceneText(path, describe(document)), error);
}

}  // namespace

bool saveProject(const Document& document, const std::string& folder, std::string& error) {
    if (!save(document, folder, kProject, error)) return false;
    dropAutosave(folder);
    sweep(folder);
    return true;
}

bool autosave(const Document& document, const std::string& folder, std::string& error) {
    return save(document, folder, kAutosave, error);
}

std::string recoverable(const std::string& folder) {
    std::error_code none;
    const fs::path kept = fs::path(folder) / kAutosave, project = fs::path(folder) / kProject;
    if (!fs::exists(kept, none)) return {};
    if (fs::exists(project, none) && fs::last_write_time(kept, none) < fs::last_write_time(project, none)) return {};
    return kept.string();
}

void dropAutosave(const std::string& folder) {
    std::error_code ignored;
    fs::remove(fs::path(folder) / kAutosave, ignored);
}

}  // namespace espalier::document
