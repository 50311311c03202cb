#pragma once

// Meshes and materials of parts in a glTF file.

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tools/export/export.hpp"
#include "tools/export/gltf_file.hpp"

namespace espalier::exporting {

class MeshWriter {
  public:
    MeshWriter(const Gathered& gathered, const Options& options, GltfFile& file)
        : gathered_(gathered), options_(options), file_(file) {}

    // Pictures as PNG, in textures of their numbers. False: `error` says why.
    bool addPictures(std::string& error);
    // The levels of a part in one colour, the finest first: meshes' numbers.
    std::vector<size_t> meshes(const ExportPart& part, const std::array<float, 3>& colour, const std::string& name);

  private:
    const Json& primitive(const ExportPart& part, size_t level);
    size_t material(uint32_t material, const std::array<float, 3>& colour);

    const Gathered& gathered_;
    const Options& options_;
    GltfFile& file_;
    std::map<std::pair<const ExportPart*, size_t>, Json> primitives_;  // by part and level, without materials
    std::map<std::pair<uint32_t, std::array<float, 3>>, size_t> materials_;
    std::map<uint32_t, int> coloursOf_;  // [material]
};

}  // namespace espalier::exporting
