// A document -> a folder. What makes it safe: files of layers are named by what they hold and never rewritten, and
// project.json, which names them, is replaced in one step.
#include "tools/document/project.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <set>

#include "tools/document/durable.hpp"
#include "tools/document/write_lock.hpp"
#include "tools/scene/carried.hpp"
#include "tools/scene/hash.hpp"
#include "tools/scene/json_checks.hpp"
#include "tools/scene/json_out.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;
using scene::kHashDigits;
using scene::SceneFile;
using scene::SceneLayer;

constexpr const char* kLayers = "layers";
constexpr const char* kPlants = "plants";
constexpr const char* kSurfaces = "surfaces";
constexpr std::chrono::seconds kKeepsAfter{5}, kSavesAfter{60};  // others' writing, at most

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
    out.groundOvergrows = own.groundOvergrows != 0;
    out.hasCamera = true;
    out.eye = three(scene.camera.eye);
    out.target = three(scene.camera.target);
    // At its limits it may be written as a neighbour beyond them.
    out.fov = std::clamp(scene::degreesOf(scene.camera.fovY, scene::fovOfDegrees), scene::kLeastFov, scene::kMostFov);
}

// Each frozen plant into a file, likewise. One that couldn't be read stays what it is.
bool writePlants(const fs::path& folder, SceneFile& out, std::string& error) {
    for (scene::SceneGrammar& grammar : out.grammars)
        for (scene::Seed& seed : grammar.seeds) {
            if (!seed.frozen) continue;
            const std::string bytes(reinterpret_cast<const char*>(seed.frozen->data()), seed.frozen->size());
            const fs::path path = folder / kPlants / (scene::hashName(bytes.data(), bytes.size()) + ".plant");
            seed.frozenFile = path.string();
            std::error_code none;
            if (!makeFolderDurably(path.parent_path().string(), error)) return false;
            if (!fs::exists(path, none) && !writeTextDurably(path.string(), bytes, error)) return false;
        }
    return true;
}

// The bake that layers lie over, for when the model is baked anew. Without it they are kept all the same.
bool writeBake(const ProjectData::Bake& bake, const fs::path& folder, std::string& error) {
    const fs::path path = folder / kSurfaces / bake.name;
    std::error_code none;
    if (std::string bytes; !fs::exists(path, none) && bake.file && bake.file->read(bytes))
        return makeFolderDurably(path.parent_path().string(), error) && writeTextDurably(path.string(), bytes, error);
    return true;
}

// Each layer into a file, unless a file holds just that already.
bool writeLayers(ProjectData& data, const fs::path& folder, Progress& progress, std::string& error) {
    float written = 0;
    for (ProjectData::Layer& layer : data.layers) {
        const scene::GreyPicture picture = std::move(layer.picture);
        const bool town = layer.surface == SceneLayer::kTown;
        const std::string file = layer.name + "-" + (town ? "town" : std::to_string(layer.surface)) + "-" +
                                 scene::hashName(picture.texels.data(), picture.texels.size() * sizeof(float)) + ".exr";
        const fs::path path = folder / kLayers / file;
        std::error_code none;
        if (!makeFolderDurably(path.parent_path().string(), error)) return false;
        const auto goOn = [&](float part) { return progress.at((written + part) / float(data.layers.size())); };
        const auto write = [&](const std::string& beside, std::string& why) {
            return writeGrey(beside, picture, why, goOn);
        };
        if (!goOn(0) || (!fs::exists(path, none) && !writeDurably(path.string(), write, error))) return false;
        std::string over;
        if (!town) {
            const ProjectData::Bake& bake = data.bakes[size_t(layer.surface)];
            if (!writeBake(bake, folder, error)) return false;
            over = (folder / kSurfaces / bake.name).string();
        }
        data.file.layers.push_back({layer.name, path.string(), layer.surface, over, town ? data.square : std::nullopt});
        ++written;
    }
    return true;
}

// What tells a house from others when the plan has got or lost some; empty: nothing does.
std::string idOf(const EspContext* context, uint32_t house) {
    EspHouseInfo info;
    const std::string id = espHouseInfo(context, house, &info) == ESP_OK ? info.id : "";
    return scene::isUtf8(id) ? id : "";
}

// A project that names a file otherwise than the disk does couldn't be opened.
bool canName(const std::string& folder, const SceneFile& file, std::string& error) {
    std::vector<std::string> names{file.site, file.town ? file.town->file : ""};
    for (const scene::SceneSurface& surface : file.surfaces) names.push_back(surface.file);
    for (const scene::SceneGrammar& grammar : file.grammars) names.push_back(grammar.file);
    const fs::path from = scene::absolutePath(folder).lexically_normal();
    const auto bad = std::ranges::find_if(names, [&](const std::string& name) {
        return !name.empty() &&
               !scene::isUtf8(scene::absolutePath(name).lexically_normal().lexically_relative(from).string());
    });
    if (bad != names.end()) error = *bad + ": its name isn't UTF-8, which a project can't hold";
    return bad == names.end();
}

SceneFile describe(const Document& document) {
    const scene::Scene& scene = document.scene();
    SceneFile out;
    out.project = SceneFile::kProjectVersion;
    for (const scene::LoadedSurface& surface : scene.surfaces)
        out.surfaces.push_back({surface.file, surface.placing, surface.drawn});
    // Their order tells seeds of one number apart, whichever grammars they are of.
    const bool mixed = !std::ranges::is_sorted(scene.seeds, {}, &scene::Seed::grammar);
    for (size_t i = 0; i < scene.grammars.size(); ++i) {
        const scene::LoadedGrammar& grammar = scene.grammars[i];
        scene::SceneGrammar& described = out.grammars.emplace_back();
        described.file = grammar.file;
        described.text = grammar.text;
        if (grammar.text != grammar.grows) described.grows = grammar.grows;
        for (const scene::ParamValue& value : scene::changedParams(document.context(), grammar.id))
            described.params.push_back({value, {}});
        for (const scene::ParamValue& value : grammar.unset) described.params.push_back({value, {}});
        for (uint32_t place = 0; place < scene.seeds.size(); ++place) {
            if (scene.seeds[place].grammar != i) continue;
            scene::Seed& seed = described.seeds.emplace_back(scene.seeds[place]);
            const auto unread = scene.unreadPlants.find(seed.key);
            seed.frozenFile = unread != scene.unreadPlants.end() ? unread->second : "";
            seed.place = mixed ? place : 0;
        }
    }
    out.town = scene.town;
    if (out.town)
        for (scene::House& house : out.town->houses) house.id = idOf(document.context(), house.index);
    out.site = scene.site;
    out.walk = scene.grow.walk;
    out.pruned.resize(espPrunedCount(document.context()));
    for (uint32_t i = 0; i < out.pruned.size(); ++i) (void)espPrunedAt(document.context(), i, &out.pruned[i]);
    describeLook(scene, out);
    return out;
}

// NAME-SURFACE-HASH.exr, HASH.plant or HASH.glb: whoever keeps files of his own in such a folder keeps them.
bool named(const fs::path& file) {
    const std::string stem = file.stem().string(), ending = file.extension().string();
    const std::string hash = stem.substr(stem.size() < kHashDigits ? 0 : stem.size() - kHashDigits);
    return (ending == ".exr" || ending == ".plant" || ending == ".glb") && hash.size() == kHashDigits &&
           hash.find_first_not_of("0123456789abcdef") == std::string::npos;
}

// Under lock: what interrupted saves have left behind, and layers, plants and bakes that no file of the project names,
// but for `kept`.
void sweep(const fs::path& folder, const std::vector<std::string>& kept) {
    std::error_code ignored;
    std::string wanted, text, error;
    for (const std::string& file : kept) wanted += fs::path(file).filename().string() + "\n";
    for (const char* file : {scene::kProjectFile, scene::kAutosaveFile}) {
        if (!fs::exists(folder / file, ignored)) continue;
        if (!scene::readText((folder / file).string(), text, error)) return;  // who knows what it names
        wanted += text;
    }
    for (const fs::path& place : {folder, folder / kLayers, folder / kPlants, folder / kSurfaces}) {
        for (fs::directory_iterator entry(place, ignored), end; entry != end; entry.increment(ignored)) {
            const std::string name = entry->path().filename().string();
            const bool unwanted = place != folder && named(name) && wanted.find(name) == std::string::npos;
            std::error_code stays;
            if (isAbandoned(name) || unwanted) fs::remove(entry->path(), stays);
        }
        if (place != folder && fs::is_directory(fs::symlink_status(place, ignored)))
            fs::remove(place, ignored);  // if nothing is in it
    }
}

// What couldn't be opened again never takes the place of what can.
bool writeScene(const std::string& path, const SceneFile& file, std::string& error) {
    const std::string text = writeSceneText(path, file);
    SceneFile read;
    if (readSceneText(path, text, read, error)) return writeTextDurably(path, text, error);
    error = path + ": not saved, since it couldn't be opened again: " + error;
    return false;
}

// What project.json of the folder holds, as an autosave names it; empty: there is none.
std::string projectIn(const fs::path& folder) {
    std::string text, ignored;
    return scene::readText((folder / scene::kProjectFile).string(), text, ignored)
               ? scene::hashName(text.data(), text.size())
               : "";
}

enum class Kept { project, autosave };
const char* fileOf(Kept kept) {
    return kept == Kept::autosave ? scene::kAutosaveFile : scene::kProjectFile;
}

// What isn't complete in the end leaves no files: a disk that was full has room again.
bool write(ProjectData data, const std::string& folder, Kept kept, Progress& progress, std::string& error) {
    const std::string path = (fs::path(folder) / fileOf(kept)).string();
    const bool keeps = kept == Kept::autosave;  // which has other places, and nobody waits for
    WriteLock lock;
    if (!canName(folder, data.file, error) || !makeFolderDurably(folder, error) ||
        !lock.take(folder, keeps ? kKeepsAfter : kSavesAfter, progress, error))
        return false;
    if (keeps) data.file.follows = projectIn(folder);
    const bool good = writeLayers(data, folder, progress, error) && writePlants(folder, data.file, error) &&
                      progress.at(1) && writeScene(path, data.file, error);
    if (good && !keeps) dropAutosave(folder);
    sweep(folder, data.history);
    return good;
}

// Where layers are painted. A picture that couldn't be read stays what it is until something is painted in its place.
void outlineLayers(const Document& document, ProjectData& out) {
    EspContext* context = document.context();
    const scene::Scene& scene = document.scene();
    out.file.layers = scene.unread;
    std::set<std::string> names;
    const auto add = [&](const std::string& name, int surface) {
        const auto waits = [&](const SceneLayer& unread) { return unread.name == name && unread.surface == surface; };
        if (std::ranges::none_of(scene.unread, waits)) out.layers.push_back({name, surface, {}});
        names.insert(name);
    };
    for (uint32_t i = 0; i < espPaintedLayerCount(context); ++i)
        for (size_t surface = 0; surface < scene.surfaces.size(); ++surface)
            if (const char* name = espPaintedLayerName(context, i);
                espLayerPainted(context, scene.surfaces[surface].id, name))
                add(name, int(surface));
    for (uint32_t i = 0; i < espTownLayerCount(context); ++i) add(espTownLayerName(context, i), SceneLayer::kTown);
    for (const SceneLayer& unread : scene.unread) names.insert(unread.name);
    std::ranges::stable_sort(out.layers, {}, &ProjectData::Layer::name);  // not by when each was painted
    for (const std::string& name : names)
        if (float value; espLayerFilled(context, name.c_str(), &value)) out.file.filled.push_back({name, value});
}

// All but the layers' texels.
ProjectData outline(const Document& document) {
    ProjectData out;
    out.file = describe(document);
    out.history = document.filesOfHistory();
    EspContext* context = document.context();
    out.square = scene::squareOf(context);
    for (const scene::LoadedSurface& surface : document.scene().surfaces)
        out.bakes.push_back({scene::keptName(context, surface.id), surface.kept});
    outlineLayers(document, out);
    return out;
}

bool read(const Document& document, ProjectData::Layer& layer, std::string& error) {
    if (layer.surface == SceneLayer::kTown) return document.readTownLayer(layer.name, layer.picture, error);
    return document.readLayer(size_t(layer.surface), layer.name, layer.picture, error);
}

Work::Plan writing(const Document& document, const std::string& folder, Kept kept) {
    Work::Plan plan;
    const auto data = std::make_shared<ProjectData>(outline(document));
    for (ProjectData::Layer& layer : data->layers)
        plan.before.push_back([&document, &layer](std::string& error) { return read(document, layer, error); });
    plan.beside = [data, folder, kept](Progress& progress, std::string& error) {
        return write(std::move(*data), folder, kept, progress, error);
    };
    return plan;
}

}  // namespace

bool gather(const Document& document, ProjectData& out, std::string& error) {
    out = outline(document);
    return std::ranges::all_of(out.layers, [&](ProjectData::Layer& layer) { return read(document, layer, error); });
}

bool writeProject(ProjectData data, const std::string& folder, Progress& progress, std::string& error) {
    return write(std::move(data), folder, Kept::project, progress, error);
}

bool writeAutosave(ProjectData data, const std::string& folder, Progress& progress, std::string& error) {
    return write(std::move(data), folder, Kept::autosave, progress, error);
}

Work::Plan saving(const Document& document, const std::string& folder) {
    return writing(document, folder, Kept::project);
}

bool saveProject(const Document& document, const std::string& folder, std::string& error) {
    return Work(saving(document, folder)).finish(error);
}

Work::Plan autosaving(const Document& document, const std::string& folder) {
    return writing(document, folder, Kept::autosave);
}

bool autosave(const Document& document, const std::string& folder, std::string& error) {
    return Work(autosaving(document, folder)).finish(error);
}

std::string recoverable(const std::string& folder) {
    std::error_code none;
    const fs::path kept = fs::path(folder) / scene::kAutosaveFile, project = fs::path(folder) / scene::kProjectFile;
    if (!fs::exists(kept, none)) return {};
    // By what it says; files that are copied or checked out are of any time.
    scene::Json json;
    std::string ignored;
    const std::string now = projectIn(folder);
    const bool read = !now.empty() && scene::readJsonFile(kept.string(), json, ignored);
    if (const scene::Json* follows = read ? json.find("follows") : nullptr)
        return follows->text == now ? kept.string() : "";
    if (fs::exists(project, none) && fs::last_write_time(kept, none) < fs::last_write_time(project, none)) return {};
    return kept.string();
}

void dropAutosave(const std::string& folder) {
    std::error_code ignored;
    fs::remove(fs::path(folder) / scene::kAutosaveFile, ignored);
}

}  // namespace espalier::document
