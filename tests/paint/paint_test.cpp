// Painting through the public interface: every texel against the formula in double precision, seams, growth.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// What the brush is documented to do, written anew in double precision.
struct Expected {
    double radius, value, strength, hardness;
    double slope[2] = {0, 4}, height[2] = {-1e9, 1e9}, softness = 0;
    bool front = false;

    static double smooth(double t) {
        t = std::clamp(t, 0.0, 1.0);
        return t * t * (3 - 2 * t);
    }
    double within(const double range[2], double v, double fade) const {
        const double out = std::max(range[0] - v, v - range[1]);
        if (fade <= 0) return out <= 0;
        return smooth(1 - out / fade);
    }
    double after(double before, glm::dvec3 p, glm::dvec3 n, glm::dvec3 at, glm::dvec3 facing, double pressure) const {
        const double x = glm::length(p - at) / radius;
        double w = x >= 1 ? 0 : hardness >= 1 ? 1 : 1 - smooth((x - hardness) / (1 - hardness));
        w *= within(slope, std::acos(std::clamp(n.y, -1.0, 1.0)), softness * 0.785398163);
        w *= within(height, p.y, softness * radius);
        if (front) w *= std::clamp(8 * glm::dot(n, facing), 0.0, 1.0);
        return before + (value - before) * w * strength * pressure;
    }
};

// Bilinear, as a grammar reads it.
float readAt(const std::vector<float>& layer, uint32_t size, glm::vec2 uv) {
    const float x = std::clamp(uv.x * float(size) - .5f, 0.f, float(size - 1));
    const float y = std::clamp(uv.y * float(size) - .5f, 0.f, float(size - 1));
    const uint32_t x0 = uint32_t(x), y0 = uint32_t(y), x1 = std::min(x0 + 1, size - 1), y1 = std::min(y0 + 1, size - 1);
    const float fx = x - float(x0), fy = y - float(y0);
    return glm::mix(glm::mix(layer[y0 * size + x0], layer[y0 * size + x1], fx),
                    glm::mix(layer[y1 * size + x0], layer[y1 * size + x1], fx), fy);
}

struct SeamGaps {
    float worst = 0;  // greatest difference of the two sides' reads along all seams
    float most = 0;   // greatest value met there
    uint32_t points = 0;
};
SeamGaps seamGaps(const Painting& painting, const std::vector<float>& layer) {
    SeamGaps gaps;
    for (const Crossing& c : painting.data.crossings) {
        if ((c.flags & 3u) != kCrossingSeam) continue;
        for (float t = .05f; t < 1; t += .1f) {
            const float here = readAt(layer, painting.size(), glm::mix(c.a, c.b, t));
            const float there = readAt(layer, painting.size(), glm::mix(c.ta, c.tb, t));
            gaps.worst = std::max(gaps.worst, std::abs(here - there));
            gaps.most = std::max(gaps.most, here);
            ++gaps.points;
        }
    }
    return gaps;
}

}  // namespace

TEST_CASE("a dab paints every texel by the documented formula, gutters too, and no other") {
    Painting painting;
    const glm::dvec3 at(1, .8, .9), facing(0.6, 0, 0.8);
    struct Case {
        EspBrush brush;
        Expected expected;
    };
    std::vector<Case> cases;
    cases.push_back({brushOn("paint", .7f, .8f), {.7, 1, .8, 0}});
    cases.push_back({brushOn("paint", .5f, 1, 1), {.5, 1, 1, 1}});
    cases.push_back({brushOn("paint", 1.5f, .5f, .5f), {1.5, .25, .5, .5}});
    cases.back().brush.value = .25f;
    cases.push_back({brushOn("paint", 2, 1, .2f), {2, 1, 1, .2}});
    cases.back().brush.slopeRange[0] = 1.4f;
    cases.back().brush.slopeRange[1] = 1.8f;
    cases.back().expected.slope[0] = 1.4f;
    cases.back().expected.slope[1] = 1.8f;
    cases.push_back({brushOn("paint", 2, 1, .2f), {2, 1, 1, .2}});
    cases.back().brush.heightRange[0] = .1f;
    cases.back().brush.heightRange[1] = .6f;
    cases.back().brush.limitSoftness = .4f;
    cases.back().expected.height[0] = .1f;
    cases.back().expected.height[1] = .6f;
    cases.back().expected.softness = .4f;
    cases.push_back({brushOn("paint", 2, 1, .2f), {2, 1, 1, .2}});
    cases.back().brush.frontOnly = 1;
    cases.back().expected.front = true;
    for (const Case& c : cases) {
        const EspStroke stroke = painting.begin(c.brush);
        const std::vector<EspDab> dabs{dabAt(at, facing, 1), dabAt(at, facing, .5f)};
        painting.ok(espStrokeDabs(painting.context, stroke, dabs.data(), 2));
        const std::vector<float> layer = painting.layer("paint");
        double worst = 0, most = 0;
        bool emptyTouched = false;
        for (uint32_t y = 0; y < painting.size(); ++y)
            for (uint32_t x = 0; x < painting.size(); ++x) {
                const float value = layer[y * painting.size() + x];
                const Texel& texel = painting.texel(x, y);
                if (texelClass(texel.bits) == kTexelEmpty) {
                    emptyTouched = emptyTouched || value != 0;
                    continue;
                }
                const glm::dvec3 p(texel.position), n(unpackOct(painting.aux(x, y).normal));
                const double once = c.expected.after(0, p, n, at, facing, 1);
                const double twice = c.expected.after(once, p, n, at, facing, .5);
                // At a hard edge a texel may fall on either side.
                const double x01 = glm::length(p - at) / c.expected.radius;
                if (c.expected.hardness == 1 && std::abs(x01 - 1) < 1e-5) continue;
                worst = std::max(worst, std::abs(twice - value));
                most = std::max(most, double(value));
            }
        CHECK(worst < 2e-4);
        CHECK(most > .1);
        CHECK_FALSE(emptyTouched);
        painting.ok(espEndStroke(painting.context, stroke));
        painting.ok(espSwapStroke(painting.context, stroke));
    }
}

TEST_CASE("a stroke around a corner is read alike on both sides of every seam") {
    for (const Model& model : {cube(2), cubeCross(2), cube(2, 0x15)}) {
        Painting painting(model, 256);
        std::mt19937 random(7);
        std::vector<EspDab> dabs;
        for (int i = 0; i < 40; ++i) {
            // Onto an edge of the cube: the two greatest coordinates to 1.
            glm::vec3 p = randomOnCube(random);
            const int least = std::abs(p.x) < std::abs(p.y) ? (std::abs(p.x) < std::abs(p.z) ? 0 : 2)
                                                            : (std::abs(p.y) < std::abs(p.z) ? 1 : 2);
            for (int k = 0; k < 3; ++k)
                if (k != least) p[k] = p[k] < 0 ? -1.f : 1.f;
            dabs.push_back(dabAt(p));
        }
        painting.stroke(brushOn("paint", .4f, .4f, .2f), dabs);
        const SeamGaps gaps = seamGaps(painting, painting.layer("paint"));
        CHECK(gaps.points > 100);
        CHECK(gaps.most > .5f);
        // A texel is 3 cm wide, where the brush falls off by a tenth.
        CHECK(gaps.worst < .02f);
    }
}

TEST_CASE("a dab paints every surface that it reaches, as each is placed, and is undone on all") {
    Painting painting;
    // The second cube's edge comes near the first one's face, aslant.
    const float c = std::cos(.5f) * .8f, s = std::sin(.5f) * .8f;
    const EspTransform place{{{c, 0, s, 2.3f}, {0, .8f, 0, .2f}, {-s, 0, c, .1f}}};
    const EspSurface surfaces[2] = {painting.surface, painting.another(place)};
    const EspTransform places[2] = {espIdentity(), place};
    const glm::dvec3 at(1.15, .3, .2), facing(0, 0, 1);
    EspBrush brush = brushOn("paint", .6f, .9f, .3f);
    brush.heightRange[0] = 0;
    brush.heightRange[1] = .5f;
    brush.limitSoftness = .5f;
    Expected expected{.6, 1, .9, .3};
    expected.height[0] = 0;
    expected.height[1] = .5;
    expected.softness = .5;
    const EspStroke stroke = painting.stroke(brush, {dabAt(at)});
    for (int i = 0; i < 2; ++i) {
        CAPTURE(i);
        const std::vector<float> layer = painting.layer("paint", surfaces[i]);
        glm::dmat3 turn;
        glm::dvec3 shift;
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 3; ++column) turn[column][row] = places[i].rows[row][column];
            shift[row] = places[i].rows[row][3];
        }
        double worst = 0;
        uint32_t painted = 0;
        for (uint32_t y = 0; y < painting.size(); ++y)
            for (uint32_t x = 0; x < painting.size(); ++x) {
                if (texelClass(painting.texel(x, y).bits) == kTexelEmpty) continue;
                const glm::dvec3 p = turn * glm::dvec3(painting.texel(x, y).position) + shift;
                const glm::dvec3 n = glm::normalize(turn * glm::dvec3(unpackOct(painting.aux(x, y).normal)));
                const double value = layer[y * painting.size() + x];
                worst = std::max(worst, std::abs(expected.after(0, p, n, at, facing, 1) - value));
                painted += value > .1;
            }
        CHECK(worst < 2e-4);
        CHECK(painted > 20);
    }
    painting.ok(espSwapStroke(painting.context, stroke));
    for (EspSurface surface : surfaces) {
        const std::vector<float> layer = painting.layer("paint", surface);
        CHECK(std::ranges::all_of(layer, [](float v) { return v == 0; }));
    }
}

TEST_CASE("erasing leads back to the fill that a grammar declares, and layers outlive a recompilation") {
    Painting painting;
    const EspGrammar grammar = painting.grammar("context mask = 0.75\nIvy -> Marching(0.1, 0, mask(texCoord)) {Ivy}\n");
    EspBrush brush = brushOn("mask", .5f, 1, 1);
    brush.value = 0;
    painting.stroke(brush, {dabAt({1, 0, 0})});
    std::vector<float> layer = painting.layer("mask");
    CHECK(*std::min_element(layer.begin(), layer.end()) == 0);
    CHECK(*std::max_element(layer.begin(), layer.end()) == .75f);
    const char* text = "context mask = 0.75\nIvy -> Marching(0.2, 0, mask(texCoord)) {Ivy}\n";
    EspGrammarDef def = esp::grammarDef("again", text);
    painting.ok(espRecompileGrammar(painting.context, grammar, &def));
    CHECK(painting.layer("mask") == layer);
    REQUIRE(espPaintedLayerCount(painting.context) == 1);
    CHECK(std::string(espPaintedLayerName(painting.context, 0)) == "mask");
    CHECK(espLayerPainted(painting.context, painting.surface, "mask") == 1);
    CHECK(espLayerPainted(painting.context, painting.surface, "ask") == 0);
    brush.mode = ESP_BRUSH_ERASE;
    brush.radius = .8f;
    painting.stroke(brush, {dabAt({1, 0, 0})});
    layer = painting.layer("mask");
    CHECK(*std::min_element(layer.begin(), layer.end()) == .75f);
}

TEST_CASE("painting refuses what isn't a brush, a dab or a stroke, and stays as it was") {
    Painting painting;
    EspStroke stroke{};
    for (int mistake = 0; mistake < 9; ++mistake) {
        EspBrush brush = brushOn("paint", .5f);
        if (mistake == 0) brush.layer = nullptr;
        if (mistake == 1) brush.layer = "";
        if (mistake == 2) brush.radius = 0;
        if (mistake == 3) brush.radius = NAN;
        if (mistake == 4) brush.value = 1.5f;
        if (mistake == 5) brush.strength = -1;
        if (mistake == 6) brush.hardness = NAN;
        if (mistake == 7) brush.mode = EspBrushMode(17);
        if (mistake == 8) brush.heightRange[1] = NAN;
        CHECK(espBeginStroke(painting.context, &brush, &stroke) == ESP_INVALID_ARGUMENT);
        CHECK(std::strlen(espLastError(painting.context)) > 0);
    }
    CHECK(stroke.id == 0);
    const EspDab good = dabAt({1, 0, 0}), bad = dabAt({NAN, 0, 0});
    CHECK(espStrokeDabs(painting.context, stroke, &good, 1) == ESP_INVALID_ARGUMENT);
    stroke = painting.begin(brushOn("paint", .5f));
    CHECK(espStrokeDabs(painting.context, stroke, &bad, 1) == ESP_INVALID_ARGUMENT);
    CHECK(espStrokeDabs(painting.context, stroke, nullptr, 1) == ESP_INVALID_ARGUMENT);
    CHECK(espSwapStroke(painting.context, stroke) == ESP_INVALID_ARGUMENT);
    CHECK(espPaintedLayerCount(painting.context) == 0);
    painting.ok(espStrokeDabs(painting.context, stroke, &good, 1));
    painting.ok(espEndStroke(painting.context, stroke));
    CHECK(espEndStroke(painting.context, stroke) == ESP_INVALID_ARGUMENT);
    CHECK(espStrokeDabs(painting.context, stroke, &good, 1) == ESP_INVALID_ARGUMENT);
    // A stroke outlives its surface; what is gone is passed over.
    painting.ok(espDestroySurface(painting.context, painting.surface));
    painting.ok(espSwapStroke(painting.context, stroke));
    CHECK(espPaintedLayerCount(painting.context) == 0);
    float texel = 0;
    uint32_t side = 1;
    CHECK(espReadLayer(painting.context, painting.surface, "paint", &texel, &side) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("smoothing far is as even as smoothing near: over a seam as inside a chart") {
    // A stripe over an edge of the cube and the same stripe in the middle of a face, ways of 8 and more texels.
    Painting painting(cube(2), 512);
    const auto smoothedAt = [&](glm::vec3 middle, glm::vec3 a, glm::vec3 b) {
        EspStroke clear{};
        painting.ok(espFillLayer(painting.context, "paint", 0, &clear));
        painting.stroke(brushOn("paint", .2f, 1, 1), {dabAt(middle)});
        EspBrush brush = brushOn("paint", .9f, 1, .5f);
        brush.mode = ESP_BRUSH_SMOOTH;
        painting.stroke(brush, std::vector<EspDab>(6, dabAt(middle)));
        const std::vector<float> layer = painting.layer("paint");
        std::vector<float> values;
        for (int i = 1; i <= 12; ++i)
            for (const glm::vec3& way : {a, b}) {
                const glm::vec3 p = middle + way * (float(i) * .03f);
                const float point[3] = {p.x, p.y, p.z};
                EspHit hit{};
                painting.ok(espNearest(painting.context, point, &hit));
                values.push_back(readAt(layer, painting.size(), {hit.uv[0], hit.uv[1]}));
            }
        return values;
    };
    const std::vector<float> inside = smoothedAt({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const std::vector<float> over = smoothedAt({1, 1, 0}, {-1, 0, 0}, {0, 0, 1});
    REQUIRE(inside.size() == over.size());
    CHECK(inside[0] > .2f);
    CHECK(inside[0] < .9f);
    for (size_t i = 0; i < inside.size(); ++i) CHECK(over[i] == doctest::Approx(inside[i]).scale(1).epsilon(.06));
}

TEST_CASE("smoothing leaves what is even as it is, to the bit, and goes nowhere beyond what was there") {
    Painting painting(cube(2), 256);
    for (const float radius : {.04f, .7f}) {
        CAPTURE(radius);
        EspBrush brush = brushOn("paint", radius, 1, .5f);
        brush.mode = ESP_BRUSH_SMOOTH;
        for (const float value : {.1f, .3f, .7f, 1.f}) {
            CAPTURE(value);
            EspStroke fill{};
            painting.ok(espFillLayer(painting.context, "paint", value, &fill));
            const std::vector<float> even = painting.layer("paint");
            const EspStroke stroke = painting.stroke(brush, std::vector<EspDab>(6, dabAt({1, 1, 0})));
            CHECK(painting.layer("paint") == even);
            CHECK(espStrokeBytes(painting.context, stroke) == 0);
        }
        EspStroke clear{};
        painting.ok(espFillLayer(painting.context, "paint", .2f, &clear));
        painting.stroke(brushOn("paint", .9f * radius, 1, 1), {dabAt({1, 1, 0}), dabAt({1, .9f, .1f})});
        painting.stroke(brush, std::vector<EspDab>(20, dabAt({1, 1, 0})));
        const std::vector<float> soft = painting.layer("paint");
        CHECK(*std::max_element(soft.begin(), soft.end()) <= 1);
        CHECK(*std::min_element(soft.begin(), soft.end()) == .2f);
    }
}

TEST_CASE("smoothing lowers what stands out, on both sides of a seam alike, and keeps what is even") {
    for (const Model& model : {cube(2), cubeCross(2)}) {
        Painting painting(model, 256);
        // An edge of the cube goes through the middle of a hard spot.
        painting.stroke(brushOn("paint", .3f, 1, 1), {dabAt({1, 1, 0})});
        const std::vector<float> hard = painting.layer("paint");
        EspBrush brush = brushOn("paint", .7f, 1, .5f);
        brush.mode = ESP_BRUSH_SMOOTH;
        const EspStroke stroke = painting.stroke(brush, std::vector<EspDab>(12, dabAt({1, 1, 0})));
        const std::vector<float> soft = painting.layer("paint");
        const auto steepest = [&](const std::vector<float>& layer) {
            float most = 0;
            for (uint32_t y = 0; y < painting.size(); ++y)
                for (uint32_t x = 0; x + 1 < painting.size(); ++x)
                    if (texelClass(painting.texel(x, y).bits) == kTexelInner &&
                        texelClass(painting.texel(x + 1, y).bits) == kTexelInner)
                        most = std::max(most,
                                        std::abs(layer[y * painting.size() + x + 1] - layer[y * painting.size() + x]));
            return most;
        };
        CHECK(steepest(hard) == 1);
        CHECK(steepest(soft) < .3f);
        CHECK(seamGaps(painting, soft).worst < .05f);
        CHECK(*std::max_element(soft.begin(), soft.end()) <= 1);
        CHECK(*std::min_element(soft.begin(), soft.end()) >= 0);
        // The hill stays where it was: symmetric about the edge, as seen from both faces.
        const auto at = [&](glm::vec3 p) {
            EspHit hit{};
            const float point[3] = {p.x, p.y, p.z};
            painting.ok(espNearest(painting.context, point, &hit));
            return readAt(soft, painting.size(), {hit.uv[0], hit.uv[1]});
        };
        for (float d : {.02f, .1f, .2f, .3f, .4f}) {
            CHECK(at({1, 1 - d, 0}) == doctest::Approx(at({1 - d, 1, 0})).epsilon(.1));
            CHECK(at({1, 1 - d, .1}) == doctest::Approx(at({1 - d, 1, .1})).epsilon(.1));
        }
        CHECK(at({1, .98f, 0}) > at({1, .7f, 0}));
        painting.ok(espSwapStroke(painting.context, stroke));
        CHECK(painting.layer("paint") == hard);
        // An even layer stays even.
        EspStroke fill{};
        painting.ok(espFillLayer(painting.context, "paint", .5f, &fill));
        painting.stroke(brush, {dabAt({1, 1, 0})});
        const std::vector<float> even = painting.layer("paint");
        CHECK(std::ranges::all_of(even, [](float v) { return v == 0 || std::abs(v - .5f) < 1e-5f; }));
    }
}

TEST_CASE("what a layer gave is taken back bit for bit, and an import can be undone") {
    Painting painting;
    painting.stroke(brushOn("paint", .9f, .7f), {dabAt({1, 1, 0}), dabAt({0, 1, 1})});
    const std::vector<float> painted = painting.layer("paint");
    EspLayerDef def = esp::defaults<EspLayerDef>();
    def.surface = painting.surface;
    def.name = "copy";
    def.space = ESP_LAYER_TEXELS;
    def.texels = painted.data();
    def.width = def.height = painting.size();
    painting.ok(espSetLayer(painting.context, &def));
    CHECK(painting.layer("copy") == painted);
    def.width = 64;
    CHECK(espSetLayer(painting.context, &def) == ESP_INVALID_ARGUMENT);
    // A picture over what is painted, and away again.
    const float grey[4] = {.25f, .25f, .25f, .25f};
    def.space = ESP_LAYER_WALK_UV;
    def.texels = grey;
    def.width = def.height = 2;
    EspStroke import{};
    painting.ok(espImportLayer(painting.context, &def, &import));
    CHECK(painting.layer("copy") != painted);
    CHECK(espStrokeBytes(painting.context, import) > 0);
    painting.ok(espSwapStroke(painting.context, import));
    CHECK(painting.layer("copy") == painted);
}
