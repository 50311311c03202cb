// Stones that fell from the ruin: rubble, and single ones. In: nothing. Out: meshes, and a picture of all their faces
// in the masonry's own colours, with moss where they look up.

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <iterator>

#include "runtime/core/srgb.hpp"
#include "tools/content/masonry.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/props.hpp"

namespace espalier::content {
namespace {

using glm::vec2, glm::vec3;

constexpr int kFaces = 6, kCell = 128, kColumns = 8;  // of the picture, which has a cell for each face of a stone
constexpr float kMargin = 3.0f / kCell;               // of a cell, so that near by no other face is read

// A block that rain has rounded, uneven, mossy where it looks up, damp where it lies in the soil.
struct Worn {
    vec3 middle, half;  // metres
    float turn, tilt;   // about the vertical, then about its own x
    uint32_t salt;
};

constexpr Worn kStones[] = {{{0, 0.13f, 0}, {0.34f, 0.21f, 0.25f}, 0.3f, 0.05f, 91},
                            {{0.60f, 0.09f, 0.10f}, {0.27f, 0.18f, 0.23f}, 1.2f, -0.10f, 92},
                            {{0.10f, 0.07f, -0.50f}, {0.28f, 0.16f, 0.20f}, 2.3f, 0.16f, 93},
                            {{0.30f, 0.40f, 0.04f}, {0.30f, 0.14f, 0.20f}, 0.2f, 0.06f, 94},
                            {{-0.60f, 0.04f, 0.30f}, {0.22f, 0.13f, 0.16f}, 0.9f, 0.30f, 95},
                            {{0.78f, 0.03f, -0.52f}, {0.16f, 0.10f, 0.13f}, 2.8f, -0.24f, 96},
                            {{-0.26f, 0.02f, 0.68f}, {0.13f, 0.09f, 0.11f}, 1.7f, 0.20f, 97},
                            {{0, 0.03f, 0}, {0.19f, 0.17f, 0.17f}, 0.4f, 0.34f, 105},
                            {{0, 0, 0}, {0.23f, 0.12f, 0.18f}, 1.1f, -0.20f, 112}};
constexpr int kHeap = 7, kThick = 7, kFlat = 8;  // so many lie in a heap; places of the single ones
constexpr int kCells = int(std::size(kStones)) * kFaces, kRows = (kCells + kColumns - 1) / kColumns;

// The direction from a stone's middle through a point of a face of a cube around it; at: -1 to 1.
vec3 wayOf(int face, vec2 at) {
    const int axis = face / 2;
    const float side = face % 2 ? 1.0f : -1.0f;
    vec3 way;
    way[axis] = side;
    way[(axis + 1) % 3] = side * at.x;
    way[(axis + 2) % 3] = at.y;
    return glm::normalize(way);
}

vec3 pointOf(const Worn& stone, vec3 way) {
    constexpr float kBlocky = 9, kUneven = 0.20f, kRough = 0.035f;
    const glm::mat3 pose = glm::mat3(glm::rotate(glm::mat4(1), stone.turn, vec3(0, 1, 0)) *
                                     glm::rotate(glm::mat4(1), stone.tilt, vec3(1, 0, 0)));
    const vec3 a = glm::pow(glm::abs(way), vec3(kBlocky));
    const float uneven = kUneven * fractal(1.6f * way, stone.salt, 3) + kRough * fractal(7.0f * way, stone.salt + 2, 2);
    return stone.middle + pose * (stone.half * way * ((1 + uneven) / std::pow(a.x + a.y + a.z, 1 / kBlocky)));
}

vec3 normalOf(const Worn& stone, vec3 way) {
    constexpr float kApart = 0.02f;
    const vec3 u = glm::normalize(glm::cross(way, std::abs(way.y) < 0.7f ? vec3(0, 1, 0) : vec3(1, 0, 0))),
               v = glm::cross(way, u);
    return glm::normalize(glm::cross(pointOf(stone, way + kApart * u) - pointOf(stone, way - kApart * u),
                                     pointOf(stone, way + kApart * v) - pointOf(stone, way - kApart * v)));
}

vec3 colourOf(const Worn& stone, int face, vec2 at) {
    const vec3 way = wayOf(face, at), p = pointOf(stone, way), n = normalOf(stone, way);
    StoneLook look;
    look.block = p + vec3(float(stone.salt));
    look.st = stone.half.x * at + vec2(float(face), float(stone.salt));
    look.aboveGround = p.y + 0.25f;  // rain dries from them sooner than from a wall's foot
    look.upward = ramp(0.3f, 0.95f, n.y);
    const vec3 colour = stoneDetail({stone.salt, 1, 1, {0, 0}}, look).albedo;
    return colour * (0.55f + 0.45f * ramp(-0.02f, 0.12f, p.y));  // soil clings to what is sunk
}

void addWorn(Mesh& mesh, int place, int steps) {
    const Worn& stone = kStones[place];
    for (int face = 0; face < kFaces; ++face) {
        const int cell = place * kFaces + face;
        const vec2 corner(float(cell % kColumns), float(cell / kColumns));
        const uint32_t first = uint32_t(mesh.positions.size()), row = uint32_t(steps) + 1;
        for (int y = 0; y <= steps; ++y)
            for (int x = 0; x <= steps; ++x) {
                const vec2 share = vec2(float(x), float(y)) / float(steps);
                const vec3 way = wayOf(face, 2.0f * share - 1.0f);
                mesh.positions.push_back(pointOf(stone, way));
                mesh.normals.push_back(normalOf(stone, way));
                mesh.uvs.push_back((corner + kMargin + (1 - 2 * kMargin) * share) / vec2(kColumns, kRows));
            }
        for (uint32_t y = 0; y < uint32_t(steps); ++y)
            for (uint32_t x = 0; x < uint32_t(steps); ++x)
                for (uint32_t k : {0u, 1u, row + 1, 0u, row + 1, row}) mesh.indices.push_back(first + y * row + x + k);
    }
}

// A heap of them: some sunk into the ground, one on two others.
Mesh rubble(int lod) {
    Mesh mesh;
    for (int place = 0; place < kHeap; ++place) addWorn(mesh, place, lod == 0 ? 4 : 2);
    return mesh;
}
// One of them, half sunk.
Mesh single(int place, int lod) {
    Mesh mesh;
    addWorn(mesh, place, lod == 0 ? 8 : 2);
    return mesh;
}

}  // namespace

Picture paintFallenStones() {
    Picture picture(kColumns * kCell, kRows * kCell);
    for (int cell = 0; cell < kCells; ++cell)
        for (int y = 0; y < kCell; ++y)
            for (int x = 0; x < kCell; ++x) {
                const vec2 share = (vec2(float(x), float(y)) + 0.5f) / float(kCell);
                const vec2 at = 2.0f * ((share - kMargin) / (1 - 2 * kMargin)) - 1.0f;
                const vec3 colour = colourOf(kStones[cell / kFaces], cell % kFaces, at);
                uint8_t* texel = picture.at(cell % kColumns * kCell + x, cell / kColumns * kCell + y);
                for (int k = 0; k < 3; ++k) texel[k] = toByte(srgbOfLinear(colour[k]));
                texel[3] = 255;
            }
    return picture;
}

void addFallenStones(PropMeshes& out) {
    for (int lod : {0, 1}) {
        out.add("rubble", lod, rubble(lod), PropMeshes::kFallen);
        out.add("stone_a", lod, single(kThick, lod), PropMeshes::kFallen);
        out.add("stone_b", lod, single(kFlat, lod), PropMeshes::kFallen);
    }
}

}  // namespace espalier::content
