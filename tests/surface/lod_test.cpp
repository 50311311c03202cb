// Coarser meshes and levels' errors, judged on a sphere whose shape is known; reading a file as far as it has come.
#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <map>
#include <tuple>

#include "runtime/core/file.hpp"
#include "runtime/surface/surface.hpp"
#include "tests/bake/kits.hpp"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A cube blown up to the unit sphere: six charts, two materials whose border runs over them.
Model sphere(int n) {
    Model model = cube(n);
    for (glm::vec3& p : model.positions) p = glm::normalize(p);
    model.normals = model.positions;
    model.materials.resize(2);
    for (size_t t = 0; t < model.indices.size() / 3; ++t)
        model.triangleMaterial.push_back(model.positions[model.indices[t * 3]].x > 0.3f ? 1 : 0);
    return model;
}

SurfaceData baked(const Model& model, uint32_t resolution) {
    BakeOptions options;
    options.resolution = resolution;
    auto done = bake(model, options);
    if (!done) FAIL(done.failure().text());
    return std::move(done->surface);
}

struct File {
    std::string path;
    explicit File(const std::string& name)
        : path((std::filesystem::temp_directory_path() / ("espalier_lod_" + std::to_string(std::rand()) + name))
                   .string()) {}
    ~File() { std::filesystem::remove(path); }
};

// Edges, by the bits of their ends' positions, that aren't met once in either direction.
size_t openEdges(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices) {
    using Place = std::tuple<float, float, float>;
    std::map<std::pair<Place, Place>, int> edges;
    auto place = [&](size_t i) {
        const glm::vec3 p = vertices[indices[i]].position;
        return Place{p.x, p.y, p.z};
    };
    for (size_t t = 0; t < indices.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            const Place a = place(t + k), b = place(t + (k + 1) % 3);
            if (a == b) continue;
            edges[{a, b}] += 1;
            edges[{b, a}] -= 1;
        }
    size_t open = 0;
    for (const auto& [edge, balance] : edges) open += balance != 0;
    return open;
}

// From a point to the triangle that begins at index i: over its face if the point is above it, else over an edge.
float distanceTo(const CoarserMesh& mesh, size_t i, glm::vec3 p) {
    glm::vec3 c[3];
    for (size_t k = 0; k < 3; ++k) c[k] = mesh.vertices[mesh.indices[i + k]].position;
    const glm::vec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    float least = 1e30f;
    bool above = glm::dot(n, n) > 0;
    for (size_t k = 0; k < 3; ++k) {
        const glm::vec3 a = c[k], e = c[(k + 1) % 3] - a;
        above = above && glm::dot(glm::cross(e, p - a), n) >= 0;
        const float t = std::clamp(glm::dot(p - a, e) / glm::dot(e, e), 0.0f, 1.0f);
        least = std::min(least, glm::length(p - a - e * t));
    }
    return above ? std::abs(glm::dot(p - c[0], glm::normalize(n))) : least;
}

}  // namespace

TEST_CASE("coarser meshes of a sphere halve, stay closed in the file, and are no further off than they say") {
    SurfaceData made = baked(sphere(40), 256);
    File file("sphere.glb");
    REQUIRE(writeSurface(made, file.path));
    auto read = readSurface(file.path);
    if (!read) FAIL(read.failure().text());
    REQUIRE(read->coarser.size() >= 4);
    CHECK(openEdges(read->vertices, read->indices) == 0);
    size_t before = read->indices.size();
    float error = 0;
    for (const CoarserMesh& mesh : read->coarser) {
        CAPTURE(mesh.indices.size() / 3);
        CHECK(mesh.indices.size() < before * 3 / 4);
        before = mesh.indices.size();
        CHECK(mesh.error >= error);
        error = mesh.error;
        CHECK(openEdges(mesh.vertices, mesh.indices) == 0);
        CHECK(mesh.ranges.size() == 2);
        // The sphere is within 0.0006 of the mesh that it was made from (40 steps a quarter turn), the file's grid
        // within 0.00003.
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            glm::vec3 middle(0);
            for (size_t k = 0; k < 3; ++k) {
                const glm::vec3 p = mesh.vertices[mesh.indices[i + k]].position;
                middle += p / 3.0f;
                CHECK(std::abs(glm::length(p) - 1) <= mesh.error + 7e-4f);
                CHECK((mesh.vertices[mesh.indices[i + k]].normal.x > -2));
            }
            REQUIRE(std::abs(glm::length(middle) - 1) <= mesh.error * 1.3f + 7e-4f);
        }
    }
    CHECK(error <= std::sqrt(3.0f) / 16);  // of the bounding radius
    CHECK(error > 0.002f);
}

TEST_CASE("kits of textured boxes get coarser too: closed, each part in its own colour, no further off than they say") {
    Kit kit;
    kit.box({0, 0, 0}, glm::dvec3(4, 2, 0.3));
    for (int i = 0; i < 95; ++i) {  // stones that stick out of a wall
        const glm::dvec3 place(i % 19 * 0.4 - 3.6, i / 19 * 0.7 - 1.4, 0.3);
        kit.box(place, glm::dvec3(0.1 + 0.01 * (i % 7), 0.1 + 0.02 * (i % 5), 0.05 + 0.03 * (i % 3)));
    }
    Model model = kit.model();
    model.materials.resize(1);
    model.materials[0].baseColorImage = 0;
    model.images.resize(1);
    model.materialUvs.resize(model.positions.size());  // a palette: a colour a box
    for (size_t t = 0; t < model.indices.size() / 3; ++t)
        for (size_t k = 0; k < 3; ++k)
            model.materialUvs[model.indices[t * 3 + k]] = glm::vec2((float(t / 12) + 0.5f) / 96, 0.5f);
    const SurfaceData made = baked(model, 512);
    REQUIRE(made.coarser.size() >= 2);
    size_t before = made.indices.size();
    float error = 0;
    for (const CoarserMesh& mesh : made.coarser) {
        CAPTURE(mesh.indices.size() / 3);
        CHECK(mesh.indices.size() < before * 3 / 4);
        before = mesh.indices.size();
        CHECK(mesh.error >= error);
        error = mesh.error;
        std::map<std::array<float, 6>, bool> edges;
        for (size_t i = 0; i < mesh.indices.size(); i += 3) {
            const DrawVertex* corner[3];
            for (size_t k = 0; k < 3; ++k) corner[k] = &mesh.vertices[mesh.indices[i + k]];
            CHECK((corner[0]->uv == corner[1]->uv && corner[1]->uv == corner[2]->uv));
            for (size_t k = 0; k < 3; ++k) {
                const glm::vec3 a = corner[k]->position, b = corner[(k + 1) % 3]->position;
                edges[{a.x, a.y, a.z, b.x, b.y, b.z}] = true;
            }
        }
        for (const auto& [e, there] : edges) CHECK(edges.count({e[3], e[4], e[5], e[0], e[1], e[2]}) == 1);
        for (const DrawVertex& v : made.vertices) {
            float nearest = 1e30f;
            for (size_t i = 0; i < mesh.indices.size(); i += 3)
                nearest = std::min(nearest, distanceTo(mesh, i, v.position));
            REQUIRE(nearest <= mesh.error + 1e-5f);
        }
    }
}

TEST_CASE("a level's error is that of a bilinear read: a quarter with each doubling, none on a cube") {
    const SurfaceData round = baked(sphere(64), 512), flat = baked(cube(4), 256);
    for (const SurfaceLevelData& level : flat.levels) CHECK(level.error < 2e-6f);
    for (size_t l = 1; l < round.levels.size(); ++l) {
        CAPTURE(round.levels[l].size);
        // A sixth of the square holds 90 degrees: the sagitta of a texel's diagonal, or the mesh's own facets.
        const float side = float(M_PI / 2) * 3.2f / float(round.levels[l].size);
        CHECK(round.levels[l].error < side * side * 0.5f + 4e-4f);
        CHECK(round.levels[l].error >= round.levels[l - 1].error * 0.5f);
    }
}

TEST_CASE("a level can be used when its bytes have come, and is the same as in the whole file") {
    const SurfaceData made = baked(sphere(24), 256);
    File file("whole.glb"), part("part.glb");
    REQUIRE(writeSurface(made, file.path));
    auto bytes = readFile(file.path);
    REQUIRE(bytes);
    const uint32_t levels = uint32_t(made.levels.size());
    REQUIRE(levels >= 3);
    size_t before = bytes->size();
    for (uint32_t finest = 1; finest < levels; ++finest) {
        CAPTURE(finest);
        // The shortest beginning of the file that does.
        size_t low = 0, high = bytes->size();
        while (low + 1 < high) {
            const size_t middle = (low + high) / 2;
            REQUIRE(writeFile(part.path, std::span(*bytes).first(middle)));
            (readSurface(part.path, {.finestLevel = finest}) ? high : low) = middle;
        }
        CHECK(high < before);
        before = high;
        REQUIRE(writeFile(part.path, std::span(*bytes).first(high)));
        auto read = readSurface(part.path, {.finestLevel = finest});
        REQUIRE(read);
        CHECK(read->hash == made.hash);
        REQUIRE(read->levels.size() == levels - finest);
        for (uint32_t l = finest; l < levels; ++l) {
            const SurfaceLevelData &a = made.levels[l], &b = read->levels[l - finest];
            CHECK(levelHash(a) == levelHash(b));
            CHECK(std::memcmp(a.texels.data(), b.texels.data(), a.texels.size() * sizeof(Texel)) == 0);
        }
        for (const Chart& chart : read->charts) CHECK(chart.coarsestLevel < read->levels.size());
        CHECK(!read->indices.empty());
        CHECK(!readSurface(part.path));  // the whole isn't there
    }
    CHECK(readSurface(file.path, {.finestLevel = 99})->levels.size() == 1);
}
