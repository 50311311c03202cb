#pragma once

// Inside of the importer: a glTF document whose bytes have been found and bounded, before anything is read from it.

#include <tiny_gltf.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier::import {

using Bytes = std::span<const uint8_t>;

// tinygltf parses the document's text; buffers, images and compressed data stay in our hands, since a hostile
// file may name ranges that do not exist.
struct Document {
    std::string path;
    tinygltf::Model gltf;                       // without buffers, images, skins, animations
    nlohmann::json images;                      // the document's "images" array, or null
    std::vector<std::vector<uint8_t>> storage;  // buffers, then decompressed views
    std::vector<Bytes> views;                   // one per bufferView: its bytes, decompressed
    std::vector<uint32_t> strides;              // one per bufferView: 0 when packed tightly
};

// Finds and bounds every buffer view of a .gltf or .glb, decompressing EXT_meshopt_compression.
Result<Document> openDocument(const std::string& path);

// The bytes of a URI relative to the document (a file or base64 data).
Result<std::vector<uint8_t>> readUri(const std::string& documentPath, const std::string& uri);

// An accessor's elements as floats, `components` each (normalised integers scaled, sparse values put in).
Result<std::vector<float>> readFloats(const Document& document, int accessor, int components, const char* what);

// An accessor of unsigned integers.
Result<std::vector<uint32_t>> readIndices(const Document& document, int accessor);

// A primitive's vertices and triangles as they are stored, in its node's space.
struct Primitive {
    std::vector<float> positions, normals;  // three a vertex; normals may be empty
    std::vector<float> uvs[2];              // two a vertex; TEXCOORD_0 and _1, may be empty
    std::vector<uint32_t> indices;          // three a triangle, all below the vertex count
};

// Reads a primitive of triangles, through Draco where it says so.
Result<Primitive> readPrimitive(const Document& document, const tinygltf::Primitive& primitive,
                                const std::string& place);

// Reads materials and the images that they use; what is missing becomes a warning.
// textureUv[i]: the affine map of material i's base colour UVs (KHR_texture_transform), texCoord its UV set.
struct MaterialUv {
    int texCoord = 0;
    glm::vec3 u{1, 0, 0}, v{0, 1, 0};
};
void readMaterials(const Document& document, std::vector<Material>& materials, std::vector<MaterialUv>& uvs,
                   std::vector<Picture>& images, std::vector<Diagnostic>& warnings);

}  // namespace espalier::import
