// In: a byte that says where links lie and whether it is an autosave, and a project's text. Out: nothing, if all goes
// well; what is read is saved into a folder with these links, and nothing beside that folder changes.
#include <array>
#include <vector>

#include "tests/fuzz/promise.hpp"
#include "tools/document/project.hpp"
#include "tools/document/sweep.hpp"

namespace espalier::fuzz {
namespace {

namespace fs = std::filesystem;
using document::ProjectData;

constexpr uint8_t kAutosaves = 0x80;
constexpr std::array<const char*, 7> kNames{scene::kProjectFile, scene::kAutosaveFile, document::kLayers,
                                            document::kPlants,   document::kSurfaces,  ".writing",
                                            "other.json"};
constexpr const char* kVictim = "mask-0-0123456789abcdef.exr";

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// All that a document would have given, of a scene file alone.
ProjectData dataOf(scene::SceneFile file) {
    ProjectData data;
    std::vector<scene::SceneLayer> layers;
    std::swap(layers, file.layers);
    for (const scene::SceneLayer& layer : layers) {
        const bool known = layer.surface == scene::SceneLayer::kTown ||
                           (layer.surface >= 0 && layer.surface < int(file.surfaces.size()));
        if (known && data.layers.size() < 3) data.layers.push_back({layer.name, layer.surface, {1, 1, {.5f}}});
    }
    data.bakes.assign(file.surfaces.size(), {"0123456789abcdef.glb", nullptr});
    file.project = scene::SceneFile::kProjectVersion;
    data.file = std::move(file);
    return data;
}

}  // namespace

void project(Bytes bytes) {
    static const MemoryFolder memory;
    if (bytes.empty()) return;
    // Bits 0 to 6: what of kNames is a link; bit 7: an autosave.
    const uint8_t links = bytes[0];
    memory.clear();
    const fs::path home = memory.path / "home", outside = memory.path / "outside";
    fs::create_directory(home);
    fs::create_directory(outside);
    memory.write(std::string("outside/") + kVictim, "stays");
    for (size_t i = 0; i < kNames.size(); ++i)
        if (links >> i & 1)
            fs::create_symlink(i == 2 || i == 3 || i == 4 ? outside : outside / kVictim, home / kNames[i]);
    if (!(links & 1)) memory.write(std::string("home/") + scene::kProjectFile, textOf(bytes.subspan(1)));

    scene::SceneFile read;
    std::string error;
    const MemoryFile text(bytes.subspan(1));
    (void)document::recoverable(home.string());
    const bool good = scene::readSceneFile(text.path(), read, error);
    if (good) {
        document::Progress progress;
        ProjectData data = dataOf(std::move(read));
        const bool keeps = links & kAutosaves;
        const auto write = keeps ? document::writeAutosave : document::writeProject;
        const fs::path written = home / (keeps ? scene::kAutosaveFile : scene::kProjectFile);
        if (write(std::move(data), home.string(), progress, error))
            require(scene::readSceneFile(written.string(), read, error), "what is saved can be opened");
        else
            require(!error.empty(), "a failure has a message");
    } else {
        document::sweepProject(scene::Folder::at(home.string(), error), {});
    }
    require(contentOf(outside / kVictim) == "stays", "no link is followed");
    require(std::distance(fs::directory_iterator(outside), fs::directory_iterator()) == 1, "nothing is made elsewhere");
    require(std::distance(fs::directory_iterator(memory.path), fs::directory_iterator()) == 2, "nor beside the folder");
}

}  // namespace espalier::fuzz
