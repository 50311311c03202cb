// What stands, as parts, beside what espMaterialise says of the same.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/export/scene_parts.hpp"

namespace {

struct Flat {
    float u[3], v[3];
    float low() const { return std::min({v[0], v[1], v[2]}); }
    float high() const { return std::max({v[0], v[1], v[2]}); }
};

// A little smaller about its middle, so that neighbours don't touch.
Flat flatOf(const EspPartLevel& level, uint32_t triangle) {
    Flat f{};
    for (int k = 0; k < 3; ++k) {
        const EspPartVertex& v = level.vertices[level.indices[3 * triangle + uint32_t(k)]];
        f.u[k] = v.uv2[0], f.v[k] = v.uv2[1];
    }
    const float u = (f.u[0] + f.u[1] + f.u[2]) / 3, v = (f.v[0] + f.v[1] + f.v[2]) / 3;
    for (int k = 0; k < 3; ++k) f.u[k] += .01f * (u - f.u[k]), f.v[k] += .01f * (v - f.v[k]);
    return f;
}

// No side of either has the other beyond it.
bool overlap(const Flat& a, const Flat& b) {
    for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            const auto side = [&](float u, float v) {
                return (double(one->u[j]) - one->u[i]) * (double(v) - one->v[i]) -
                       (double(one->v[j]) - one->v[i]) * (double(u) - one->u[i]);
            };
            const double inner = side(one->u[k], one->v[k]);
            if (inner == 0) return false;
            bool beyond = true;
            for (int n = 0; n < 3; ++n) beyond = beyond && side(other->u[n], other->v[n]) * inner <= 0;
            if (beyond) return false;
        }
    return true;
}

// What is thinner covers nothing: that is what single precision can tell apart in the unit square.
constexpr double kLeastThickness = 4e-7;
double thicknessOf(const Flat& f) {
    double longest = 0;
    for (int i = 0; i < 3; ++i)
        longest = std::max(longest, std::hypot(double(f.u[(i + 1) % 3]) - f.u[i], double(f.v[(i + 1) % 3]) - f.v[i]));
    const double area =
        (double(f.u[1]) - f.u[0]) * (double(f.v[2]) - f.v[0]) - (double(f.v[1]) - f.v[0]) * (double(f.u[2]) - f.u[0]);
    return longest > 0 ? std::abs(area) / longest : 0;
}

// Pairs of triangles that overlap in the second set of UVs: each with all that share some of its rows.
size_t overlaps(const EspPartLevel& level) {
    std::vector<Flat> all;
    for (uint32_t t = 0; 3 * t < level.indexCount; ++t)
        if (const Flat f = flatOf(level, t); thicknessOf(f) > kLeastThickness) all.push_back(f);
    std::ranges::sort(all, {}, &Flat::low);
    size_t found = 0;
    for (size_t i = 0; i < all.size(); ++i)
        for (size_t j = i + 1; j < all.size() && all[j].low() < all[i].high(); ++j)
            found += overlap(all[i], all[j]) ? 1 : 0;
    return found;
}

uint64_t materialised(EspContext* context) {
    EspTriangles triangles;
    REQUIRE_MESSAGE(espMaterialise(context, &triangles) == ESP_OK, espLastError(context));
    uint64_t count = 0;
    for (uint64_t i = 0; i < triangles.indexCount; i += 3)  // empty ones lie between blocks
        count += triangles.indices[i] != triangles.indices[i + 1] ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("parts at full detail have as many triangles as espMaterialise writes") {
    for (const std::string name : {"guided.json", "hamlet.json"}) {
        CAPTURE(name);
        GrownScene scene(name.c_str());
        const EspPartsInfo info = scene.parts(0, 1);
        CHECK(info.triangles > 100'000);
        CHECK(info.triangles == materialised(scene.context));
    }
}

TEST_CASE("the check of overlaps finds one") {
    EspPartVertex corners[6] = {};
    const float at[6][2] = {{0, 0}, {1, 0}, {0, 1}, {.2f, .2f}, {1, .9f}, {.9f, 1}};
    for (int i = 0; i < 6; ++i) corners[i].uv2[0] = at[i][0], corners[i].uv2[1] = at[i][1];
    const uint32_t indices[] = {0, 1, 2, 3, 4, 5};
    EspPartLevel level;
    level.vertices = corners, level.vertexCount = 6, level.indices = indices, level.indexCount = 6;
    CHECK(overlaps(level) == 1);
    corners[3].uv2[0] = corners[3].uv2[1] = .8f;
    CHECK(overlaps(level) == 0);
}

TEST_CASE("second UVs lie in the unit square and nowhere on each other") {
    for (const char* name : {"guided.json", "hamlet.json", "patterns.json"}) {
        GrownScene scene(name);
        const EspPartsInfo info = scene.parts();
        for (uint32_t i = 0; i < info.parts; ++i) {
            const EspPartInfo part = scene.part(i);
            for (uint32_t number = 0; number < part.levels; ++number) {
                const EspPartLevel level = scene.level(i, number);
                const bool within = std::all_of(level.vertices, level.vertices + level.vertexCount, [](auto& v) {
                    return v.uv2[0] >= 0 && v.uv2[0] <= 1 && v.uv2[1] >= 0 && v.uv2[1] <= 1;
                });
                const std::string of = std::string(name) + " " + part.name;
                CAPTURE(of);
                CAPTURE(number);
                CHECK(within);
                CHECK(overlaps(level) == 0);
            }
        }
    }
}

TEST_CASE("coarser levels have fewer triangles, and stems move the more the nearer to their tips") {
    GrownScene scene("guided.json");
    const EspPartsInfo info = scene.parts();
    uint32_t plants = 0, leaves = 0;
    for (uint32_t i = 0; i < info.parts; ++i) {
        const EspPartInfo part = scene.part(i);
        for (uint32_t level = 1; level < part.levels; ++level)
            CHECK(scene.level(i, level).indexCount < scene.level(i, level - 1).indexCount);
        leaves += part.kind == ESP_PART_LEAF ? part.instances : 0;
        if (part.kind != ESP_PART_STEMS) continue;
        ++plants;
        const EspPartLevel finest = scene.level(i, 0);
        const auto byWind = [](const EspPartVertex& a, const EspPartVertex& b) { return a.wind < b.wind; };
        const auto [least, most] = std::minmax_element(finest.vertices, finest.vertices + finest.vertexCount, byWind);
        CHECK(least->wind == 0);
        CHECK(least->age == 1);
        CHECK(most->wind == 1);
        const auto byAge = [](const EspPartVertex& a, const EspPartVertex& b) { return a.age < b.age; };
        CHECK(std::min_element(finest.vertices, finest.vertices + finest.vertexCount, byAge)->age < .05f);
    }
    EspStats stats;
    REQUIRE(espReadStats(scene.context, &stats) == ESP_OK);
    CHECK(plants == stats.seeds);
    CHECK(leaves == stats.leaves);
}

TEST_CASE("parts that aren't there are refused") {
    GrownScene scene("patterns.json");
    const EspPartsInfo info = scene.parts();
    EspPatternStats patterns;
    REQUIRE(espPatternStats(scene.context, &patterns) == ESP_OK);
    CHECK(info.instances == patterns.pieces);
    EspPartInfo part;
    CHECK(espPartInfo(scene.context, info.parts, &part) == ESP_INVALID_ARGUMENT);
    EspPartLevel level;
    CHECK(espPartLevel(scene.context, 0, 99, &level) == ESP_INVALID_ARGUMENT);
    EspPartsDef def = esp::defaults<EspPartsDef>();
    def.stemLevels = 0;
    EspPartsInfo none;
    CHECK(espReadParts(scene.context, &def, &none) == ESP_INVALID_ARGUMENT);
    CHECK(scene.part(0).instances > 0);  // what was gathered stays
}
