// What strokes keep to be undone by, and that undoing restores.
#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"
#include "tests/support/same_bits.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Of three layers and two cubes that run into each other: random pictures, so that what is restored is no blank.
struct Canvases {
    const char* names[3] = {"mask", "density", "tint"};
    const Painting& painting;
    EspSurface surfaces[2];

    template <class Do>
    void each(Do&& apply) const {
        for (const char* name : names)
            for (EspSurface surface : surfaces) apply(name, surface);
    }
    void colour(std::mt19937& random) const {
        std::uniform_real_distribution<float> unit(0, 1);
        each([&](const char* name, EspSurface surface) {
            std::vector<float> picture(97 * 61);
            for (float& v : picture) v = unit(random);
            EspLayerDef def = esp::defaults<EspLayerDef>();
            def.surface = surface;
            def.name = name;
            def.space = ESP_LAYER_WALK_UV;
            def.texels = picture.data();
            def.width = 97;
            def.height = 61;
            painting.ok(espSetLayer(painting.context, &def));
        });
    }
    std::vector<std::vector<float>> all() const {
        std::vector<std::vector<float>> layers;
        each([&](const char* name, EspSurface surface) { layers.push_back(painting.layer(name, surface)); });
        return layers;
    }
};

EspBrush randomBrush(const char* layer, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    EspBrush brush = brushOn(layer, .02f + .6f * unit(random), unit(random), unit(random));
    brush.mode = EspBrushMode(random() % 3);
    brush.value = unit(random);
    brush.frontOnly = random() % 2;
    if (random() % 3 == 0) brush.slopeRange[0] = unit(random), brush.slopeRange[1] = 1 + unit(random);
    if (random() % 3 == 0) brush.heightRange[0] = -unit(random), brush.heightRange[1] = unit(random);
    if (random() % 2 == 0) brush.limitSoftness = unit(random);
    return brush;
}

}  // namespace

TEST_CASE("1,000 random strokes undone restore every texel bit for bit, and redone paint the same") {
    Painting painting;
    EspTransform over = espIdentity();
    over.rows[0][3] = 1.4f, over.rows[1][3] = .6f, over.rows[2][3] = .3f;
    const Canvases canvases{.painting = painting, .surfaces = {painting.surface, painting.another(over)}};
    CHECK(painting.grown().contacts > 0);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    canvases.colour(random);
    const std::vector<std::vector<float>> begin = canvases.all();
    std::vector<EspStroke> strokes;
    uint64_t bytes[3] = {};
    for (int i = 0; i < 1000; ++i) {
        if (i % 100 == 99) {
            EspStroke fill{};
            painting.ok(espFillLayer(painting.context, canvases.names[random() % 3], unit(random), &fill));
            strokes.push_back(fill);
            continue;
        }
        const EspBrush brush = randomBrush(canvases.names[random() % 3], random);
        const EspStroke stroke = painting.begin(brush);
        for (uint32_t call = 0; call <= random() % 3; ++call) {
            std::vector<EspDab> dabs;
            for (uint32_t k = 0; k < random() % 40; ++k) {
                glm::vec3 at = randomOnCube(random);
                if (random() % 2) at += glm::vec3(over.rows[0][3], over.rows[1][3], over.rows[2][3]);
                dabs.push_back(dabAt(at, {0, 1, 0}, unit(random)));
            }
            painting.ok(espStrokeDabs(painting.context, stroke, dabs.data(), uint32_t(dabs.size())));
        }
        painting.ok(espEndStroke(painting.context, stroke));
        bytes[brush.mode] += espStrokeBytes(painting.context, stroke);
        strokes.push_back(stroke);
    }
    for (uint64_t of : bytes) CHECK(of > 0);
    const std::vector<std::vector<float>> end = canvases.all();
    for (size_t i = 0; i < end.size(); ++i) CHECK_FALSE(sameBits(begin[i], end[i]));
    for (size_t i = strokes.size(); i-- > 0;) painting.ok(espSwapStroke(painting.context, strokes[i]));
    const std::vector<std::vector<float>> undone = canvases.all();
    for (size_t i = 0; i < end.size(); ++i) CHECK(sameBits(undone[i], begin[i]));
    for (const EspStroke& stroke : strokes) painting.ok(espSwapStroke(painting.context, stroke));
    const std::vector<std::vector<float>> redone = canvases.all();
    for (size_t i = 0; i < end.size(); ++i) CHECK(sameBits(redone[i], end[i]));
}

TEST_CASE("a stroke keeps what it changed and no more") {
    Painting painting;
    const EspStroke dab = painting.stroke(brushOn("paint", .2f), {dabAt({1, 0, 0})});
    const uint64_t one = espStrokeBytes(painting.context, dab);
    // A face is 32 texels wide: the dab 6, in at most 4 blocks.
    CHECK(one > 0);
    CHECK(one <= 4 * (64 * 4 + 4));
    // The same again with nothing to add, and beside the model.
    EspBrush again = brushOn("paint", .2f, 0);
    CHECK(espStrokeBytes(painting.context, painting.stroke(again, {dabAt({1, 0, 0})})) == 0);
    CHECK(espStrokeBytes(painting.context, painting.stroke(brushOn("paint", .2f), {dabAt({5, 0, 0})})) == 0);
    painting.ok(espDestroyStroke(painting.context, dab));
    CHECK(espStrokeBytes(painting.context, dab) == 0);
    CHECK(espSwapStroke(painting.context, dab) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("a stroke that goes on where another layer has come in its layer's place undoes what it did to that") {
    Painting painting;
    const auto set = [&](float value) {  // below 0: takes the layer away
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = painting.surface;
        def.name = "mask";
        def.texels = value < 0 ? nullptr : &value;
        def.width = def.height = 1;
        painting.ok(espSetLayer(painting.context, &def));
    };
    const EspDab dab = dabAt({1, 0, 0});
    set(.5f);
    const EspStroke stroke = painting.begin(brushOn("mask", .4f));
    painting.ok(espStrokeDabs(painting.context, stroke, &dab, 1));
    float there = -1;
    bool goesOn = true;
    SUBCASE("none: it makes one") {}
    SUBCASE("one that was set") {
        there = .25f;
    }
    SUBCASE("one that was set, and the stroke has ended") {
        there = .25f;
        goesOn = false;
    }
    set(there);
    const std::vector<float> before = painting.layer("mask");
    if (goesOn) painting.ok(espStrokeDabs(painting.context, stroke, &dab, 1));
    painting.ok(espEndStroke(painting.context, stroke));
    const std::vector<float> after = painting.layer("mask");
    CHECK(sameBits(before, after) == !goesOn);
    for (int i = 0; i < 2; ++i) {
        painting.ok(espSwapStroke(painting.context, stroke));
        CHECK(espPaintedLayerCount(painting.context) == (there < 0 ? 0 : 1));
        CHECK(sameBits(painting.layer("mask"), before));
        painting.ok(espSwapStroke(painting.context, stroke));
        CHECK(espPaintedLayerCount(painting.context) == 1);
        CHECK(sameBits(painting.layer("mask"), after));
    }
}

TEST_CASE("a stroke tells which surfaces it has changed") {
    const Painting painting;
    EspTransform place = espIdentity();
    place.rows[0][3] = 10;
    const EspSurface far = painting.another(place);
    const auto painted = [&](EspStroke stroke) {
        return std::pair(espStrokePainted(painting.context, stroke, painting.surface),
                         espStrokePainted(painting.context, stroke, far));
    };
    const EspBrush brush = brushOn("mask", .4f);
    CHECK(painted(painting.stroke(brush, {dabAt({1, 0, 0})})) == std::pair(1, 0));
    CHECK(painted(painting.stroke(brush, {dabAt({11, 0, 0})})) == std::pair(0, 1));
    CHECK(painted(painting.stroke(brush, {dabAt({1, 0, 0}), dabAt({11, 0, 0})})) == std::pair(1, 1));
    CHECK(painted(painting.stroke(brush, {dabAt({5, 0, 0})})) == std::pair(0, 0));
    CHECK(painted({}) == std::pair(0, 0));
    CHECK(espStrokePainted(painting.context, painting.stroke(brush, {dabAt({1, 0, 0})}), {}) == 0);  // no town is here
    CHECK(espLayerPainted(painting.context, far, "mask") == 1);
    CHECK(espLayerPainted(painting.context, far, "ask") == 0);
    CHECK(espLayerPainted(nullptr, far, "mask") == 0);
    CHECK(espLayerPainted(painting.context, {}, "mask") == 0);
}

TEST_CASE("layers that a stroke made go when it is undone, and come back as they were") {
    Painting painting;
    // Two grammars that want another value each where nothing is painted.
    const EspGrammar first = painting.grammar(kMaskedIvy);
    std::string text = kMaskedIvy;
    text.replace(text.find("mask = 1"), 8, "mask = 0");
    const EspGrammar second = painting.grammar(text.c_str());
    painting.plant(first, {1, -.9f, 0}, {0, 1, 0}, 1);
    painting.plant(second, {0, -.9f, 1}, {0, 1, 0}, 2);
    const EspStats before = painting.grown();
    EspBrush brush = brushOn("mask", .4f);
    brush.value = 0;
    const EspStroke stroke = painting.stroke(brush, {dabAt({1, 0, 0})});
    const EspStats painted = painting.grown();
    const std::vector<float> mask = painting.layer("mask");
    CHECK(painted.hash != before.hash);  // the second's ivy grows where nothing is painted, too
    CHECK(painted.nodes > before.nodes);
    const auto swapped = [&](EspStroke which) {
        painting.ok(espSwapStroke(painting.context, which));
        return painting.grown();
    };
    SUBCASE("back and forth") {
        for (int i = 0; i < 2; ++i) {
            CHECK(swapped(stroke).hash == before.hash);
            CHECK(espPaintedLayerCount(painting.context) == 0);
            CHECK(swapped(stroke).hash == painted.hash);
            CHECK(sameBits(painting.layer("mask"), mask));
        }
    }
    SUBCASE("after later strokes, which are undone first") {
        const EspStroke later = painting.stroke(brush, {dabAt({0, 0, 1})});
        swapped(later);
        CHECK(sameBits(painting.layer("mask"), mask));
        CHECK(swapped(stroke).hash == before.hash);
        CHECK(espPaintedLayerCount(painting.context) == 0);
        swapped(stroke);
        swapped(later);
        CHECK_FALSE(sameBits(painting.layer("mask"), mask));
    }
    SUBCASE("but not where what was painted since can't be undone") {
        painting.ok(espDestroyStroke(painting.context, painting.stroke(brush, {dabAt({0, 0, 1})})));
        swapped(stroke);
        CHECK(espPaintedLayerCount(painting.context) == 1);
    }
    SUBCASE("nor where a stroke that goes on has painted since") {
        const EspStroke open = painting.begin(brush);
        const EspDab dab = dabAt({0, 0, 1});
        painting.ok(espStrokeDabs(painting.context, open, &dab, 1));
        swapped(stroke);
        CHECK(espPaintedLayerCount(painting.context) == 1);
        const EspStats both = painting.grown();
        painting.ok(espEndStroke(painting.context, open));
        swapped(open);  // last done, though not first undone
        CHECK(swapped(open).hash == both.hash);
    }
    SUBCASE("nor one that has taken its place") {
        const std::vector<float> half(size_t(4), .5f);
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = painting.surface;
        def.name = "mask";
        def.texels = half.data();
        def.width = def.height = 2;
        painting.ok(espSetLayer(painting.context, &def));
        swapped(stroke);
        CHECK(espPaintedLayerCount(painting.context) == 1);
    }
    SUBCASE("nor come they back on a surface that is gone") {
        swapped(stroke);
        painting.ok(espDestroySurface(painting.context, painting.surface));
        painting.ok(espSwapStroke(painting.context, stroke));
        CHECK(espPaintedLayerCount(painting.context) == 0);
    }
}
