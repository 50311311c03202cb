#pragma once

// Inside of the importer: a glTF document whose bytes have been found and bounded before anything is read from it, and
// the steps that read it.

#include <tiny_gltf.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/bake/import.hpp"

namespace espalier::import {

// tinygltf parses the document's text; buffers, images and compressed data stay in our hands, since a hostile
// file may name ranges that do not exist.
struct Document {
    std::string path;
    Intake* intake = nullptr;
    tinygltf::Model gltf;                       // without buffers, images, animations; indices: see indicesOf()
    nlohmann::json images;                      // the document's "images" array, or null
    std::vector<std::vector<uint8_t>> storage;  // buffers, then decompressed views
    std::vector<Bytes> views;                   // one per bufferView: its bytes, decompressed
    std::vector<uint32_t> strides;              // one per bufferView: 0 when packed tightly
    std::vector<std::string> remarks;           // to become the model's warnings
};

// Finds and bounds every buffer view of a .gltf or .glb, decompressing EXT_meshopt_compression.
Result<Document> openDocument(const std::string& path, Bytes file, Intake& intake);

// Fails where a required extension that isn't read may change the model's shape. Remarks tell of others.
Status judgeExtensions(const nlohmann::json& root, Document& document);

// The bytes of a URI relative to the document (a file or base64 data).
Result<std::vector<uint8_t>> readUri(const Document& document, const std::string& uri);

// An accessor's elements as floats, `components` each (normalised integers scaled, sparse values put in). An accessor
// without elements gives none.
Result<std::vector<float>> readFloats(const Document& document, int accessor, int components, const char* what);

// An accessor of unsigned integers, sparse values put in.
Result<std::vector<uint32_t>> readIndices(const Document& document, int accessor);

// Whether a component type holds integers, and the value that stands for 1 where an accessor calls them normalised.
bool isInteger(int componentType);
double normalizedOne(int componentType);

// The bytes of a buffer view from `offset` on; place: who asks, for the message.
Result<Bytes> viewBytes(const Document& document, int view, size_t offset, size_t length, const std::string& place);

constexpr size_t kJointSets = 2;  // JOINTS_0 and JOINTS_1: eight influences a vertex

// A primitive's vertices and triangles as they are stored, in its node's space.
struct Primitive {
    std::vector<float> positions, normals;                       // three a vertex; normals may be empty
    std::vector<float> walkUvs, drawnUvs, otherUvs;              // two a vertex, of the sets asked for; may be empty
    std::vector<float> colours;                                  // three or four a vertex (COLOR_0); may be empty
    std::array<std::vector<float>, kJointSets> joints, weights;  // four a vertex, of a skin; may be empty
    std::vector<uint32_t> indices;                               // three a triangle, all below the vertex count
};

// What is asked of a primitive: UV sets (TEXCOORD_n; -1: none), joints, and its morph targets' weights.
struct PrimitiveRequest {
    int walkUv = 0, drawnUv = 0, otherUv = -1;
    bool joints = false;
    std::vector<double> morph;
    int colour = 0;  // how many components COLOR_0 has; 0: there is none
};
// What a request for a primitive's colours has to say.
int colourComponents(const Document& document, const tinygltf::Primitive& primitive);

// Reads a primitive of triangles, through Draco where it says so. What it can do without, as normals of another count
// than its positions, is left out with a warning. One without triangles is returned without indices.
Result<Primitive> readPrimitive(const Document& document, const tinygltf::Primitive& primitive,
                                const PrimitiveRequest& request, const std::string& place,
                                std::vector<Diagnostic>& warnings);

// The accessor of a primitive's indices; -1: none, or Draco's. openDocument has put it into the extras.
int indicesOf(const tinygltf::Primitive& primitive);

// Fills in what of the request KHR_draco_mesh_compression packs. Remarks tell of attributes that it can do without.
Status readDraco(const Document& document, const tinygltf::Primitive& primitive, const PrimitiveRequest& request,
                 const std::string& place, Primitive& out, std::vector<std::string>& remarks);

// A vertex attribute that may be read, and where it goes.
struct Attribute {
    std::string name;
    int components;
    std::vector<float>* into;
};
std::vector<Attribute> attributesOf(const PrimitiveRequest& request, Primitive& out);
std::string leftOut(const Attribute& attribute, const Failure& why);  // a remark

// Adds morph targets to positions and normals by their weights; changes nothing where it fails.
Status applyMorphs(const Document& document, const tinygltf::Primitive& from, const std::vector<double>& weights,
                   Primitive& out);

// Nodes: a node's own transform; the transforms of all nodes with those of their parents; and those of the instances of
// EXT_mesh_gpu_instancing below a node, one that changes nothing without it.
glm::dmat4 localTransform(const tinygltf::Node& node);
std::vector<glm::dmat4> worldTransforms(const Document& document);
Result<std::vector<glm::dmat4>> readInstances(const Document& document, const tinygltf::Node& node,
                                              const std::string& where);
bool isFinite(const glm::dmat4& m);

// Where a mesh is put: by one matrix, or each vertex by the joints that carry it.
struct Placement {
    glm::dmat4 world{1};
    std::vector<glm::dmat4> joints;  // of its skin, each with its inverse bind matrix; empty: it has none
    glm::dmat4 of(const Primitive& from, size_t vertex) const;
};

// The joints of a skin as its nodes stand: what a viewer shows before any animation.
Result<std::vector<glm::dmat4>> readSkin(const Document& document, int skin, const std::vector<glm::dmat4>& worlds);
// Makes each vertex's weights sum to one. Returns how many vertices named a joint that isn't there, or had no weight.
size_t mendWeights(Primitive& primitive, size_t joints);

// Finds the pictures of textures and decodes each once, when a material first asks for it.
class Textures {
  public:
    Textures(const Document& document, std::vector<Picture>& pictures, std::vector<Diagnostic>& warnings)
        : document_(document), pictures_(pictures), warnings_(warnings) {}

    // Which of the pictures a texture shows; -1: none, with a warning unless texture is -1.
    int find(int texture);
    // The mean of its channels, 0 to 1, of a texture whose picture isn't kept for that; 1 where it has none.
    glm::vec4 meanOf(int texture);

  private:
    int choose(int texture);
    // by, otherwise: what a warning says before and behind the reason.
    int decode(int image, const std::string& by, const std::string& otherwise);
    void warn(std::string text);  // once

    const Document& document_;
    std::vector<Picture>& pictures_;
    std::vector<Diagnostic>& warnings_;
    std::map<int, int> textures_, images_;  // of the document -> pictures
};

// Reads materials, their names and the images that they use; what is missing becomes a warning.
// uvs[i]: the UV sets of material i's textures, and an affine map (KHR_texture_transform) that all of them share.
struct MaterialUv {
    int texCoord = 0;  // of DrawVertex::uv
    int other = -1;    // of DrawVertex::otherUv; -1: none
    glm::vec3 u{1, 0, 0}, v{0, 1, 0};
};
void readMaterials(const Document& document, Model& model, std::vector<MaterialUv>& uvs);

}  // namespace espalier::import
