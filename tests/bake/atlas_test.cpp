// The atlas: which of the model's charts are kept, and what is made of the others. Judged by oracles of its own: areas,
// angles and texels are computed here from the surface's records, not by the baker's figures.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/bake/baking.hpp"
#include "tests/bake/kits.hpp"
#include "tests/bake/small_models.hpp"
#include "tests/support/data.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

double modelArea(const Model& model) {
    double area = 0;
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        glm::dvec3 p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = glm::dvec3(model.positions[model.indices[i + k]]);
        area += glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 2;
    }
    return area;
}

// What a surface's drawn triangles say of its atlas.
struct Atlas {
    double area = 0;          // of triangles that have a place in the atlas
    size_t mirrored = 0;      // triangles turned over in UV
    double stretch95 = 0;     // of the area: the worse of both directions against the mean scale of all
    size_t claimedTwice = 0;  // texel centres inside of two triangles
};

Atlas examine(const SurfaceData& s, int size) {
    Atlas out;
    std::vector<uint8_t> claims(size_t(size) * size_t(size), 0);
    struct Weighted {
        double most, least, area;  // metres per UV along the longest and the shortest direction
    };
    std::vector<Weighted> stretch;
    double uvArea = 0;
    for (size_t i = 0; i < s.indices.size(); i += 3) {
        glm::dvec3 p[3];
        glm::dvec2 u[3];
        for (size_t k = 0; k < 3; ++k) {
            p[k] = glm::dvec3(s.vertices[s.indices[i + k]].position);
            u[k] = glm::dvec2(s.vertices[s.indices[i + k]].walkUv);
        }
        glm::dvec2 a = u[1] - u[0], b = u[2] - u[0];
        double flat = (a.x * b.y - a.y * b.x) / 2, own = glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 2;
        if (flat == 0 || own == 0) continue;
        out.mirrored += flat < 0;
        out.area += own, uvArea += std::abs(flat);
        glm::dvec3 du = ((p[1] - p[0]) * b.y - (p[2] - p[0]) * a.y) / (2 * flat);
        glm::dvec3 dv = ((p[2] - p[0]) * a.x - (p[1] - p[0]) * b.x) / (2 * flat);
        double trace = glm::dot(du, du) + glm::dot(dv, dv), det = (own / flat) * (own / flat);
        double most = std::sqrt(trace / 2 + std::sqrt(std::max(trace * trace / 4 - det, 0.0)));
        stretch.push_back({most, std::abs(own / flat) / most, own});
        // Texel centres well inside of the triangle.
        for (int k = 0; k < 3; ++k) u[k] *= double(size);
        double sign = flat > 0 ? 1 : -1;
        glm::dvec2 low = glm::min(glm::min(u[0], u[1]), u[2]), high = glm::max(glm::max(u[0], u[1]), u[2]);
        for (int y = int(low.y); y <= int(high.y) && y < size; ++y)
            for (int x = int(low.x); x <= int(high.x) && x < size; ++x) {
                glm::dvec2 c(x + 0.5, y + 0.5);
                bool inside = true;
                for (int k = 0; k < 3; ++k) {
                    glm::dvec2 e = u[(k + 1) % 3] - u[k], d = c - u[k];
                    inside = inside && sign * (e.x * d.y - e.y * d.x) > 1e-4 * glm::length(e);
                }
                if (inside && ++claims[size_t(y) * size_t(size) + size_t(x)] == 2) ++out.claimedTwice;
            }
    }
    double scale = std::sqrt(out.area / uvArea), sum = 0;
    auto worse = [&](const Weighted& w) { return std::max(w.most / scale, scale / w.least); };
    std::sort(stretch.begin(), stretch.end(),
              [&](const Weighted& a, const Weighted& b) { return worse(a) < worse(b); });
    for (const Weighted& w : stretch)
        if ((sum += w.area) <= 0.95 * out.area) out.stretch95 = worse(w);
    return out;
}

void checkAtlas(const Model& model, const Baked& baked) {
    CAPTURE(model.name);
    Atlas atlas = examine(baked.surface, int(baked.surface.levels[0].size));
    CHECK(atlas.area >= 0.995 * modelArea(model));
    CHECK(atlas.claimedTwice == 0);
    CHECK(atlas.stretch95 <= 1.5);
    CHECK(baked.report.overlaps == 0);
    CHECK(baked.report.danglingCrossings <= 0.001 * (baked.report.seamCrossings + baked.report.nearestCrossings));
}

double shareOf(const BakeReport& report, const char* cause) {
    for (const UvFate& fate : report.uvs)
        if (fate.cause == cause) return fate.area;
    return 0;
}

// Closed, smooth, of genus 0 or 1.
Model withoutUvs(Model model) {
    model.uvs.clear();
    return model;
}
Model sphere(int n) {
    Model model = withoutUvs(cube(n));
    model.name = "sphere";
    for (glm::vec3& p : model.positions) p = glm::normalize(p);
    return model;
}
Model torus(int n) {
    Model model;
    model.name = "torus";
    auto round = [](float s, float& c, float& d) {
        float a = s >= 1 ? 0.0f : s * 6.2831853f;
        c = std::cos(a), d = std::sin(a);
    };
    addPatch(
        model, n,
        [&](float s, float t) {
            float a, b, c, d;
            round(s, a, b), round(t, c, d);
            return glm::vec3((2 + 0.7f * c) * a, 0.7f * d, -(2 + 0.7f * c) * b);
        },
        [](float, float) { return glm::vec2(0); });
    return withoutUvs(model);
}

}  // namespace

TEST_CASE("models without UVs get charts: all area, no overlap, little stretch, nothing mirrored") {
    for (const Model& model : {withoutUvs(cube(4)), withoutUvs(cylinder(32)), sphere(16), torus(24),
                               withoutUvs(openQuad(3)), withoutUvs(openQuad(1))}) {
        Baked baked = bakeOrFail(model);
        checkAtlas(model, baked);
        CHECK(examine(baked.surface, 256).mirrored == 0);
        CHECK(baked.report.madeCharts == baked.report.charts);
        CHECK(shareOf(baked.report, "without UVs") == doctest::Approx(1));
        CHECK(baked.report.charts <= 12);
    }
}

TEST_CASE("what is developable is unfolded without any stretch") {
    for (const Model& model : {withoutUvs(cube(3)), withoutUvs(cylinder(48)), withoutUvs(openQuad(5))}) {
        Baked baked = bakeOrFail(model);
        CHECK(baked.report.stretchMax == doctest::Approx(1).epsilon(0.005));
    }
}

TEST_CASE("good charts of the model's are kept, the others are made anew, and the report says why") {
    Model missing = cube(4);
    for (size_t i = 0; i < 25; ++i) missing.uvs[i].x = std::numeric_limits<float>::quiet_NaN();
    Model collapsed = cube(4);
    for (size_t i = 0; i < 25; ++i) collapsed.uvs[i] = glm::vec2(0.5f);
    Model stretched = cube(4);
    for (size_t i = 0; i < 25; ++i) stretched.uvs[i].x = 0.05f + (stretched.uvs[i].x - 0.05f) * 0.1f;
    Model folded = cube(4);
    folded.uvs[12] += glm::vec2(0.1f, 0);
    struct Case {
        const Model& model;
        const char* cause;
    };
    for (const Case& c : {Case{missing, "without UVs"},
                          {collapsed, "collapsed to points or lines"},
                          {stretched, "stretched"},
                          {folded, "folded"}}) {
        CAPTURE(c.cause);
        Baked baked = bakeOrFail(c.model);
        checkAtlas(c.model, baked);
        CHECK(shareOf(baked.report, c.cause) == doctest::Approx(1.0 / 6).epsilon(1e-3));
        CHECK(shareOf(baked.report, "kept") == doctest::Approx(5.0 / 6).epsilon(1e-3));
        CHECK(baked.report.charts == 6);
        CHECK(baked.report.madeCharts == 1);
        CHECK(!baked.report.layoutKept);
    }
    Baked good = bakeOrFail(cube(4));
    CHECK(good.report.layoutKept);
    CHECK(good.report.madeCharts == 0);
}

// A wall of stones that stand out, or lie deeper, each by its own measure; UVs are those of the flat wall.
Model stoneWall(float relief) {
    Model wall;
    wall.name = "wall";
    constexpr int kCells = 96, kStones = 12;
    addPatch(
        wall, kCells,
        [&](float s, float t) {
            const float x = s * kStones, y = t * kStones;
            const int column = int(x + 0.5f * float(int(y) % 2)), row = int(y);
            const uint32_t number = uint32_t(column * 31 + row * 57) * 2654435761u;
            const float edge = std::min(std::abs(std::sin(3.14159265f * (x + 0.5f * float(row % 2)))),
                                        std::abs(std::sin(3.14159265f * y)));
            const float out = std::min(1.0f, edge * 1.5f) * (0.4f + 0.6f * float(number >> 8) / 16777216.0f);
            return glm::vec3(s, t, relief * out) * 4.0f;
        },
        [](float s, float t) { return glm::vec2(0.1f + 0.8f * s, 0.1f + 0.8f * t); });
    return wall;
}

TEST_CASE("a wall whose stones stretch its UVs somewhat too much is still one chart") {
    for (float relief : {0.02f, 0.03f, 0.04f, 0.05f}) {
        CAPTURE(relief);
        Model model = stoneWall(relief);
        Baked baked = bakeOrFail(model);
        checkAtlas(model, baked);
        CHECK(baked.report.charts == 1);
    }
}

TEST_CASE("charts that lie over each other or tile keep their shape and get a place of their own") {
    Model over = cube(4), tiled = cube(4);
    for (size_t i = 0; i < over.uvs.size(); ++i) {
        over.uvs[i] = over.uvs[i % 25];
        tiled.uvs[i] *= 12.0f;
    }
    for (const Model& model : {over, tiled}) {
        Baked baked = bakeOrFail(model);
        checkAtlas(model, baked);
        CHECK(baked.report.charts == 6);
        CHECK(shareOf(baked.report, "kept") == doctest::Approx(1));
    }
}

TEST_CASE("copies of triangles and small fins are left out, a sheet with two sides is not") {
    Model doubled = withoutUvs(openQuad(4));
    size_t count = doubled.indices.size();
    for (size_t i = 0; i < count; i += 3)
        for (size_t k : {0, 2, 1}) doubled.indices.push_back(doubled.indices[i + k]);
    CHECK(bakeOrFail(doubled).report.triangles == 64);
    Model twice = withoutUvs(openQuad(4));
    for (size_t i = 0; i < count; ++i) twice.indices.push_back(twice.indices[i]);
    CHECK(bakeOrFail(twice).report.triangles == 32);
    Model finned = withoutUvs(openQuad(4));
    finned.positions.push_back(finned.positions[6] + glm::vec3(0.004f, 0, 0.004f));
    uint32_t tip = uint32_t(finned.positions.size() - 1);
    finned.indices.insert(finned.indices.end(), {6, 7, tip, 7, 6, tip});
    finned.positions[tip] = (finned.positions[6] + finned.positions[7]) / 2.0f + glm::vec3(0, 0, 2e-4f);
    CHECK(bakeOrFail(finned).report.triangles == 32);
}

TEST_CASE("real models without usable UVs get an atlas within the promised figures") {
    struct Case {
        const char* file;
        uint32_t mostCharts;
    };
    for (const Case& c : {Case{"derived/bunny.glb", 53},
                          {"models/quaternius/House_3.glb", 2200},
                          {"models/kaykit_dungeon/wall.glb", 250},
                          {"models/quaternius/WallBricks.glb", 200}}) {
        auto path = dataFile(c.file);
        if (!path) continue;
        auto model = importModel(*path);
        if (!model) FAIL(model.failure().text());
        Baked baked = bakeOrFail(*model, 1024);
        checkAtlas(*model, baked);
        CHECK(baked.report.charts <= c.mostCharts);
    }
}

TEST_CASE("painted weights give charts their share of texels a metre, and nothing overlaps") {
    Kit kit;
    kit.box({0, 0, 0}, {1, 1, 1});
    BakeOptions options;
    options.resolution = 256;
    options.weights = {64, 64, std::vector<float>(64 * 64, 0.25f)};
    // The panel towards +x is white, that towards -x black.
    const glm::dvec2 low[2] = {kit.uv(0, 0, 0), kit.uv(1, 0, 0)}, high[2] = {kit.uv(0, 1, 1), kit.uv(1, 1, 1)};
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            for (int k = 0; k < 2; ++k) {
                const glm::dvec2 p((x + 0.5) / 64, (y + 0.5) / 64);
                if (glm::all(glm::greaterThan(p, low[k] - 0.03)) && glm::all(glm::lessThan(p, high[k] + 0.03)))
                    options.weights.texels[size_t(y) * 64 + size_t(x)] = k == 0 ? 1.0f : 0.0f;
            }
    Model model = kit.model();
    auto baked = bake(model, options);
    if (!baked) FAIL(baked.failure().text());
    CHECK(baked->report.overlaps == 0);
    CHECK(baked->report.stretch95 < 1.01);
    REQUIRE(baked->surface.charts.size() == 6);
    double side[3] = {0, 0, 0};  // metres per UV: +x, -x, one of the others
    for (const TrianglePlane& t : baked->surface.triangles) {
        const glm::vec3 n = glm::normalize(glm::cross(t.du, t.dv)) * baked->surface.charts[t.chart].orientation;
        side[n.x > 0.9f ? 0 : n.x < -0.9f ? 1 : 2] = baked->surface.charts[t.chart].metresPerUv;
    }
    CHECK(side[2] / side[0] == doctest::Approx(4).epsilon(0.02));
    CHECK(side[1] / side[0] == doctest::Approx(8).epsilon(0.02));
    options.keepLayout = true;
    CHECK(!bake(model, options));
    options.keepLayout = false;
    model.uvs.clear();
    CHECK(!bake(model, options));
}
