#pragma once

// Reading models from files, in full: importModel of bake.hpp is the short form.

#include <optional>

#include "tools/bake/bake.hpp"

namespace espalier {

// A file that an import read, or would have read had it been there.
struct InputFile {
    std::string path;
    uint64_t hash = 0;  // of its bytes; 0: it could not be read
};

struct ImportOptions {
    int uvSet = 0;   // the TEXCOORD, 0 to 7, that the walk's charts come from (glTF)
    int scene = -1;  // which of a glTF file's scenes; -1: its default one
    // What is taken off all positions; nothing: what single precision asks for, see Model::origin.
    std::optional<glm::dvec3> origin;
    std::string as;  // the ending that tells the format; empty: the file's own
    // Of materials' names, * and ? standing for any letters and for one, small and capital alike. Nothing grows on
    // those that `bare` names, nor on transparent ones; except on those that `ground` names.
    std::vector<std::string> bare, ground;
    std::vector<InputFile>* inputs = nullptr;  // the model and what it refers to are appended, in failure too
};

// Reads glTF 2.0 (.gltf, .glb: Draco, quantisation, meshopt, sparse accessors, every triangle mode, GPU instances), OBJ
// with its materials, PLY (text or binary, also .ply.gz), STL, or what the program assimp makes glTF of. What a file
// holds tells its format, its name only where that doesn't. Takes at most 256 MiB and 256 times the files' bytes of
// memory for what it decodes. Fails naming the file and the accessor, line or byte that is wrong; throws std::bad_alloc
// where the machine has less memory than that.
Result<Model> importModel(const std::string& path, const ImportOptions& options);

}  // namespace espalier
