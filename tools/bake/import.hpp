#pragma once

// Inside of the importer: what the three formats share, and a glTF document whose bytes have been found and bounded
// before anything is read from it.

#include <tiny_gltf.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"
#include "tools/bake/import_model.hpp"

namespace espalier::import {

using Bytes = std::span<const uint8_t>;

// What one import has read, and what it may still allocate: a small file that states great sizes is refused before
// they are believed.
class Intake {
  public:
    explicit Intake(std::vector<InputFile>* inputs) : inputs_(inputs) {}

    // A file's bytes, unpacked where they are gzip. A failure blames `blame`, the file that refers to this one.
    Result<std::vector<uint8_t>> read(const std::string& path, const std::string& blame);
    // A file that a document refers to, by the rule of placeBeside (runtime/core/file_beside.hpp).
    Result<std::vector<uint8_t>> readBeside(const std::string& document, const std::string& name);
    // Whether there is such a file.
    bool isBeside(const std::string& document, const std::string& name);

    // Counts a file among those that the import depends on, without reading it for the model.
    void note(const std::string& path);

    // False: so many bytes more are beyond what files of this size can reasonably hold.
    bool take(uint64_t bytes);
    uint64_t left() const { return allowed_ - taken_; }

  private:
    std::vector<InputFile>* inputs_;
    std::vector<std::string> known_;
    uint64_t allowed_ = uint64_t(256) << 20, taken_ = 0;
};

// Each fails naming the file and the line, element or offset concerned.
Status importGltf(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model);
Status importObj(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model);
Status importPly(const std::string& path, Bytes file, const ImportOptions& options, Intake& intake, Model& model);
Status importStl(const std::string& path, Bytes file, const ImportOptions& options, Model& model);

// Decodes a PNG or JPEG within what the intake allows; `encoded` keeps the bytes.
Result<Picture> readPicture(std::vector<uint8_t> bytes, const std::string& file, Intake& intake);

// Sets the model's positions and its origin, by which they are less than `places`: the one that is wanted, else one
// where float32 would lose what matters. used: the vertices that triangles name; others needn't be numbers.
void settle(const std::vector<glm::dvec3>& places, std::span<const uint32_t> used,
            const std::optional<glm::dvec3>& wanted, Model& model);

// Decides which materials are bare: those that readers have marked, being transparent, and by the options' names.
void decideBare(const ImportOptions& options, Model& model);

constexpr size_t kMaxVertices = size_t(1) << 26;

// tinygltf parses the document's text; buffers, images and compressed data stay in our hands, since a hostile
// file may name ranges that do not exist.
struct Document {
    std::string path;
    Intake* intake = nullptr;
    tinygltf::Model gltf;                       // without buffers, images, skins, animations
    nlohmann::json images;                      // the document's "images" array, or null
    std::vector<std::vector<uint8_t>> storage;  // buffers, then decompressed views
    std::vector<Bytes> views;                   // one per bufferView: its bytes, decompressed
    std::vector<uint32_t> strides;              // one per bufferView: 0 when packed tightly
};

// Finds and bounds every buffer view of a .gltf or .glb, decompressing EXT_meshopt_compression.
Result<Document> openDocument(const std::string& path, Bytes file, Intake& intake);

// The bytes of a URI relative to the document (a file or base64 data).
Result<std::vector<uint8_t>> readUri(const Document& document, const std::string& uri);

// An accessor's elements as floats, `components` each (normalised integers scaled, sparse values put in).
Result<std::vector<float>> readFloats(const Document& document, int accessor, int components, const char* what);

// An accessor of unsigned integers.
Result<std::vector<uint32_t>> readIndices(const Document& document, int accessor);

// A primitive's vertices and triangles as they are stored, in its node's space.
struct Primitive {
    std::vector<float> positions, normals;  // three a vertex; normals may be empty
    std::vector<float> walkUvs, drawnUvs;   // two a vertex, of the sets asked for; may be empty
    std::vector<float> colours;             // three or four a vertex (COLOR_0); may be empty
    std::vector<uint32_t> indices;          // three a triangle, all below the vertex count
};

// Reads a primitive of triangles, through Draco where it says so, with two of its UV sets (TEXCOORD_n).
struct UvSets {
    int walk = 0, drawn = 0;
    int colour = 0;  // how many components COLOR_0 has; 0: it isn't read
};
int colourComponents(const Document& document, const tinygltf::Primitive& primitive);
Result<Primitive> readPrimitive(const Document& document, const tinygltf::Primitive& primitive, UvSets sets,
                                const std::string& place);

// Reads materials, their names and the images that they use; what is missing becomes a warning.
// uvs[i]: the affine map of material i's base colour UVs (KHR_texture_transform), texCoord its UV set.
struct MaterialUv {
    int texCoord = 0;
    glm::vec3 u{1, 0, 0}, v{0, 1, 0};
};
void readMaterials(const Document& document, Model& model, std::vector<MaterialUv>& uvs);

}  // namespace espalier::import
