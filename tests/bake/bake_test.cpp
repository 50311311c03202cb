// Small surfaces against what is known of them by construction: classes, planes, crossings, clearance, curvature.
#include "tools/bake/bake.hpp"
#include "tests/bake/baking.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "shaders/shared/exact.h"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

std::string refusal(const Model& model, BakeOptions options = {}) {
    auto baked = bake(model, options);
    return baked ? std::string("baked") : baked.failure().text();
}

bool mentions(const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
}

// The four texels of a bilinear read at uv must belong to the chart: the promise that walks rely on.
size_t foreignReads(const SurfaceData& surface) {
    size_t bad = 0;
    for (uint32_t l = 0; l < surface.levels.size(); ++l) {
        const SurfaceLevelData& level = surface.levels[l];
        for (const TrianglePlane& t : surface.triangles) {
            if (surface.charts[t.chart].coarsestLevel < l) continue;
            // Corners of triangles are the chart's outermost points.
            glm::vec2 p = t.uv0 * float(level.size) - 0.5f;
            for (int k = 0; k < 4; ++k) {
                int x = int(std::floor(p.x)) + (k & 1), y = int(std::floor(p.y)) + (k >> 1);
                if (x < 0 || y < 0 || x >= int(level.size) || y >= int(level.size)) {
                    ++bad;
                    continue;
                }
                uint bits = level.texels[texelIndex(level.size, uint32_t(x), uint32_t(y))].bits;
                // At a whole texel the read's far side has no weight.
                glm::vec2 weight = glm::abs(p - glm::vec2(float(x), float(y)));
                if (weight.x >= 0.999f || weight.y >= 0.999f) continue;
                bad += texelClass(bits) == kTexelEmpty || texelChart(bits) != t.chart;
            }
        }
    }
    return bad;
}

float toSegment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
    glm::vec2 d = b - a;
    return glm::length(p - a - d * glm::clamp(glm::dot(p - a, d) / glm::dot(d, d), 0.0f, 1.0f));
}

}  // namespace

TEST_CASE("a cube with a chart a face: six charts, exact planes, seams on all twelve edges") {
    Baked baked = bakeOrFail(cube(4));
    const SurfaceData& s = baked.surface;
    CHECK(baked.report.charts == 6);
    CHECK(baked.report.triangles == 192);
    CHECK(baked.report.seamCrossings == 12 * 2 * 4);
    CHECK(baked.report.danglingCrossings == 0);
    CHECK(baked.report.openTexels == 0);
    CHECK(baked.report.walkableArea == doctest::Approx(24).epsilon(1e-6));
    CHECK(baked.report.stretchMax == doctest::Approx(1).epsilon(1e-4));
    CHECK(baked.report.warnings.empty());
    CHECK(foreignReads(s) == 0);
    for (const SurfaceLevelData& level : s.levels)
        for (size_t i = 0; i < level.texels.size(); ++i) {
            if (texelClass(level.texels[i].bits) != kTexelInner) continue;
            glm::vec3 p = level.texels[i].position, n = unpackOct(level.aux[i].normal);
            float outward = glm::dot(n, p);
            REQUIRE(outward == doctest::Approx(1).epsilon(1e-3));
            REQUIRE(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) == doctest::Approx(1).epsilon(1e-5));
        }
}

TEST_CASE("crossings lead to the same point and back, and their inside is where they say") {
    for (const Model& model : {cube(3), cube(3, 0b010110), cubeCross(3), cylinder(24)}) {
        CAPTURE(model.name);
        Baked baked = bakeOrFail(model);
        const SurfaceData& s = baked.surface;
        CHECK(baked.report.roundTrip999 <= 0.05);
        CHECK(baked.report.gap999 <= 0.1);
        CHECK(baked.report.danglingCrossings == 0);
        CHECK(foreignReads(s) == 0);
        for (const Crossing& c : s.crossings) {
            if ((c.flags & 3u) == kCrossingOpen) continue;
            // The record there that leads back is the mirror image of this one.
            bool found = false;
            for (const Crossing& d : s.crossings)
                found = found || (glm::length(d.a - c.tb) < 1e-6f && glm::length(d.b - c.ta) < 1e-6f &&
                                  glm::length(d.ta - c.b) < 1e-6f);
            REQUIRE(found);
        }
        // A step inward from a border's middle is in the chart; outward it is not, on the finest level.
        const SurfaceLevelData& level = s.levels[0];
        for (uint32_t i = 0; i < level.texels.size(); ++i) {
            uint32_t head = level.crossingHead[i];
            for (uint32_t k = 0; k < (head & 255u); ++k) {
                const Crossing& c = s.crossings[level.crossingRefs[(head >> 8) + k]];
                glm::vec2 along = glm::normalize(c.b - c.a), left(-along.y, along.x);
                glm::vec2 inward = (c.flags & 4u) ? left : -left;
                glm::vec2 p = (c.a + c.b) / 2.0f + inward * (1.5f / float(level.size));
                uint32_t at =
                    texelIndex(level.size, uint32_t(p.x * float(level.size)), uint32_t(p.y * float(level.size)));
                REQUIRE(texelClass(level.texels[at].bits) == kTexelInner);
            }
        }
    }
}

TEST_CASE("mirrored charts have orientation -1 and normals that point outward") {
    Baked baked = bakeOrFail(cube(2, 0b000101));
    int mirrored = 0;
    for (const Chart& c : baked.surface.charts) {
        mirrored += c.orientation < 0;
        const TrianglePlane& t = baked.surface.triangles[c.firstTriangle];
        glm::vec3 n = glm::cross(t.du, t.dv) * c.orientation;
        CHECK(glm::dot(n, t.position) > 0);
    }
    CHECK(mirrored == 2);
}

TEST_CASE("a chart that was cut leads to itself; a cross-shaped chart has creases") {
    Baked round = bakeOrFail(cylinder(32));
    CHECK(round.report.charts == 1);
    CHECK(round.report.seamCrossings == 64);
    CHECK(round.report.openTexels > 0);
    Baked cross = bakeOrFail(cubeCross(4));
    CHECK(cross.report.charts == 1);
    CHECK(cross.report.seamCrossings == 7 * 2 * 4);
    size_t creases = 0;
    for (const Texel& t : cross.surface.levels[0].texels)
        if (texelCrease(t.bits)) {
            ++creases;
            // Two coordinates of a point beside a cube's edge are near 1.
            int far = 0;
            for (int k = 0; k < 3; ++k) far += std::abs(t.position[k]) > 0.9f;
            REQUIRE(far >= 2);
        }
    CHECK(creases > 100);
}

TEST_CASE("clearance never reaches a border") {
    Baked baked = bakeOrFail(cubeCross(2));
    for (const SurfaceLevelData& level : baked.surface.levels) {
        float size = float(level.size);
        uint32_t most = 0;
        for (uint32_t y = 0; y < level.size; ++y)
            for (uint32_t x = 0; x < level.size; ++x) {
                uint bits = level.texels[texelIndex(level.size, x, y)].bits;
                if (texelClass(bits) != kTexelInner) continue;
                glm::vec2 p = glm::vec2(float(x), float(y)) + 0.5f;
                float nearest = 1e9f;
                for (const Crossing& c : baked.surface.crossings)
                    nearest = std::min(nearest, toSegment(p, c.a * size, c.b * size));
                // From the texel's farthest corner the circle still misses the border.
                REQUIRE(float(texelClearance(bits)) <= nearest + 1e-3f);
                most = std::max(most, texelClearance(bits));
            }
        if (level.size == 256) CHECK(most >= 15);
    }
}

TEST_CASE("an open quad ends at its border, a T-junction and a crack don't") {
    Baked quad = bakeOrFail(openQuad(2));
    CHECK(quad.report.seamCrossings == 0);
    CHECK(quad.report.nearestCrossings == 0);
    CHECK(quad.report.linkTexels == 0);
    CHECK(quad.report.openTexels > 0);
    for (const Crossing& c : quad.surface.crossings) CHECK((c.flags & 3u) == kCrossingOpen);

    // Two strips side by side whose shared border is divided unlike, a hair apart.
    Model model;
    model.name = "strips";
    addPatch(
        model, 2, [](float s, float t) { return glm::vec3(s, t, 0); },
        [](float s, float t) { return glm::vec2(0.05f, 0.2f) + glm::vec2(s, t) * 0.4f; });
    addPatch(
        model, 3, [](float s, float t) { return glm::vec3(1.0005f + s, t, 0); },
        [](float s, float t) { return glm::vec2(0.55f, 0.2f) + glm::vec2(s, t) * 0.4f; });
    Baked strips = bakeOrFail(model);
    // Borders at 0, 1/3, 1/2, 2/3, 1: four pieces, there and back.
    CHECK(strips.report.nearestCrossings == 8);
    CHECK(strips.report.danglingCrossings == 0);
    double linked = 0;
    for (const Crossing& c : strips.surface.crossings)
        if ((c.flags & 3u) == kCrossingNearest) linked += glm::length(c.b - c.a) * strips.surface.charts[0].metresPerUv;
    CHECK(linked == doctest::Approx(2).epsilon(1e-3));
}

TEST_CASE("curvature of a sphere is one over its radius, positive; inside out it is negative") {
    for (float radius : {0.5f, 4.0f})
        for (bool inward : {false, true}) {
            Model model = cube(24);
            for (glm::vec3& p : model.positions) p = glm::normalize(p) * radius;
            if (inward) {  // by its normals too: without, its faces would be turned
                for (size_t i = 0; i < model.indices.size(); i += 3) std::swap(model.indices[i], model.indices[i + 1]);
                for (glm::vec3 p : model.positions) model.normals.push_back(-p / radius);
            }
            Baked baked = bakeOrFail(model, 128);
            float boundsRadius = surfaceRef(baked.surface).radius;
            double sum = 0, count = 0;
            for (const Texel& t : baked.surface.levels[0].texels)
                if (texelClass(t.bits) == kTexelInner) sum += decodeCurvature(t.bits, 1 / boundsRadius), count += 1;
            CHECK(sum / count == doctest::Approx((inward ? -1 : 1) / radius).epsilon(0.08));
        }
}

TEST_CASE("charts are moved apart when their gutters are too narrow, and keep their shape") {
    Model tight = cube(2);
    for (size_t i = 0; i < tight.uvs.size(); ++i) {
        size_t f = i / 9;
        glm::vec2 local = (tight.uvs[i] - glm::vec2(0.05f + 0.33f * float(f % 3), 0.1f + 0.45f * float(f / 3))) / 0.25f;
        tight.uvs[i] = (glm::vec2(float(f % 3), float(f / 3)) + local) / 3.0f;  // wall to wall
    }
    Baked moved = bakeOrFail(tight, 512);
    for (const Chart& c : moved.surface.charts) CHECK(c.coarsestLevel == moved.surface.levels.size() - 1);
    CHECK(foreignReads(moved.surface) == 0);
    float scale = moved.surface.charts[0].metresPerUv;
    for (const Chart& c : moved.surface.charts) {
        CHECK(c.metresPerUv == doctest::Approx(scale).epsilon(1e-4));
        glm::vec2 size = c.uvMax - c.uvMin;
        CHECK(size.x == doctest::Approx(size.y).epsilon(1e-4));
    }
    Baked kept = bakeOrFail(tight, 512, true);
    CHECK(kept.surface.charts[0].uvMin.x == doctest::Approx(0));
}

TEST_CASE("broken models are refused with a message") {
    Model nan = cube(1);
    nan.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    CHECK(mentions(refusal(nan), "not a number"));
    Model far = cube(1);
    for (glm::vec3& p : far.positions) p = p * 1e-3f + 1e7f;
    CHECK(refusal(far) != "baked");
    Model flat = cube(1);
    for (glm::vec3& p : flat.positions) p = glm::vec3(1, 2, 3);
    CHECK(refusal(flat) != "baked");
    Model line = cube(1);
    for (glm::vec3& p : line.positions) p = glm::vec3(p.x, p.x, p.x);
    CHECK(refusal(line) != "baked");
    Model wild = cube(1);
    wild.indices[5] = 1u << 30;
    CHECK(mentions(refusal(wild), "index"));
    Model empty;
    CHECK(refusal(empty) != "baked");
    BakeOptions odd;
    for (uint32_t resolution : {0u, 63u, 100u, 1u << 20}) {
        odd.resolution = resolution;
        CHECK(mentions(refusal(cube(1), odd), "resolution"));
    }
}

TEST_CASE("degenerate triangles are left out and told of") {
    Model model = openQuad(16);
    model.indices.insert(model.indices.end(), {0, 0, 5});
    Baked baked = bakeOrFail(model);
    CHECK(baked.report.triangles == 512);
    bool degenerate = false;
    for (const Diagnostic& d : baked.report.warnings) degenerate = degenerate || mentions(d.message, "without area");
    CHECK(degenerate);
}

TEST_CASE("baking twice gives the same bits") {
    Baked a = bakeOrFail(cubeCross(5)), b = bakeOrFail(cubeCross(5));
    CHECK(a.surface.hash == b.surface.hash);
    CHECK(a.surface.hash != 0);
    Baked c = bakeOrFail(cubeCross(6));
    CHECK(a.surface.hash != c.surface.hash);
}
