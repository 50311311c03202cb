// Views that show amounts, and layers laid over the model.
#include <array>
#include <cmath>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

constexpr uint32_t kSide = 96;
using Pixel = std::array<int, 3>;

// The cube from the front, filling about half of the picture.
std::vector<uint8_t> picture(const Painting& painting, EspLook look) {
    esp::DrawDef def;
    def.width = def.height = kSide;
    def.camera = {
        .eye = {0, 0, 6}, .target = {0, 0, 0}, .up = {0, 1, 0}, .fovY = .7f, .nearPlane = .05f, .shift = {0, 0}};
    def.look = look;
    painting.ok(espUpdate(painting.context));
    painting.ok(espDraw(painting.context, &def));
    std::vector<uint8_t> rgba(size_t(kSide) * kSide * 4);
    painting.ok(espReadPixels(painting.context, rgba.data(), rgba.size()));
    return rgba;
}

Pixel at(const std::vector<uint8_t>& rgba, uint32_t x, uint32_t y) {
    const uint8_t* p = &rgba[(size_t(y) * kSide + x) * 4];
    return {p[0], p[1], p[2]};
}

Pixel legend(EspView view, float amount) {
    float rgb[3], most = 0;
    REQUIRE(espViewColour(view, amount, rgb, &most) == ESP_OK);
    Pixel pixel;
    for (size_t i = 0; i < 3; ++i)
        pixel[i] =
            int(255 * (rgb[i] <= .0031308f ? 12.92f * rgb[i] : 1.055f * std::pow(rgb[i], 1 / 2.4f) - .055f) + .5f);
    return pixel;
}

bool alike(Pixel a, Pixel b) {
    return std::abs(a[0] - b[0]) <= 6 && std::abs(a[1] - b[1]) <= 6 && std::abs(a[2] - b[2]) <= 6;
}

}  // namespace

TEST_CASE("overdraw counts nothing where nothing is, and a fragment or two on a cube") {
    const Painting painting;
    EspLook look = esp::defaults<EspLook>();
    look.view = ESP_VIEW_OVERDRAW;
    const std::vector<uint8_t> shown = picture(painting, look);
    CHECK(alike(at(shown, 2, 2), legend(ESP_VIEW_OVERDRAW, 0)));
    const Pixel middle = at(shown, kSide / 2, kSide / 2);
    // The cube's back may be shaded before its front hides it.
    CHECK((alike(middle, legend(ESP_VIEW_OVERDRAW, 1)) || alike(middle, legend(ESP_VIEW_OVERDRAW, 2))));
    float rgb[3], most = 0;
    CHECK(espViewColour(ESP_VIEW_SHADED, 1, rgb, &most) == ESP_INVALID_ARGUMENT);
    CHECK(legend(ESP_VIEW_DEPTH, 8) == legend(ESP_VIEW_DEPTH, 80));
    look.view = ESP_VIEW_LOD;
    const Pixel level = at(picture(painting, look), kSide / 2, kSide / 2), finest = legend(ESP_VIEW_LOD, 0);
    CHECK(level[0] > 2 * level[2]);  // dimmed where it faces away from the sun
    CHECK(finest[0] > 2 * finest[2]);
    CHECK(legend(ESP_VIEW_LOD, 5) == legend(ESP_VIEW_LOD, 9));
    CHECK(legend(ESP_VIEW_LOD, 0) != legend(ESP_VIEW_LOD, 1));
    CHECK(legend(ESP_VIEW_DEPTH, 0) != legend(ESP_VIEW_DEPTH, 1));
}

TEST_CASE("each chart of a model has the colour that is told of it, and no two that follow each other have the same") {
    const Painting painting;
    EspLook look = esp::defaults<EspLook>();
    look.view = ESP_VIEW_CHARTS;
    const std::vector<uint8_t> shown = picture(painting, look);
    const float eye[3] = {.1f, .1f, 6}, ahead[3] = {0, 0, -1};
    EspHit hit;
    painting.ok(espPick(painting.context, eye, ahead, &hit));
    // Diagnostic views dim what faces away: shares of linear red and green are compared.
    const auto hue = [](Pixel p) {
        std::array<float, 3> linear;
        for (size_t i = 0; i < 3; ++i) linear[i] = std::pow(float(p[i]) / 255, 2.2f);
        const float sum = linear[0] + linear[1] + linear[2] + 1e-4f;
        return std::array<float, 2>{linear[0] / sum, linear[1] / sum};
    };
    const auto seen = hue(at(shown, 50, 46)), told = hue(legend(ESP_VIEW_CHARTS, float(hit.chart)));
    CHECK(seen[0] == doctest::Approx(told[0]).epsilon(.06));
    CHECK(seen[1] == doctest::Approx(told[1]).epsilon(.06));
    for (float i = 0; i < 100; ++i) CHECK(!alike(legend(ESP_VIEW_CHARTS, i), legend(ESP_VIEW_CHARTS, i + 1)));
}

TEST_CASE("depth shows a stem and its branches each by the legend") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(
        "Ivy -> Stem(0)\n"
        "Stem(n) : n >= 30 -> NULL\n"
        "Stem(n) : n % 6 > 4.5 -> Branch(2) {Go(n), Twig(0)}\n"
        "Stem(n) -> Go(n)\n"
        "Go(n) -> Marching(0.05, 0, 1) {Stem(n + 1), Wood}\n"
        "Twig(n) : n >= 8 -> NULL\n"
        "Twig(n) -> Marching(0.05, 0.25, 1) {Twig(n + 1), Wood}\n"
        "Wood -> S(0.1) Shape(\"bark\", C1)\n");
    painting.plant(grammar, {0, -.8f, 1}, {0, 1, 0});
    EspLook look = esp::defaults<EspLook>();
    look.view = ESP_VIEW_DEPTH;
    const std::vector<uint8_t> shown = picture(painting, look);
    // Diagnostic views dim what faces away, so the shares of linear red and green are compared.
    const auto linear = [](int c) { return std::pow(float(c) / 255, 2.2f); };
    const auto hue = [&](Pixel p) {
        const float sum = linear(p[0]) + linear(p[1]) + linear(p[2]) + 1e-4f;
        return std::array<float, 2>{linear(p[0]) / sum, linear(p[1]) / sum};
    };
    const auto count = [&](float depth) {
        const auto wanted = hue(legend(ESP_VIEW_DEPTH, depth));
        int found = 0;
        for (uint32_t y = 0; y < kSide; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const auto here = hue(at(shown, x, y));
                found += std::abs(here[0] - wanted[0]) < .05f && std::abs(here[1] - wanted[1]) < .05f;
            }
        return found;
    };
    CHECK(count(0) > 10);
    CHECK(count(1) > 10);
    CHECK(count(6) == 0);
}

TEST_CASE("a layer of no opacity leaves the model as it is, a full one doesn't") {
    const Painting painting;
    EspStroke stroke{};
    painting.ok(espFillLayer(painting.context, "moss", 1, &stroke));
    EspLook look = esp::defaults<EspLook>();
    const std::vector<uint8_t> shaded = picture(painting, look);
    look.view = ESP_VIEW_LAYER;
    look.viewLayer = "moss";
    look.viewOpacity = 0;
    CHECK(alike(at(picture(painting, look), 48, 48), at(shaded, 48, 48)));
    look.viewOpacity = 1;
    CHECK(!alike(at(picture(painting, look), 48, 48), at(shaded, 48, 48)));
}

TEST_CASE("ground that something else draws is seen in views of charts and layers only, and plants grow on it") {
    Painting painting;
    painting.ok(espDestroySurface(painting.context, painting.surface));
    EspLook look = esp::defaults<EspLook>();
    const std::vector<uint8_t> nothing = picture(painting, look);
    painting.ok(espLoadGround(painting.context, painting.path.c_str(), nullptr, &painting.surface));
    CHECK(picture(painting, look) == nothing);
    look.view = ESP_VIEW_NORMALS;
    CHECK(alike(at(picture(painting, look), 48, 48), at(picture(painting, look), 2, 48)));
    look.view = ESP_VIEW_CHARTS;
    CHECK(!alike(at(picture(painting, look), 48, 48), at(nothing, 48, 48)));
    EspStroke stroke{};
    painting.ok(espFillLayer(painting.context, "moss", 1, &stroke));
    look.view = ESP_VIEW_LAYER;
    look.viewLayer = "moss";
    CHECK(!alike(at(picture(painting, look), 48, 48), at(nothing, 48, 48)));
    painting.plant(
        painting.grammar("Vine -> Marching(0.05, 0, arc < 1) {Vine, Wood}\nWood -> S(0.2) Shape(\"bark\")\n"),
        {0, -.5f, 1}, {0, 1, 0});
    CHECK(painting.grown().nodes > 10);
    CHECK(!alike(at(picture(painting, esp::defaults<EspLook>()), 48, 48), at(nothing, 48, 48)));
}

TEST_CASE("leaves take the colour and the size that are painted for them") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(
        "param turned = #b8350c \"Turned leaves\"\n"
        "context autumn = 0 \"Share of leaves that have turned\"\n"
        "context lush = 0.2 \"Size of leaves\"\n"
        "Vine -> Marching(0.05, 0, arc < 1.6) {Vine, Leaves}\n"
        "Leaves -> Repeat(every(0.03)) {S(0.5 * lush(texCoord)) R(rand(-3, 3)) Leaf}\n"
        "Leaf : rand() < autumn(texCoord) -> Colour(turned) Shape(\"leaf\")\n"
        "Leaf -> Shape(\"leaf\")\n");
    painting.plant(grammar, {0, -.8f, 1}, {0, 1, 0});
    const std::vector<uint8_t> bare = picture(Painting(), esp::defaults<EspLook>());
    struct Seen {
        int red = 0, green = 0;
        int both() const { return red + green; }
    };
    const auto seen = [&](uint32_t fromY, uint32_t toY) {
        const std::vector<uint8_t> shown = picture(painting, esp::defaults<EspLook>());
        Seen found;
        for (uint32_t y = fromY; y < toY; ++y)
            for (uint32_t x = 0; x < kSide; ++x) {
                const Pixel p = at(shown, x, y);
                if (alike(p, at(bare, x, y))) continue;
                found.red += p[0] > p[1] + 25;
                found.green += p[1] > p[0] + 8;
            }
        return found;
    };
    const Seen before = seen(0, kSide);
    CHECK(before.green > 20);
    CHECK(before.red < before.green / 10);
    // The upper half has turned, the lower stays green.
    painting.stroke(brushOn("autumn", .8f, 1, 1), {{{0, .85f, 1}, {0, 0, 1}, 1}});
    const Seen up = seen(0, kSide / 2 - 6), down = seen(kSide / 2 + 6, kSide);
    CHECK(up.red > 10);
    CHECK(up.green < up.red / 3);
    CHECK(down.green > 10);
    CHECK(down.red < down.green / 3);
    EspStroke stroke{};
    painting.ok(espFillLayer(painting.context, "lush", .6f, &stroke));
    CHECK(seen(0, kSide).both() > 2 * before.both());
}

TEST_CASE("shadows that lag behind growth are told, and the next picture of what rests has them as they should be") {
    const Painting painting;
    painting.plant(
        painting.grammar("context mask = 1\n"
                         "Vine -> Marching(0.05, 0, mask(texCoord) and arc < 1.6) {Vine, Leaves}\n"
                         "Leaves -> Repeat(every(0.02)) {S(0.3) T(0.5, 0.2) R(rand(-3, 3)) Shape(\"leaf\")}\n"),
        {0, -.8f, 1}, {0, 1, 0});
    EspLook lags = esp::defaults<EspLook>();
    lags.shadowsLag = 1;
    const auto behind = [&] { return painting.grown().shadowsBehind != 0; };
    (void)picture(painting, lags);
    CHECK(!behind());
    EspBrush brush = brushOn("mask", .3f, 1, 1);
    brush.value = 0;
    bool lagged = false;
    for (int i = 0; i < 5; ++i) {
        painting.stroke(brush, {{{0, .6f - .2f * float(i), 1}, {0, 0, 1}, 1}});
        (void)painting.grown();
        (void)picture(painting, lags);
        lagged = behind();
    }
    CHECK(lagged);
    const std::vector<uint8_t> rested = picture(painting, lags);
    CHECK(!behind());
    CHECK(picture(painting, lags) == rested);
    lags.shadows = 0;
    CHECK(picture(painting, lags) != rested);
    CHECK(!behind());
    CHECK(picture(painting, esp::defaults<EspLook>()) == rested);
}

TEST_CASE("a painted layer that no grammar reads is shown blank where grammars read as many as there can be") {
    const Painting painting;
    std::string text;
    for (int i = 0; i < 16; ++i) text += "context l" + std::to_string(i) + " = 1\n";
    painting.grammar((text + "A -> Marching(0.1, 0, arc < 1) {A}\n").c_str());
    for (const char* layer : {"more", "tint.r", "tint.g", "tint.b"})
        painting.stroke(brushOn(layer, .5f), {dabAt({0, 0, 1})});
    EspLook look = esp::defaults<EspLook>();
    look.view = ESP_VIEW_LAYER;
    look.viewLayer = "l0";
    const std::vector<uint8_t> read = picture(painting, look);
    look.viewLayer = "more";
    const std::vector<uint8_t> blank = picture(painting, look);
    CHECK(blank != read);
    look.viewLayer = "tint";
    CHECK(picture(painting, look) == blank);
    esp::DrawDef def;
    def.look = look;
    def.look.viewLayer = "none";
    CHECK(espDraw(painting.context, &def) == ESP_INVALID_ARGUMENT);
}
