// A document -> a folder. What makes it safe: files of layers are named by what they hold and never rewritten, and
// project.json, which names them, is replaced in one step.
#include "tools/document/project.hpp"

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "tools/document/durable.hpp"
#include "tools/scene/picture.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;
using scene::SceneFile;

constexpr const char* kProject = "project.json";
constexpr const char* kAutosave = "autosave.json";
constexpr const char* kLayers = "layers";
constexpr const char* kPlants = "plants";
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
    if (own.ground) out.groundLevel = own.groundLevel;
    out.hasCamera = true;
    out.eye = three(scene.camera.eye);
    out.target = three(scene.camera.target);
    out.fov = scene.camera.fovY * kDegrees;
}

// A name for what these bytes are.
std::string hashOf(const void* data, size_t size) {
    uint64_t hash = 1469598103934665603ull ^ size;
    const char* bytes = static_cast<const char*>(data);
    for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
        uint32_t bits = 0;
        std::memcpy(&bits, bytes + i, std::min(size - i, sizeof bits));
        hash = (hash ^ bits) * 1099511628211ull;
        hash ^= hash >> 29;
    }
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

// Each frozen plant into a file, likewise.
bool writePlants(const fs::path& folder, SceneFile& out, std::string& error) {
    for (scene::SceneGrammar& grammar : out.grammars)
        for (scene::Seed& seed : grammar.seeds) {
            seed.frozenFile.clear();
            if (!seed.frozen) continue;
            const std::string bytes(reinterpret_cast<const char*>(seed.frozen->data()), seed.frozen->size());
            const fs::path path = folder / kPlants / (hashOf(bytes.data(), bytes.size()) + ".plant");
            seed.frozenFile = path.string();
            std::error_code code;
            fs::create_directories(path.parent_path(), code);
            if (!fs::exists(path, code) && !writeTextDurably(path.string(), bytes, error)) return false;
        }
    return true;
}

// Each layer into a file, unless a file holds just that already.
bool writeLayers(const ProjectData& data, const fs::path& folder, SceneFile& out, std::string& error) {
    for (const ProjectData::Layer& layer : data.layers) {
        const bool town = layer.surface == scene::SceneLayer::kTown;
        const std::string file = layer.name + "-" + (town ? "town" : std::to_string(layer.surface)) + "-" +
                                 hashOf(layer.picture.texels.data(), layer.picture.texels.size() * sizeof(float)) +
                                 ".exr";
        const fs::path path = folder / kLayers / file;
        std::error_code code;
        fs::create_directories(path.parent_path(), code);
        const auto write = [&](const std::string& beside, std::string& why) {
            return writeGrey(beside, layer.picture, why);
        };
        if (!fs::exists(path, code) && !writeDurably(path.string(), write, error)) return false;
        out.layers.push_back({layer.name, path.string(), layer.surface});
    }
    return true;
}

SceneFile describe(const Document& document) {
    const scene::Scene& scene = document.scene();
    SceneFile out;
    out.project = SceneFile::kProjectVersion;
    for (const scene::LoadedSurface& surface : scene.surfaces)
        out.surfaces.push_back({surface.file, surface.placing, surface.drawn});
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
    out.town = scene.town;
    out.site = scene.site;
    out.pruned.resize(espPrunedCount(document.context()));
    for (uint32_t i = 0; i < out.pruned.size(); ++i) (void)espPrunedAt(document.context(), i, &out.pruned[i]);
    describeLook(scene, out);
    return out;
}

bool makeFolder(const std::string& folder, std::string& error) {
    std::error_code code;
    fs::create_directories(folder, code);
    if (code) error = folder + ": can't be made: " + code.message();
    return !code;
}

// What interrupted saves have left behind, and layers that no file of the project names.
void sweep(const fs::path& folder) {
    std::error_code ignored;
    std::string named, text, error;
    for (const char* file : {kProject, kAutosave})
        if (scene::readText((folder / file).string(), text, error)) named += text;
    for (const fs::path& place : {folder, folder / kLayers, folder / kPlants})
        for (const auto& entry : fs::directory_iterator(place, ignored)) {
            const std::string name = entry.path().filename().string();
            const bool unnamed = place != folder && named.find(name) == std::string::npos;
            if (name.rfind(kUnfinished, 0) == 0 || unnamed) fs::remove(entry.path(), ignored);
        }
}

bool write(const ProjectData& data, const std::string& folder, const char* name, std::string& error) {
    const std::string path = (fs::path(folder) / name).string();
    SceneFile file = data.file;
    return makeFolder(folder, error) && writeLayers(data, folder, file, error) && writePlants(folder, file, error) &&
           writeTextDurably(path, writeSceneText(path, file), error);
}

}  // namespace

bool gather(const Document& document, ProjectData& out, std::string& error) {
    out = {describe(document), {}};
    EspContext* context = document.context();
    for (uint32_t i = 0; i < espPaintedLayerCount(context); ++i) {
        const std::string name = espPaintedLayerName(context, i);
        for (size_t surface = 0; surface < document.scene().surfaces.size(); ++surface) {
            ProjectData::Layer& layer = out.layers.emplace_back();
            layer.name = name;
            layer.surface = int(surface);
            if (!document.readLayer(surface, name, layer.picture, error)) return false;
        }
    }
    for (uint32_t i = 0; i < espTownLayerCount(context); ++i) {
        const std::string name = espTownLayerName(context, i);
        ProjectData::Layer& layer = out.layers.emplace_back();
        layer.name = name;
        layer.surface = scene::SceneLayer::kTown;
        if (!document.readTownLayer(name, layer.picture, error)) return false;
    }
    return true;
}

bool writeProject(const ProjectData& data, const std::string& folder, std::string& error) {
    if (!write(data, folder, kProject, error)) return false;
    dropAutosave(folder);
    sweep(folder);
    return true;
}

bool saveProject(const Document& document, const std::string& folder, std::string& error) {
    ProjectData data;
    return gather(document, data, error) && writeProject(data, folder, error);
}

bool autosave(const Document& document, const std::string& folder, std::string& error) {
    ProjectData data;
    return gather(document, data, error) && write(data, folder, kAutosave, error);
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
