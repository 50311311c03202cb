#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/gpu/buffer.hpp"
#include "runtime/gpu/image.hpp"
#include "shaders/emit/emit_records.h"

namespace espalier {

// Terminal meshes on the CPU. A file names its meshes KIND[_VARIANT]_lodN: "bark_lod0", "leaf_b_lod2".
struct TerminalLod {
    uint32_t firstVertex = 0, vertexCount = 0;
    uint32_t firstIndex = 0, indexCount = 0;  // indices count from firstVertex
    float error = 0;                          // as VariantRecord::error
    float pixels = 0;  // where its longer side has so many, or fewer, it is good enough; 0: its error decides
    uint32_t material = 0;
};
struct TerminalVariant {
    std::string name;
    uint32_t kind = 0;
    std::vector<TerminalLod> lods;  // finest first
};
struct TerminalPicture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;  // rows top to bottom
};
struct TerminalMaterial {
    std::string name;
    glm::vec4 baseColor{1};
    float roughness = 1;
    float alphaCutoff = 0;  // 0: opaque
    int baseColorPicture = -1, normalPicture = -1;
};
struct TerminalData {
    std::vector<std::string> kinds;         // by TerminalRecord::mesh
    std::vector<TerminalVariant> variants;  // sorted by kind, bark first
    std::vector<TerminalVertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<TerminalMaterial> materials;
    std::vector<TerminalPicture> pictures;
};

// What growth's terminals are called by default, in the order of grammar's standardTerminalMeshes().
std::vector<std::string> standardTerminalKinds();

// Reads a glTF binary. Every size and index in it is checked; a failure names the file and the place. Kinds without
// a mesh in the file stay without variants and are not drawn. The first kind is bark; with no other, those that the
// file names are added as they come.
Result<TerminalData> readTerminals(const std::filesystem::path& path,
                                   std::vector<std::string> kinds = standardTerminalKinds());
// The same of a file's bytes. name: for errors.
Result<TerminalData> parseTerminals(std::span<const std::byte> file, const std::string& name,
                                    std::vector<std::string> kinds = standardTerminalKinds());

// How one grammar's terminals of a kind look in place of the shipped ones.
struct TerminalLook {
    uint32_t kind = 0;                 // its own, see kOwnMeshes
    std::optional<TerminalData> mesh;  // all of its variants, whatever their kinds; none: the shipped meshes
    std::optional<TerminalPicture>
        picture;                      // in place of the meshes' own; of leaves without a mesh: a card that shows it
    std::optional<glm::vec3> colour;  // linear; multiplies pictures that somebody chose, and replaces a shipped hue
};
// The shipped meshes with these looks beside them (terminal_looks.cpp).
TerminalData withLooks(const TerminalData& shipped, std::span<const TerminalLook> looks);

// Fills each LOD's error by measuring its distance to the finest one, where the file doesn't say when it is good
// enough.
void measureTerminalErrors(TerminalData& data);

// What the records say of the meshes that are on the GPU; of any number of them.
struct TerminalTable {
    std::vector<KindRecord> kinds;
    std::vector<VariantRecord> variants;
    std::vector<BucketRecord> buckets;
    uint32_t barkBuckets = 0;
};

// Who picks levels of detail: kernels, whose table has room for kMaxBuckets of them, or the CPU, for any number.
enum class TerminalChoice { kernels, cpu };

// Terminal meshes on the GPU.
class Terminals {
  public:
    static Result<Terminals> create(Device& device, TerminalData data, TerminalChoice choice = TerminalChoice::kernels);

    const TerminalData& data() const { return data_; }
    const TerminalTable& table() const { return table_; }
    // The same for kernels; empty where the CPU picks.
    const EmitTable& kernelTable() const { return kernelTable_; }
    const Buffer& tableBuffer() const { return tableBuffer_; }
    const Buffer& vertices() const { return vertices_; }
    const TexelView& vertexTexels() const { return vertexTexels_; }  // of two words
    const Buffer& indices() const { return indices_; }               // of single instances, for materialising
    const Buffer& batches() const { return batches_; }               // patterns for drawing, BucketRecord::firstIndex
    const TerminalLod& lodOfBucket(uint32_t bucket) const;
    // Textures of a material; white, or flat, where it has none.
    const Image& baseColor(uint32_t material) const;
    const Image& normalMap(uint32_t material) const;

  private:
    // For kernels each level's indices repeat, so that an instance is a batch; else the pattern is one mesh.
    Status makeTable(Device& device, TerminalChoice choice);
    void fillOwnKinds();
    Status makeKernelTable(Device& device);
    Status makePictures(Device& device);

    TerminalData data_;
    TerminalTable table_;
    EmitTable kernelTable_{};
    Buffer tableBuffer_, vertices_, indices_, batches_;
    TexelView vertexTexels_;
    std::vector<Image> colors_, normals_;  // one a picture; those unused in a role stay empty
    Image white_, flat_;
};

}  // namespace espalier
