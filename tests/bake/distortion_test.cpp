// The report's distortion and its share in charts against sums of our own: singular values of the maps from the drawn
// mesh's UVs to its triangles, laid flat.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "tests/bake/baking.hpp"
#include "tests/bake/small_models.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec2;
using glm::dvec3;

namespace {

struct Piece {
    double area, areaUv, most, least;  // m², UV², metres per unit of UV
    uint32_t chart;
};

uint32_t chartAt(const SurfaceData& surface, dvec2 uv) {
    for (uint32_t c = 0; c < surface.charts.size(); ++c) {
        const Chart& chart = surface.charts[c];
        if (uv.x > chart.uvMin.x && uv.y > chart.uvMin.y && uv.x < chart.uvMax.x && uv.y < chart.uvMax.y) return c;
    }
    FAIL("a triangle lies in no chart");
    return 0;
}

std::vector<Piece> piecesOf(const SurfaceData& surface) {
    std::vector<Piece> pieces;
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
        const DrawVertex* v[3];
        for (size_t k = 0; k < 3; ++k) v[k] = &surface.vertices[surface.indices[i + k]];
        const dvec3 e(v[1]->position - v[0]->position), f(v[2]->position - v[0]->position);
        const dvec2 u(v[1]->walkUv - v[0]->walkUv), w(v[2]->walkUv - v[0]->walkUv);
        const double turn = u.x * w.y - u.y * w.x, area = glm::length(glm::cross(e, f)) / 2;
        if (turn == 0 || area == 0) continue;
        // The triangle laid flat: e along x.
        const double ex = glm::length(e), fx = glm::dot(e, f) / ex, fy = 2 * area / ex;
        const double a = (ex * w.y - fx * u.y) / turn, b = (fx * u.x - ex * w.x) / turn;
        const double c = -fy * u.y / turn, d = fy * u.x / turn;
        const double sum = std::hypot(a + d, b - c), difference = std::hypot(a - d, b + c);
        pieces.push_back({area, std::abs(turn) / 2, (sum + difference) / 2, std::abs(sum - difference) / 2,
                          chartAt(surface, dvec2(v[0]->walkUv + v[1]->walkUv + v[2]->walkUv) / 3.0)});
    }
    return pieces;
}

// The least value that at least `share` of the area doesn't exceed.
double quantile(std::vector<std::pair<double, double>> values, double share) {
    std::sort(values.begin(), values.end());
    double all = 0, sum = 0;
    for (const auto& [value, area] : values) all += area;
    for (const auto& [value, area] : values)
        if ((sum += area) >= share * all) return value;
    return values.back().first;
}

void compare(const Model& model, const Baked& baked) {
    const std::vector<Piece> pieces = piecesOf(baked.surface);
    std::map<uint32_t, dvec2> areas;  // per chart: in space and in UV
    double inCharts = 0, all = 0;
    for (const Piece& p : pieces) areas[p.chart] += dvec2(p.area, p.areaUv), inCharts += p.area;
    for (size_t i = 0; i + 2 < model.indices.size(); i += 3) {
        const dvec3 a(model.positions[model.indices[i]]), b(model.positions[model.indices[i + 1]]),
            c(model.positions[model.indices[i + 2]]);
        all += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    CHECK(baked.report.charted == doctest::Approx(inCharts / all).epsilon(1e-3));
    std::vector<std::pair<double, double>> worst, ofArea, ofAngle;
    for (const Piece& p : pieces) {
        const double scale = std::sqrt(areas[p.chart].x / areas[p.chart].y), most = p.most / scale,
                     least = p.least / scale;
        worst.emplace_back(std::max(most, 1 / least), p.area);
        ofArea.emplace_back(std::max(most * least, 1 / (most * least)), p.area);
        ofAngle.emplace_back(most / least, p.area);
    }
    // What is drawn is quantised.
    const auto near = [](double value) { return doctest::Approx(value).epsilon(0.01); };
    const BakeReport& r = baked.report;
    CHECK(r.stretch50 == near(quantile(worst, 0.5)));
    CHECK(r.stretch95 == near(quantile(worst, 0.95)));
    CHECK(r.stretchMax == near(quantile(worst, 1)));
    CHECK(r.ofArea.p50 == near(quantile(ofArea, 0.5)));
    CHECK(r.ofArea.p95 == near(quantile(ofArea, 0.95)));
    CHECK(r.ofArea.max == near(quantile(ofArea, 1)));
    CHECK(r.ofAngle.p50 == near(quantile(ofAngle, 0.5)));
    CHECK(r.ofAngle.p95 == near(quantile(ofAngle, 0.95)));
    CHECK(r.ofAngle.max == near(quantile(ofAngle, 1)));
}

// A hill of height `h` over [-1, 1]², its UVs seen from above and squeezed in v.
Model hill(float h, float squeeze) {
    Model m;
    m.name = "hill";
    addPatch(
        m, 24,
        [&](float s, float t) {
            const float x = 2 * s - 1, z = 1 - 2 * t;
            return glm::vec3(x, h * std::exp(-3 * (x * x + z * z)), z);
        },
        [&](float s, float t) { return glm::vec2(0.05f + 0.9f * s, 0.05f + 0.9f * squeeze * t); });
    return m;
}

}  // namespace

TEST_CASE("distortion and the share in charts are what sums over the triangles say") {
    for (float squeeze : {1.0f, 0.8f}) {
        const Model model = hill(0.6f, squeeze);
        const Baked baked = bakeOrFail(model, 256, true);
        compare(model, baked);
        CHECK(baked.report.ofArea.max > 1.2);  // there is something to be told
        CHECK(baked.report.ofAngle.p50 > 1.02);
    }
    const Model box = cube(3);
    compare(box, bakeOrFail(box));
}

TEST_CASE("a chart that is squeezed to a half is told as such") {
    Model m;
    m.name = "squeezed";
    addPatch(
        m, 4, [](float s, float t) { return glm::vec3(2 * s, 0, -t); },
        [](float s, float t) { return glm::vec2(0.1f + 0.8f * s, 0.1f + 0.8f * t); });
    const Baked baked = bakeOrFail(m, 256, true);
    REQUIRE(baked.report.madeCharts == 0);
    CHECK(baked.report.ofArea.max == doctest::Approx(1).epsilon(1e-4));
    CHECK(baked.report.ofAngle.p50 == doctest::Approx(2).epsilon(1e-4));
    CHECK(baked.report.stretchMax == doctest::Approx(std::sqrt(2)).epsilon(1e-4));
    CHECK(baked.report.charted == doctest::Approx(1));
}
