// In: a baked surface in memory. Out: the record for kernels built for the CPU, the hash of what a walk reads,
// tangents for drawing.
#include "runtime/surface/surface.hpp"

#include <cmath>

#include "runtime/core/hash.hpp"
#include "runtime/core/jobs.hpp"

namespace espalier {
namespace {

// Arrays are hashed in pieces of this many bytes, so that all cores may work on one.
constexpr size_t kHashPiece = size_t(1) << 20;

template <class T>
uint64_t hashArray(const std::vector<T>& values, uint64_t seed) {
    auto bytes = std::as_bytes(std::span<const T>(values));
    std::vector<uint64_t> parts((bytes.size() + kHashPiece - 1) / kHashPiece);
    parallelFor(parts.size(), 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            parts[i] = hashBytes(bytes.subspan(i * kHashPiece, std::min(kHashPiece, bytes.size() - i * kHashPiece)));
    });
    parts.push_back(bytes.size());
    return hashValues(std::span<const uint64_t>(parts), seed);
}

template <class T>
T* address(const std::vector<T>& values) {
    return const_cast<T*>(values.data());  // kernels' buffers know no const; they only read surfaces
}

}  // namespace

uint64_t levelHash(const SurfaceLevelData& level) {
    uint64_t hash = hashArray(level.texels, level.size);
    hash = hashArray(level.aux, hash);
    hash = hashArray(level.crossingHead, hash);
    return hashArray(level.crossingRefs, hash);
}

uint64_t sharedHash(const SurfaceData& data) {
    uint64_t hash = hashText("ESPALIER_surface 2");
    hash = hashArray(data.crossings, hash);
    hash = hashArray(data.charts, hash);
    return hashArray(data.triangles, hash);
}

uint64_t walkHash(const SurfaceData& data) {
    std::vector<uint64_t> parts{sharedHash(data)};
    for (const SurfaceLevelData& level : data.levels) parts.push_back(levelHash(level));
    return hashValues(std::span<const uint64_t>(parts));
}

SurfaceRef surfaceRef(const SurfaceData& data, float scale) {
    SurfaceRef ref{};
    for (size_t i = 0; i < data.levels.size() && i < kMaxLevels; ++i) {
        const SurfaceLevelData& level = data.levels[i];
        SurfaceLevel& to = ref.levels[i];
        to.texels = {address(level.texels)};
        to.aux = {address(level.aux)};
        to.crossingHead = {address(level.crossingHead)};
        to.crossingRefs = {address(level.crossingRefs)};
        to.size = level.size;
    }
    ref.crossings = {address(data.crossings)};
    ref.charts = {address(data.charts)};
    ref.triangles = {address(data.triangles)};
    ref.levelCount = uint32_t(data.levels.size());
    ref.chartCount = uint32_t(data.charts.size());
    ref.crossingCount = uint32_t(data.crossings.size());
    ref.triangleCount = uint32_t(data.triangles.size());
    ref.boundsMin = data.boundsMin;
    ref.boundsMax = data.boundsMax;
    ref.radius = glm::length(data.boundsMax - data.boundsMin) / 2;
    ref.scale = scale;
    for (int row = 0; row < 3; ++row) {
        ref.toWorld[row] = glm::vec4(0);
        ref.toWorld[row][row] = scale;
    }
    return ref;
}

void markBareTriangles(SurfaceData& data) {
    data.bareTriangles.clear();
    for (const DrawRange& range : data.ranges) {
        if (!data.materials[range.material].bare) continue;
        data.bareTriangles.resize(data.indices.size() / 3, 0);
        std::fill_n(data.bareTriangles.begin() + range.firstIndex / 3, range.indexCount / 3, uint8_t(1));
    }
}

VertexColour packColour(glm::vec4 linear) {
    VertexColour out = kWhite;
    for (int k = 0; k < 4; ++k)
        if (linear[k] < 1) out[size_t(k)] = uint16_t(std::max(linear[k], 0.0f) * 65535 + 0.5f);
    return out;
}

glm::vec4 unpackColour(const VertexColour& colour) {
    return glm::vec4(colour[0], colour[1], colour[2], colour[3]) / 65535.0f;
}

void markColoured(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                  const std::vector<DrawRange>& ranges, std::vector<Material>& materials) {
    for (const DrawRange& range : ranges)
        for (uint32_t i = range.firstIndex; i < range.firstIndex + range.indexCount; ++i)
            if (vertices[indices[i]].colour != kWhite) {
                materials[range.material].coloured = true;
                break;
            }
}

std::array<glm::vec3, 2> rowsOf(const TextureMap& map) {
    const float c = std::cos(map.rotation), s = std::sin(map.rotation);
    return {glm::vec3(c * map.scale.x, s * map.scale.y, map.offset.x),
            glm::vec3(-s * map.scale.x, c * map.scale.y, map.offset.y)};
}

void addTangents(std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                 const std::vector<DrawRange>& ranges, const std::vector<Material>& materials) {
    std::vector<glm::vec2> uv(vertices.size());
    for (size_t i = 0; i < uv.size(); ++i) uv[i] = vertices[i].uv;
    for (const DrawRange& range : ranges) {
        const TextureMap& map = materials[range.material].normalMap;
        if (map == TextureMap()) continue;
        const auto rows = rowsOf(map);
        for (uint32_t i = range.firstIndex; i < range.firstIndex + range.indexCount; ++i) {
            const DrawVertex& vertex = vertices[indices[i]];
            const glm::vec3 at(map.set == 0 ? vertex.uv : vertex.otherUv, 1);
            uv[indices[i]] = {glm::dot(rows[0], at), glm::dot(rows[1], at)};
        }
    }
    std::vector<glm::vec3> u(vertices.size(), glm::vec3(0)), v(vertices.size(), glm::vec3(0));
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const DrawVertex &a = vertices[indices[i]], &b = vertices[indices[i + 1]], &c = vertices[indices[i + 2]];
        glm::vec2 d1 = uv[indices[i + 1]] - uv[indices[i]], d2 = uv[indices[i + 2]] - uv[indices[i]];
        float det = d1.x * d2.y - d1.y * d2.x;
        if (std::abs(det) < 1e-20f) continue;
        glm::vec3 e1 = b.position - a.position, e2 = c.position - a.position;
        // Weighted by area in UV: the sign of det, not its size.
        float sign = det < 0 ? -1.0f : 1.0f;
        for (int k = 0; k < 3; ++k) {
            u[indices[i + size_t(k)]] += (e1 * d2.y - e2 * d1.y) * sign;
            v[indices[i + size_t(k)]] += (e2 * d1.x - e1 * d2.x) * sign;
        }
    }
    for (size_t i = 0; i < vertices.size(); ++i) {
        glm::vec3 n = vertices[i].normal, t = u[i] - n * glm::dot(n, u[i]);
        float length = glm::length(t);
        if (!(length > 1e-20f)) {
            vertices[i].tangent = glm::vec4(0);
            continue;
        }
        // glTF's V runs down the picture; the bitangent is cross(normal, tangent) * w along +V of the UVs flipped.
        float w = glm::dot(glm::cross(n, t), v[i]) < 0 ? 1.0f : -1.0f;
        vertices[i].tangent = glm::vec4(t / length, w);
    }
}

}  // namespace espalier
