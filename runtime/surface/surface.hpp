#pragma once

// A baked surface in memory: what the baker writes, a file holds and the GPU is given.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"
#include "shaders/shared/surface_records.h"

namespace espalier {

// One level of the pyramid; every array in texelIndex order, size × size long.
struct SurfaceLevelData {
    uint32_t size = 0;  // texels a side, a multiple of 8
    std::vector<Texel> texels;
    std::vector<TexelAux> aux;
    std::vector<uint32_t> crossingHead;  // bits 31..8 first, 7..0 count, into crossingRefs
    std::vector<uint32_t> crossingRefs;  // indices into SurfaceData::crossings
    float error = 0;                     // metres: the largest distance to the mesh that sampled bilinear reads have
};

// An 8-bit RGBA picture, rows top to bottom, or empty.
struct Picture {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;
    std::vector<uint8_t> encoded;  // the PNG or JPEG that it came from, kept in files; empty: none
};

// By which UVs a texture is looked up: a set of the vertices', moved as KHR_texture_transform says.
struct TextureMap {
    uint32_t set = 0;  // 0: DrawVertex::uv; 1: otherUv
    glm::vec2 offset{0}, scale{1};
    float rotation = 0;  // radians
    bool operator==(const TextureMap&) const = default;
};
// The map's rows: u = dot(rows[0], (u, v, 1)), v likewise.
std::array<glm::vec3, 2> rowsOf(const TextureMap& map);

// What is seen beyond the borders of a picture.
enum class Wrap : uint32_t { repeat, clamp, mirror };
constexpr uint32_t kWraps = 3;

// A glTF material as far as it is drawn. An image index of -1: none.
struct Material {
    glm::vec4 baseColor{1};   // linear
    int baseColorImage = -1;  // sRGB
    int normalImage = -1;     // tangent space, +Y up
    int emissiveImage = -1;   // sRGB
    int roughnessImage = -1;  // linear; green times `roughness`, blue times `metallic`
    float normalScale = 1;
    float roughness = 1;
    float metallic = 0;      // share of a metal: it mirrors by its colour and scatters nothing
    float alphaCutoff = 0;   // 0: opaque
    glm::vec3 emissive{0};   // linear, times its strength
    float transmission = 0;  // share of the light that passes straight through
    bool blended = false;    // what lies behind is seen where alpha is below 1
    bool doubleSided = false;
    bool bare = false;      // nothing grows on it
    bool coloured = false;  // vertices that have it have colours of their own
    TextureMap baseColorMap, normalMap, emissiveMap, roughnessMap;
    Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;  // of all its pictures
};
inline bool isTextured(const Material& m) {
    return m.baseColorImage >= 0 || m.normalImage >= 0 || m.emissiveImage >= 0 || m.roughnessImage >= 0;
}
inline bool usesOtherUv(const Material& m) {
    return m.baseColorMap.set + m.normalMap.set + m.emissiveMap.set + m.roughnessMap.set > 0;
}

// A vertex's colour, linear; 65535 is 1.
using VertexColour = std::array<uint16_t, 4>;
inline constexpr VertexColour kWhite{65535, 65535, 65535, 65535};
VertexColour packColour(glm::vec4 linear);
glm::vec4 unpackColour(const VertexColour& colour);

struct DrawVertex {
    glm::vec3 position;  // object space, metres
    glm::vec3 normal;
    glm::vec4 tangent;  // of the normal map; w: sign of the bitangent; zero where the model has no UVs
    glm::vec2 uv;       // the materials' UV set
    glm::vec2 walkUv;
    glm::vec2 otherUv{0};          // a second set, of materials whose textures lie in two
    VertexColour colour = kWhite;  // times the material's
};

struct DrawRange {
    uint32_t firstIndex = 0, indexCount = 0;
    uint32_t material = 0;
};

// A simplified mesh for drawing from afar.
struct CoarserMesh {
    std::vector<DrawVertex> vertices;
    std::vector<uint32_t> indices;
    std::vector<DrawRange> ranges;
    float error = 0;  // metres: the largest distance between it and the mesh, either way, that samples found
};

struct SurfaceData {
    std::string source;                    // name of the model that was baked
    uint64_t hash = 0;                     // of the walk's data; layers and seeds refer to it
    std::vector<SurfaceLevelData> levels;  // 0 the finest; 1 to kMaxLevels
    std::vector<Crossing> crossings;
    std::vector<Chart> charts;
    std::vector<TrianglePlane> triangles;  // sorted by chart
    glm::vec3 boundsMin{0}, boundsMax{0};
    glm::dvec3 origin{0};  // metres: the model's file says positions that are larger by this

    std::vector<DrawVertex> vertices;  // the decoded mesh, for drawing
    std::vector<uint32_t> indices;
    std::vector<DrawRange> ranges;
    std::vector<CoarserMesh> coarser;  // of fewer and fewer triangles, of rising error; none for small models
    std::vector<Material> materials;
    std::vector<Picture> images;
    std::vector<uint8_t> bareTriangles;  // of `indices`: 1, of a bare material; empty: none is
};

// The record by which kernels' CPU build reads `data` (pointers into it: valid while `data` lives unchanged).
SurfaceRef surfaceRef(const SurfaceData& data, float scale = 1);

// The hash of what a walk reads of `data`: levels, crossings, charts, triangles.
uint64_t walkHash(const SurfaceData& data);
// Its parts: of one level, and of all that levels share.
uint64_t levelHash(const SurfaceLevelData& level);
uint64_t sharedHash(const SurfaceData& data);

// Where a triangle's map leads from a place on the walk's UV square; the same bits everywhere.
inline glm::vec3 placeOn(const TrianglePlane& t, glm::vec2 uv) {
    return t.position + t.du * (uv.x - t.uv0.x) + t.dv * (uv.y - t.uv0.y);
}

// Fills in bareTriangles by ranges and materials.
void markBareTriangles(SurfaceData& data);

// Fills in Material::coloured by the vertices of a mesh; all materials that its ranges name must be there.
void markColoured(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                  const std::vector<DrawRange>& ranges, std::vector<Material>& materials);

// Puts tangents on vertices from positions, normals and the UVs of their materials' normal maps; zero where those have
// no area.
void addTangents(std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                 const std::vector<DrawRange>& ranges, const std::vector<Material>& materials);

// What of a file is read. With a finestLevel above 0 reading stops after that level, and the rest of the file may be
// missing still: levels count from that one, the mesh is the finest that stands before it in the file, pictures are
// empty, and charts that no such level serves are walked on it without their gutters. The hash is the whole surface's.
struct ReadOptions {
    uint32_t finestLevel = 0;  // beyond the coarsest: the coarsest
};

// Reads a baked surface (.glb). Every index and size in it is validated; errors name the file and the place.
Result<SurfaceData> readSurface(const std::string& path, const ReadOptions& options = {});
// The same of a file's bytes. name: for errors.
Result<SurfaceData> parseSurface(std::vector<std::byte> file, const std::string& name);

// Writes `data` as a valid glTF 2.0 binary with the extension of docs/surface_format.md, atomically: on
// failure nothing is left at `path`.
Status writeSurface(const SurfaceData& data, const std::string& path);

}  // namespace espalier
