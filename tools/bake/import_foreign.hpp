#pragma once

// Models of kinds for which we have no reader: the program `assimp` makes glTF of them, where it is installed (on
// Debian by the package assimp-utils). It is no part of this program: a file that crashes it costs a message.

#include "tools/bake/import_kind.hpp"

namespace espalier::import {

// Converts in a folder of its own, within a time and memory limit, and reads the result by importGltf: pictures are
// looked for beside `path`. Fails naming the kind, and what to install where the program isn't there.
Status importForeign(const std::string& path, Bytes file, const FileKind& kind, const ImportOptions& options,
                     Intake& intake, Model& model);

}  // namespace espalier::import
