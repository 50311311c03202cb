// In: a path. Out: the model in it, whichever of the formats it is.
#include <filesystem>

#include "tools/bake/import.hpp"

namespace espalier {
namespace {

using namespace import;

bool startsWith(Bytes file, std::string_view text) {
    return file.size() >= text.size() && std::equal(text.begin(), text.end(), file.begin());
}

// The ending in small letters, without that of the compression.
std::string endingOf(std::filesystem::path path) {
    auto small = [](std::string text) {
        for (char& c : text) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
        return text;
    };
    if (small(path.extension().string()) == ".gz") path = path.stem();
    return small(path.extension().string());
}

Status importAny(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model) {
    std::string ending = options.as.empty() ? endingOf(path) : options.as;
    if (startsWith(file, "ply\n") || startsWith(file, "ply\r")) return importPly(path, file, model);
    if (startsWith(file, "glTF") || ending == ".gltf" || ending == ".glb")
        return importGltf(path, file, options, intake, model);
    if (ending == ".ply") return Failure(path, "not PLY: the file does not begin with 'ply'");
    if (ending == ".obj") return importObj(path, file, intake, model);
    size_t first = 0;
    while (first < file.size() && (file[first] == ' ' || (file[first] >= 9 && file[first] <= 13))) ++first;
    if (startsWith(file.subspan(first), "{")) return importGltf(path, file, options, intake, model);
    return Failure(path, "neither glTF (.gltf, .glb) nor OBJ nor PLY");
}

}  // namespace

Result<Model> importModel(const std::string& path, int uvSet) {
    ImportOptions options;
    options.uvSet = uvSet;
    return importModel(path, options);
}

Result<Model> importModel(const std::string& path, const ImportOptions& options) {
    Intake intake(options.inputs);
    auto file = intake.read(path, path);
    if (!file) return std::move(file.failure());
    Model model;
    model.name = path;
    Status done = importAny(path, *file, options, intake, model);
    if (!done) return std::move(done.failure());
    decideBare(options, model);
    return model;
}

}  // namespace espalier
