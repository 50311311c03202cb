// Leaves, bark and pebbles have the forms that docs/scene_format.md states.

#include <doctest/doctest.h>
#include <cmath>

#include "tools/content/leaf.hpp"
#include "tools/content/leaf_shape.hpp"

using namespace espalier::content;

namespace {

size_t triangles(const Mesh& mesh) {
    return mesh.indices.size() / 3;
}

float flatArea(const Mesh& mesh) {
    float sum = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        glm::vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                  c = mesh.positions[mesh.indices[i + 2]];
        sum += std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    }
    return sum;
}

// Share of a variant's leaf, as its alpha shows it at `size` texels, that no triangle of the mesh covers.
float uncovered(const Mesh& mesh, int variant) {
    LeafShape shape = leafShape(variant);
    size_t inside = 0, missed = 0;
    for (int y = 0; y < 200; ++y)
        for (int x = 0; x < 200; ++x) {
            glm::vec2 p((static_cast<float>(x) - 99.5f) / 180.0f, (static_cast<float>(y) + 0.5f) / 200.0f);
            if (p.y < shape.base || leafDistance(shape, p) < 0.004f) continue;
            ++inside;
            glm::vec2 uv = leafUv(variant, p);
            bool hit = false;
            for (size_t i = 0; i < mesh.indices.size() && !hit; i += 3) {
                glm::vec2 a = mesh.uvs[mesh.indices[i]], b = mesh.uvs[mesh.indices[i + 1]],
                          c = mesh.uvs[mesh.indices[i + 2]];
                auto side = [&](glm::vec2 s, glm::vec2 t) {
                    return (t.x - s.x) * (uv.y - s.y) - (t.y - s.y) * (uv.x - s.x);
                };
                hit = side(a, b) <= 1e-7f && side(b, c) <= 1e-7f && side(c, a) <= 1e-7f;
            }
            missed += hit ? 0u : 1u;
        }
    return static_cast<float>(missed) / static_cast<float>(inside);
}

}  // namespace

TEST_CASE("leaves have the stated counts, length and frame") {
    for (int variant = 0; variant < kLeafVariants; ++variant)
        for (int lod = 0; lod < kLeafLods; ++lod) {
            CAPTURE(variant);
            CAPTURE(lod);
            Mesh leaf = makeLeaf(variant, lod);
            CHECK(triangles(leaf) == std::array<size_t, 4>{35, 10, 4, 1}[static_cast<size_t>(lod)]);
            float low = 1, high = 0, up = 0;
            for (size_t v = 0; v < leaf.positions.size(); ++v) {
                low = std::min(low, leaf.positions[v].y);
                high = std::max(high, leaf.positions[v].y);
                up += leaf.normals[v].z;
                CHECK(glm::length(leaf.normals[v]) == doctest::Approx(1).epsilon(1e-4));
                CHECK((leaf.uvs[v].x >= 0 && leaf.uvs[v].x <= 1 && leaf.uvs[v].y >= 0 && leaf.uvs[v].y <= 0.5f));
            }
            CHECK(low > -0.03f);
            CHECK(high > 0.90f);
            CHECK(high < 1.05f);
            CHECK(up / static_cast<float>(leaf.normals.size()) > 0.6f);
        }
}

TEST_CASE("a leaf's meshes hold its cut-out, and the finest wastes little") {
    for (int variant = 0; variant < kLeafVariants; ++variant) {
        CAPTURE(variant);
        CHECK(uncovered(makeLeaf(variant, 0), variant) < 0.002f);
        CHECK(uncovered(makeLeaf(variant, 1), variant) < 0.02f);
        CHECK(uncovered(makeLeaf(variant, 2), variant) < 0.25f);
        CHECK(uncovered(makeLeaf(variant, 3), variant) < 0.09f);
        LeafShape shape = leafShape(variant);
        float area = 0;
        for (size_t i = 0; i < shape.outline.size(); ++i) {
            glm::vec2 a = shape.outline[i], b = shape.outline[(i + 1) % shape.outline.size()];
            area += (a.x * b.y - a.y * b.x) / 2;
        }
        CHECK(area > 0.2f);
        CHECK(flatArea(makeLeaf(variant, 0)) < area * 1.25f);
    }
}

TEST_CASE("a leaf's alpha keeps its area over mip levels, and no dark fringe surrounds it") {
    LeafAtlas atlas = paintLeaves(512);
    Picture level = atlas.color;
    auto coverage = [](const Picture& p) {
        size_t solid = 0;
        for (size_t i = 3; i < p.rgba.size(); i += 4) solid += p.rgba[i] >= 128 ? 1u : 0u;
        return static_cast<double>(solid) / static_cast<double>(p.rgba.size() / 4);
    };
    double full = coverage(level);
    for (int mip = 1; mip <= 3; ++mip) {
        Picture half(level.width / 2, level.height / 2);
        for (int y = 0; y < half.height; ++y)
            for (int x = 0; x < half.width; ++x)
                for (int k = 0; k < 4; ++k) {
                    int sum = level.at(2 * x, 2 * y)[k] + level.at(2 * x + 1, 2 * y)[k] +
                              level.at(2 * x, 2 * y + 1)[k] + level.at(2 * x + 1, 2 * y + 1)[k];
                    half.at(x, y)[k] = static_cast<uint8_t>((sum + 2) / 4);
                }
        level = half;
        CHECK(coverage(level) == doctest::Approx(full).epsilon(0.04));
    }
    size_t dark = 0;
    for (int y = 0; y < atlas.color.height; ++y)
        for (int x = 0; x < atlas.color.width; ++x) {
            const uint8_t* c = atlas.color.at(x, y);
            if (c[3] > 0 && c[0] + c[1] + c[2] <= 40) ++dark;
        }
    CHECK(dark == 0);
}

TEST_CASE("ovals and blossoms lie as leaves do, and tufts stand") {
    for (int form : {kFirstOval, kFirstOval + 1, kBlossom})
        for (int lod = 0; lod < kFloraLods; ++lod) {
            CAPTURE(form);
            CAPTURE(lod);
            const Mesh mesh = makeFlora(form, lod);
            CHECK(triangles(mesh) == std::array<size_t, 3>{22, 10, 5}[static_cast<size_t>(lod)]);
            float high = 0, up = 0;
            for (size_t v = 0; v < mesh.positions.size(); ++v) {
                high = std::max(high, mesh.positions[v].y);
                up += mesh.normals[v].z;
                CHECK((mesh.uvs[v].x >= 0 && mesh.uvs[v].x <= 1 && mesh.uvs[v].y >= 0 && mesh.uvs[v].y <= 0.5f));
            }
            CHECK(high > 0.85f);
            CHECK(high < 1.1f);
            CHECK(up / static_cast<float>(mesh.normals.size()) > 0.6f);
            CHECK(uncovered(mesh, form) < 0.03f);
        }
    for (int lod = 0; lod < kFloraLods; ++lod) {
        const Mesh tuft = makeTuft(lod);
        CHECK(triangles(tuft) == std::array<size_t, 3>{6, 4, 2}[static_cast<size_t>(lod)]);
        for (const glm::vec3& n : tuft.normals) CHECK(n.y > 0.9f);
        CHECK(uncovered(tuft, kTuft) < 0.001f);
    }
}

TEST_CASE("the flora's forms fill their own parts of the atlas, each in its colour") {
    const LeafAtlas atlas = paintFlora(256);
    const auto meanOf = [&](int form) {
        const LeafShape shape = leafShape(form);
        glm::dvec3 sum(0);
        int count = 0;
        for (int y = 0; y < 128; ++y)
            for (int x = 64 * (form - kFirstOval); x < 64 * (form - kFirstOval + 1); ++x) {
                const uint8_t* c = atlas.color.at(x, y);
                if (c[3] < 160) continue;
                sum += glm::dvec3(c[0], c[1], c[2]);
                ++count;
                CHECK(leafDistance(shape, leafPoint(form, {(float(x) + 0.5f) / 256, (float(y) + 0.5f) / 256})) >
                      -0.02f);
            }
        REQUIRE(count > 200);
        return sum / double(count);
    };
    for (int form : {kFirstOval, kFirstOval + 1, kTuft}) {
        const glm::dvec3 green = meanOf(form);
        CHECK(green.g > 1.2 * green.r);
        CHECK(green.g > 1.2 * green.b);
    }
    const glm::dvec3 violet = meanOf(kBlossom);
    CHECK(violet.b > 1.2 * violet.g);
    CHECK(violet.r > violet.g);
}

TEST_CASE("backs of leaves are paler") {
    LeafAtlas atlas = paintLeaves(256);
    double front = 0, back = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x) {
            if (atlas.color.at(x, y)[3] < 200) continue;
            front += atlas.color.at(x, y)[1];
            back += atlas.color.at(x, y + 128)[1];
        }
    CHECK(back > front * 1.1);
}

TEST_CASE("bark is a unit tube of the stated counts") {
    for (int lod = 0; lod < kBarkLods; ++lod) {
        Mesh bark = makeBark(lod);
        CHECK(triangles(bark) == std::array<size_t, 3>{216, 48, 8}[static_cast<size_t>(lod)]);
        for (size_t v = 0; v < bark.positions.size(); ++v) {
            CHECK(glm::length(glm::vec2(bark.positions[v])) == doctest::Approx(1).epsilon(1e-5));
            CHECK(bark.uvs[v].y == doctest::Approx(1 - bark.positions[v].z));
        }
        for (size_t i = 0; i < bark.indices.size(); i += 3) {
            glm::vec3 a = bark.positions[bark.indices[i]], b = bark.positions[bark.indices[i + 1]],
                      c = bark.positions[bark.indices[i + 2]];
            CHECK(glm::dot(glm::cross(b - a, c - a), glm::vec3((a + b + c).x, (a + b + c).y, 0)) > 0);
        }
    }
}

TEST_CASE("bark and pebble textures tile") {
    for (const Tile& tile : {paintBark(128), paintPebble(128)}) {
        auto step = [&](bool wrap, bool vertical) {
            double sum = 0;
            for (int i = 0; i < 128; ++i) {
                int at = wrap ? 127 : 63, next = wrap ? 0 : 64;
                const uint8_t* a = vertical ? tile.color.at(i, at) : tile.color.at(at, i);
                const uint8_t* b = vertical ? tile.color.at(i, next) : tile.color.at(next, i);
                sum += std::abs(a[1] - b[1]);
            }
            return sum / 128;
        };
        CHECK(step(true, false) < 2.5 * step(false, false) + 4);
        CHECK(step(true, true) < 2.5 * step(false, true) + 4);
    }
}

TEST_CASE("pebbles are closed and face outwards") {
    for (int variant = 0; variant < kPebbleVariants; ++variant)
        for (int lod = 0; lod < kPebbleLods; ++lod) {
            Mesh pebble = makePebble(variant, lod);
            double volume = 0;
            for (size_t i = 0; i < pebble.indices.size(); i += 3)
                volume +=
                    glm::dot(pebble.positions[pebble.indices[i]], glm::cross(pebble.positions[pebble.indices[i + 1]],
                                                                             pebble.positions[pebble.indices[i + 2]])) /
                    6;
            CHECK(volume > 0.08);
            CHECK(volume < 0.5);
        }
}
