// In: a path. Out: the model in it, whichever of the formats it is.
#include <filesystem>

#include "tools/bake/import.hpp"
#include "tools/bake/import_foreign.hpp"
#include "tools/bake/import_kind.hpp"
#include "tools/bake/import_text.hpp"

namespace espalier {
namespace {

using namespace import;

bool startsWith(Bytes file, std::string_view text) {
    return file.size() >= text.size() && std::equal(text.begin(), text.end(), file.begin());
}

// The ending in small letters, without that of the compression.
std::string endingOf(std::filesystem::path path) {
    if (smallLetters(path.extension().string()) == ".gz") path = path.stem();
    return smallLetters(path.extension().string());
}

// Some editors put a byte order mark in front of any text.
Bytes withoutMark(Bytes file) {
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    return file.last(withoutByteOrderMark(text).size());
}

bool isPly(Bytes file) {
    return startsWith(file, "ply\n") || startsWith(file, "ply\r");
}

Status importAs(const std::string& ending, const std::string& path, Bytes file, const ImportOptions& options,
                Intake& intake, Model& model) {
    if (ending == ".gltf" || ending == ".glb") return importGltf(path, file, options, intake, model);
    if (ending == ".obj") return importObj(path, file, options, intake, model);
    if (ending == ".stl") return importStl(path, file, options, model);
    if (ending != ".ply") return Failure(path, "neither glTF (.gltf, .glb) nor OBJ, PLY or STL");
    if (!isPly(file)) return Failure(path, "not PLY: the file does not begin with 'ply'");
    return importPly(path, file, options, intake, model);
}

// What a file holds tells its format, and its name only where that doesn't.
Status importAny(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model) {
    if (!options.as.empty()) return importAs(options.as, path, file, options, intake, model);
    const auto as = [&](const std::string& ending) { return importAs(ending, path, file, options, intake, model); };
    if (const Bytes text = withoutMark(file); isPly(text)) return importAs(".ply", path, text, options, intake, model);
    if (const FileKind* kind = kindOf(file)) {
        if (kind->reader == ReadBy::stl) return as(".stl");
        if (kind->reader == ReadBy::assimp) return importForeign(path, file, *kind, options, intake, model);
        return Failure(path, std::string("the file is ") + kind->name + ": " + kind->advice);
    }
    if (startsWith(file, "glTF")) return as(".glb");
    size_t first = 0;
    while (first < file.size() && (file[first] == ' ' || (file[first] >= 9 && file[first] <= 13))) ++first;
    if (startsWith(file.subspan(first), "{")) return as(".gltf");
    return as(looksLikeObj(file) ? ".obj" : endingOf(path));
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
