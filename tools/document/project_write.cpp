// What is written of a document -> a folder. What makes it safe: files of layers are named by what they hold and never
// rewritten, and project.json, which names them, is replaced in one step.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string_view>

#include "tools/document/durable.hpp"
#include "tools/document/project.hpp"
#include "tools/document/sweep.hpp"
#include "tools/document/write_lock.hpp"
#include "tools/scene/hash.hpp"
#include "tools/scene/json_checks.hpp"
#include "tools/scene/json_out.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::document {
namespace {

namespace fs = std::filesystem;
using scene::Folder;
using scene::SceneFile;
using scene::SceneLayer;

constexpr std::chrono::seconds kKeepsAfter{5}, kSavesAfter{60};  // others' writing, at most

// Each frozen plant into a file, likewise. One that couldn't be read stays what it is.
bool writePlants(const Folder& home, SceneFile& out, std::string& error) {
    for (scene::SceneGrammar& grammar : out.grammars)
        for (scene::Seed& seed : grammar.seeds) {
            if (!seed.frozen) continue;
            const std::string_view bytes(reinterpret_cast<const char*>(seed.frozen->data()), seed.frozen->size());
            const std::string name = scene::hashName(bytes.data(), bytes.size()) + ".plant";
            const Folder folder = home.in(kPlants, true, error);
            if (!folder || (!folder.holdsFile(name) && !writeTextDurably(folder, name, bytes, error))) return false;
            seed.frozenFile = folder.pathOf(name);
        }
    return true;
}

// The bake that layers lie over, for when the model is baked anew. Without it they are kept all the same.
bool writeBake(const ProjectData::Bake& bake, const Folder& home, std::string& error) {
    std::string bytes, none;
    const Folder before = home.in(kSurfaces, false, none);
    if ((before && before.holdsFile(bake.name)) || !bake.file || !bake.file->read(bytes)) return true;
    const Folder folder = home.in(kSurfaces, true, error);
    return folder && writeTextDurably(folder, bake.name, bytes, error);
}

// What fits into a file's name. A layer's is of ASCII letters, digits, _ and a channel's ending, or nothing is saved.
std::string partOfName(const std::string& layer) {
    constexpr size_t kMostBytes = 64;
    return layer.substr(0, kMostBytes);
}

// Each layer into a file, unless a file holds just that already.
bool writeLayers(ProjectData& data, const Folder& home, Progress& progress, std::string& error) {
    float written = 0;
    for (ProjectData::Layer& layer : data.layers) {
        const scene::GreyPicture picture = std::move(layer.picture);
        const bool town = layer.surface == SceneLayer::kTown;
        const std::string file = partOfName(layer.name) + "-" + (town ? "town" : std::to_string(layer.surface)) + "-" +
                                 scene::hashName(picture.texels.data(), picture.texels.size() * sizeof(float)) + ".exr";
        const Folder folder = home.in(kLayers, true, error);
        if (!folder) return false;
        const auto goOn = [&](float part) { return progress.at((written + part) / float(data.layers.size())); };
        const auto write = [&] {
            std::vector<uint8_t> bytes;
            return scene::encodeChannels(folder.pathOf(file), {&picture, 1}, bytes, error, goOn) &&
                   writeTextDurably(folder, file, scene::asText(bytes), error);
        };
        if (!goOn(0) || (!folder.holdsFile(file) && !write())) return false;
        std::string over;
        if (!town) {
            const ProjectData::Bake& bake = data.bakes[size_t(layer.surface)];
            if (!writeBake(bake, home, error)) return false;
            over = (fs::path(home.path()) / kSurfaces / bake.name).string();
        }
        data.file.layers.push_back(
            {layer.name, folder.pathOf(file), layer.surface, over, town ? data.square : std::nullopt});
        ++written;
    }
    return true;
}

// A project that names a file otherwise than the disk does couldn't be opened.
bool canName(const std::string& folder, const SceneFile& file, std::string& error) {
    std::vector<std::string> names{file.site, file.pieces, file.town ? file.town->file : ""};
    for (const scene::SceneGraph& graph : file.graphs) names.push_back(graph.file);
    for (const scene::SceneSurface& surface : file.surfaces) {
        names.push_back(surface.file);
        for (const scene::SceneField& field : surface.fields) names.push_back(field.file);
    }
    for (const scene::SceneGrammar& grammar : file.grammars) {
        names.push_back(grammar.file);
        for (const scene::TerminalLook& look : grammar.looks) names.insert(names.end(), {look.mesh, look.picture});
    }
    const fs::path from = scene::absolutePath(folder).lexically_normal();
    const auto bad = std::ranges::find_if(names, [&](const std::string& name) {
        return !name.empty() &&
               !scene::isUtf8(scene::absolutePath(name).lexically_normal().lexically_relative(from).string());
    });
    if (bad != names.end()) error = *bad + ": its name isn't UTF-8, which a project can't hold";
    return bad == names.end();
}

// What couldn't be opened again never takes the place of what can.
bool writeScene(const Folder& home, const char* name, const SceneFile& file, std::string& error) {
    const std::string path = home.pathOf(name), text = writeSceneText(path, file);
    SceneFile read;
    if (readSceneText(path, text, read, error)) return writeTextDurably(home, name, text, error);
    error = path + ": not saved, since it couldn't be opened again: " + error;
    return false;
}

// A project's own file lies in its folder: through a link a save could overwrite any file of the user's.
bool isOwn(const Folder& home, const char* name, std::string& error) {
    if (!home.holdsLink(name)) return true;
    error = home.pathOf(name) +
            ": is a link, through which nothing is saved; put the file in its place, or save the project into another "
            "folder";
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

// The folders of a path that aren't there yet, the innermost first.
std::vector<fs::path> missingFolders(const std::string& folder) {
    std::vector<fs::path> missing;
    std::error_code ignored;
    for (fs::path at = scene::absolutePath(folder).lexically_normal();
         at.has_relative_path() && !fs::exists(at, ignored); at = at.parent_path())
        if (at.has_filename()) missing.push_back(at);
    return missing;
}

bool writeInto(ProjectData data, const std::string& folder, Kept kept, Progress& progress, std::string& error) {
    const bool keeps = kept == Kept::autosave;  // which has other places, and nobody waits for
    WriteLock lock;
    if (!canName(folder, data.file, error) || !makeFolderDurably(folder, error) ||
        !lock.take(folder, keeps ? kKeepsAfter : kSavesAfter, progress, error))
        return false;
    const Folder home = Folder::at(folder, error);
    if (!home || !isOwn(home, fileOf(kept), error)) return false;
    if (keeps) data.file.follows = projectIn(folder);
    const bool good = writeLayers(data, home, progress, error) && writePlants(home, data.file, error) &&
                      progress.at(1) && writeScene(home, fileOf(kept), data.file, error);
    if (good && !keeps) home.remove(scene::kAutosaveFile);
    sweepProject(home, data.history);
    return good;
}

// What isn't complete in the end leaves no files, so that a disk that was full has room again, and no folders that were
// made for it.
bool write(ProjectData data, const std::string& folder, Kept kept, Progress& progress, std::string& error) {
    const std::vector<fs::path> made = missingFolders(folder);
    const bool good = writeInto(std::move(data), folder, kept, progress, error);
    std::error_code inUse;
    for (const fs::path& empty : made)
        if (good || !fs::remove(empty, inUse)) break;
    return good;
}

}  // namespace

bool writeProject(ProjectData data, const std::string& folder, Progress& progress, std::string& error) {
    return write(std::move(data), folder, Kept::project, progress, error);
}

bool writeAutosave(ProjectData data, const std::string& folder, Progress& progress, std::string& error) {
    return write(std::move(data), folder, Kept::autosave, progress, error);
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
    std::string none;
    Folder::at(folder, none).remove(scene::kAutosaveFile);
}

}  // namespace espalier::document
