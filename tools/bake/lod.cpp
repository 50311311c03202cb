// In: the mesh as it is drawn. Out: ever simpler ones by quadric edge collapses (meshoptimizer), each with its measured
// distance to the mesh. Seams of materials and of textures collapse on both sides alike, so that what is closed stays
// closed. Where no texture is drawn, seams of charts and normals are none: corners take the normal that fits the new
// triangle best. What has no edges to collapse, as kits of boxes, is put into a grid's cells instead (lod_cluster.cpp).
#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "runtime/core/jobs.hpp"
#include "runtime/surface/mesh_tree.hpp"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/lod_cluster.hpp"

namespace espalier::bakery {
namespace {

constexpr size_t kFewestTriangles = 48;
constexpr double kWorthwhile = 0.75;        // of the triangles before: what can't be made simpler ends the chain
constexpr float kLargestError = 1.0f / 16;  // of the bounding radius: beyond that it is another thing
constexpr float kFinestCell = 1.0f / 512;   // of the bounding radius
constexpr float kNextCell = 1.2f;           // of one side to the one before
constexpr size_t kSamples = 2048;           // each way
constexpr size_t kSamplesAtOnce = 64;
constexpr float kAnyDistance = std::numeric_limits<float>::infinity();

std::vector<glm::vec3> positionsOf(const std::vector<DrawVertex>& vertices) {
    std::vector<glm::vec3> out(vertices.size());
    for (size_t i = 0; i < out.size(); ++i) out[i] = vertices[i].position;
    return out;
}

// The largest distance from samples of one mesh, its corners and its triangles' middles, to the other; `least` if that
// is more.
float distanceTo(const MeshTree& to, const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                 float least) {
    const size_t triangles = indices.size() / 3, stride = std::max<size_t>(1, triangles * 2 / kSamples);
    const size_t count = (triangles + stride - 1) / stride;
    std::vector<float> found((count + kSamplesAtOnce - 1) / kSamplesAtOnce, least);
    parallelFor(count, kSamplesAtOnce, [&](size_t begin, size_t end) {
        float& most = found[begin / kSamplesAtOnce];
        for (size_t i = begin; i < end; ++i) {
            const uint32_t* t = &indices[i * stride * 3];
            const glm::vec3 a = vertices[t[0]].position, b = vertices[t[1]].position, c = vertices[t[2]].position;
            for (glm::vec3 p : {a, (a + b + c) / 3.0f})
                if (auto hit = to.nearest(p, kAnyDistance, most)) most = std::max(most, hit->distance);
        }
    });
    return count == 0 ? least : *std::max_element(found.begin(), found.end());
}

// How far colours of the mesh are off where the simple mesh stands for it: the difference, of one channel, times the
// length over which the simple triangle there spreads its corners' colours. By samples, triangles' middles.
float colourError(const MeshTree& simple, const CoarserMesh& mesh, const SurfaceData& surface, float least) {
    const auto isColoured = [](const Material& m) { return m.coloured; };
    if (std::ranges::none_of(surface.materials, isColoured)) return least;
    const auto colourOf = [](const std::vector<DrawVertex>& vertices, const uint32_t* t, glm::vec3 weights) {
        return unpackColour(vertices[t[0]].colour) * weights.x + unpackColour(vertices[t[1]].colour) * weights.y +
               unpackColour(vertices[t[2]].colour) * weights.z;
    };
    const size_t triangles = surface.indices.size() / 3, stride = std::max<size_t>(1, triangles * 2 / kSamples);
    const size_t count = (triangles + stride - 1) / stride;
    std::vector<float> found((count + kSamplesAtOnce - 1) / kSamplesAtOnce, least);
    parallelFor(count, kSamplesAtOnce, [&](size_t begin, size_t end) {
        float& most = found[begin / kSamplesAtOnce];
        for (size_t i = begin; i < end; ++i) {
            const uint32_t* t = &surface.indices[i * stride * 3];
            const auto& from = surface.vertices;
            const auto hit = simple.nearest((from[t[0]].position + from[t[1]].position + from[t[2]].position) / 3.0f);
            if (!hit) continue;
            const uint32_t* s = &mesh.indices[size_t(hit->triangle) * 3];
            const glm::vec4 there = colourOf(mesh.vertices, s, {1 - hit->weights.x - hit->weights.y, hit->weights});
            const glm::vec4 off = glm::abs(colourOf(from, t, glm::vec3(1.0f / 3)) - there);
            float length = 0;
            for (size_t k = 0; k < 3; ++k)
                length = std::max(length,
                                  glm::distance(mesh.vertices[s[k]].position, mesh.vertices[s[(k + 1) % 3]].position));
            most = std::max(most, length * std::max({off.x, off.y, off.z}));
        }
    });
    return count == 0 ? least : *std::ranges::max_element(found);
}

// The largest distance to the mesh of bilinear reads between four inner texels of a chart, creases left out: there a
// walk takes the triangle.
float levelError(const SurfaceLevelData& level, const MeshTree& mesh) {
    std::vector<glm::vec3> places;
    const uint32_t stride = std::max(1u, level.size / 64);
    for (uint32_t y = 0; y + 1 < level.size; y += stride)
        for (uint32_t x = 0; x + 1 < level.size; x += stride) {
            glm::vec3 sum(0);
            bool inside = true;
            const uint32_t chart = texelChart(level.texels[texelIndex(level.size, x, y)].bits);
            for (uint32_t k = 0; k < 4; ++k) {
                const Texel& t = level.texels[texelIndex(level.size, x + (k & 1), y + (k >> 1))];
                inside =
                    inside && texelClass(t.bits) == kTexelInner && texelChart(t.bits) == chart && !texelCrease(t.bits);
                sum += t.position;
            }
            if (inside) places.push_back(sum / 4.0f);
        }
    float error = 0;
    for (glm::vec3 p : places)
        if (auto hit = mesh.nearest(p, kAnyDistance, error)) error = std::max(error, hit->distance);
    return error;
}

// Only what the indices use, in their order.
CoarserMesh compact(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& materialOf,
                    const std::vector<uint32_t>& indices, std::vector<uint32_t>& materials) {
    CoarserMesh mesh;
    std::vector<uint32_t> order(indices.size() / 3), place(vertices.size(), kNone);
    for (uint32_t t = 0; t < order.size(); ++t) order[t] = t;
    auto material = [&](uint32_t t) { return materialOf[indices[size_t(t) * 3]]; };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return material(a) < material(b); });
    materials.clear();
    for (uint32_t t : order) {
        if (mesh.ranges.empty() || mesh.ranges.back().material != material(t))
            mesh.ranges.push_back({uint32_t(mesh.indices.size()), 0, material(t)});
        mesh.ranges.back().indexCount += 3;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t v = indices[size_t(t) * 3 + k];
            if (place[v] == kNone) {
                place[v] = uint32_t(mesh.vertices.size());
                mesh.vertices.push_back(vertices[v]);
                materials.push_back(materialOf[v]);
            }
            mesh.indices.push_back(place[v]);
        }
    }
    return mesh;
}

// Which vertices are one to the collapses: of untextured materials all in one place that have one colour. next: further
// vertices of a group.
struct Groups {
    std::vector<uint32_t> first, next;  // per vertex
};

Groups groupVertices(const CoarserMesh& mesh, const std::vector<uint32_t>& materialOf, const SurfaceData& surface) {
    const size_t count = mesh.vertices.size();
    Groups groups{std::vector<uint32_t>(count), std::vector<uint32_t>(count, kNone)};
    std::vector<uint32_t> order(count);
    for (uint32_t v = 0; v < count; ++v) groups.first[v] = order[v] = v;
    auto key = [&](uint32_t v) {
        const glm::vec3 p = mesh.vertices[v].position;
        return std::tuple(materialOf[v], p.x, p.y, p.z, mesh.vertices[v].colour);
    };
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (size_t i = 1; i < count; ++i) {
        const Material& material = surface.materials[materialOf[order[i]]];
        if (isTextured(material) || key(order[i]) != key(order[i - 1])) continue;
        groups.first[order[i]] = groups.first[order[i - 1]];
        groups.next[order[i - 1]] = order[i];
    }
    return groups;
}

// Gives each corner, which names a group by its first vertex, the vertex whose normal is nearest to the triangle's.
void dress(const CoarserMesh& mesh, const Groups& groups, std::vector<uint32_t>& indices) {
    for (size_t i = 0; i < indices.size(); i += 3) {
        const glm::vec3 a = mesh.vertices[indices[i]].position;
        const glm::vec3 n =
            glm::cross(mesh.vertices[indices[i + 1]].position - a, mesh.vertices[indices[i + 2]].position - a);
        for (size_t k = 0; k < 3; ++k) {
            uint32_t& corner = indices[i + k];
            for (uint32_t v = groups.next[corner]; v != kNone; v = groups.next[v])
                if (glm::dot(mesh.vertices[v].normal, n) > glm::dot(mesh.vertices[corner].normal, n)) corner = v;
        }
    }
}

// Vertices of their own for each material, so that a triangle's is known by its corners.
void splitByMaterial(const SurfaceData& surface, CoarserMesh& mesh, std::vector<uint32_t>& materials) {
    mesh.ranges = surface.ranges;
    mesh.indices.resize(surface.indices.size());
    for (const DrawRange& range : surface.ranges) {
        std::vector<uint32_t> place(surface.vertices.size(), kNone);
        for (uint32_t i = range.firstIndex; i < range.firstIndex + range.indexCount; ++i) {
            const uint32_t v = surface.indices[i];
            if (place[v] == kNone) {
                place[v] = uint32_t(mesh.vertices.size());
                mesh.vertices.push_back(surface.vertices[v]);
                materials.push_back(range.material);
            }
            mesh.indices[i] = place[v];
        }
    }
}

// About half the triangles, by collapsing edges; false: too few give way.
bool collapse(const SurfaceData& surface, CoarserMesh& mesh, std::vector<uint32_t>& materials) {
    const Groups groups = groupVertices(mesh, materials, surface);
    std::vector<uint32_t> indices(mesh.indices.size()), grouped;
    for (uint32_t v : mesh.indices) grouped.push_back(groups.first[v]);
    indices.resize(meshopt_simplify(indices.data(), grouped.data(), grouped.size(), &mesh.vertices[0].position.x,
                                    mesh.vertices.size(), sizeof(DrawVertex), mesh.indices.size() / 6 * 3,
                                    kLargestError, 0, nullptr));
    if (double(indices.size()) > kWorthwhile * double(mesh.indices.size())) return false;
    dress(mesh, groups, indices);
    mesh = compact(mesh.vertices, std::vector<uint32_t>(materials), indices, materials);
    return true;
}

// About half the triangles, by the finest grid of cells that leaves no more; false: its cells would be too large.
bool cluster(float radius, CoarserMesh& mesh, std::vector<uint32_t>& materials) {
    for (float cell = kFinestCell * radius; cell < 2 * kLargestError * radius; cell *= kNextCell) {
        std::vector<DrawVertex> vertices = mesh.vertices;
        const std::vector<uint32_t> indices = clusterVertices(vertices, mesh.indices, materials, cell);
        if (indices.size() * 2 > mesh.indices.size()) continue;
        if (indices.size() / 3 < kFewestTriangles / 2) return false;
        mesh = compact(vertices, std::vector<uint32_t>(materials), indices, materials);
        return true;
    }
    return false;
}

}  // namespace

MeshTree drawnTree(const SurfaceData& surface) {
    return {positionsOf(surface.vertices), surface.indices};
}

void measureLevelErrors(const MeshTree& drawn, SurfaceData& surface) {
    for (SurfaceLevelData& level : surface.levels) level.error = levelError(level, drawn);
}

void simplifyDrawing(const MeshTree& drawn, SurfaceData& surface) {
    const float radius = glm::length(surface.boundsMax - surface.boundsMin) / 2;
    CoarserMesh from;
    std::vector<uint32_t> materials;
    splitByMaterial(surface, from, materials);
    while (from.indices.size() / 3 >= kFewestTriangles * 2) {
        if (!collapse(surface, from, materials) && !cluster(radius, from, materials)) return;
        const MeshTree simple(positionsOf(from.vertices), from.indices);
        from.error = surface.coarser.empty() ? 0 : surface.coarser.back().error;
        from.error = distanceTo(simple, surface.vertices, surface.indices, from.error);
        from.error = distanceTo(drawn, from.vertices, from.indices, from.error);
        from.error = colourError(simple, from, surface, from.error);
        if (from.error > kLargestError * radius) return;
        surface.coarser.push_back(from);
    }
}

}  // namespace espalier::bakery
