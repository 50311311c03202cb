// Patterns and fields as a host asks for them.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/plugin/life.hpp"

using namespace espalier;

namespace {

constexpr const char* kRings =
    "angles degrees\n"
    "field flow : tensor \"Direction\"\n"
    "param size = 0.1 [0.02 .. 0.3] \"m\" \"Size\"\n"
    "Start -> A\n"
    "A -> [S(size) IC(\"torus\")] [T(size, 0, 0) A] [Rz(120) T(size, 0, 0) A] [Rz(-120) T(size, 0, 0) A]\n";

struct Pattern : Life {
    explicit Pattern(bool shaders = false, const char* rules = kRings) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = silent;
        REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.shadersOnly = shaders;
        REQUIRE(espSetGrow(context, &grow) == ESP_OK);
        REQUIRE(load());
        const EspGrammarDef text = esp::grammarDef("rings", rules);
        REQUIRE_MESSAGE(espCompileGrammar(context, &text, &grammar) == ESP_OK, espLastError(context));
        REQUIRE(plant(1));
        REQUIRE_MESSAGE(update(), espLastError(context));
    }
    EspPatternStats stats() {
        EspPatternStats s{};
        REQUIRE(espPatternStats(context, &s) == ESP_OK);
        return s;
    }
    void setElement(EspElementKind kind, float turn) {
        const EspFieldElement element{kind, {0, 0, 0}, {std::cos(turn), std::sin(turn), .3f}, .3f};
        EspFieldDef def = esp::defaults<EspFieldDef>();
        def.elements = &element;
        def.elementCount = 1;
        REQUIRE(espSetField(context, surface, "flow", &def) == ESP_OK);
    }
};

// Pieces with what stands in their place, and what goes on without them.
constexpr const char* kInstead =
    "angles degrees\n"
    "Start -> A\n"
    "A -> S(0.1) IC(\"torus\") else { S(0.04) T(0.05, 0, 0) Rz(20) IC(\"star\") [T(0.09, 0, 0) A] } [T(0.11, 0, 0) "
    "Rz(41) A]\n"
    "     [Rz(-120) T(0.11, 0, 0) A] [Rz(120) S(0.05) T(0.08, 0, 0) IC(\"ellipse\") omit T(0.05, 0, 0) A]\n";

// Lines that end at others, knots that go into others.
constexpr const char* kVeins =
    "angles degrees\n"
    "Start -> V [Rz(120) V] [Rz(-120) V]\n"
    "V -> Rz(rand(-20, 20)) Line(merge) { T(0.05, 0, 0) LineSeg(\"tube\", 0.008) V [Rz(80) V] Knot }\n"
    "Knot -> S(0.02) IM(\"ball\", 0.03, 180)\n";

// What fields say, and how they change, of one and between two; a way that jumps over singularities.
constexpr const char* kSlopes =
    "field flow : tensor jumps \"Direction\"\n"
    "field lie : vector\n"
    "field bend : curvature\n"
    "Start -> A\n"
    "A : flow.curl1 > 0 -> S(clamp(abs(bend.gradient1.x) * 0.01, 0.02, 0.05)) IC(\"box\") B\n"
    "A -> S(clamp(0.03 + 0.01 * lie.divergence1, 0.02, 0.05)) IC(\"torus\") B\n"
    "B -> [Rz(flow.angleTo(lie)) T(0.06, 0, 0) A] [Rz(flow.Xangle1) T(0.06, 0, 0) A]\n"
    "     [Rz(2 + lie.turnAlong(flow)) T(0.07, 0, 0) A]\n";

}  // namespace

TEST_CASE("a pattern by kernels is the same to the bit as by native code") {
    for (const char* rules : {kRings, kInstead, kVeins, kSlopes}) {
        Pattern native(false, rules), shaders(true, rules);
        CHECK(native.stats().pieces > 20);
        CHECK(native.stats().hash == shaders.stats().hash);
        CHECK(native.stats().tried == shaders.stats().tried);
    }
}

TEST_CASE("an element of a field turns the pattern, and what was undone is as before") {
    Pattern pattern;
    const uint64_t before = pattern.stats().hash;
    pattern.setElement(ESP_ELEMENT_REGULAR, .9f);
    REQUIRE(pattern.update());
    const uint64_t turned = pattern.stats().hash;
    CHECK(turned != before);
    pattern.setElement(ESP_ELEMENT_WEDGE, .2f);
    REQUIRE(pattern.update());
    CHECK(pattern.stats().hash != turned);
    REQUIRE(espSetField(pattern.context, pattern.surface, "flow", nullptr) == ESP_OK);
    REQUIRE(pattern.update());
    CHECK(pattern.stats().hash == before);
}

TEST_CASE("a pattern is derived only when something that it depends on changes, and goes with its seed") {
    Pattern pattern;
    const EspPatternStats before = pattern.stats();
    REQUIRE(pattern.update());
    CHECK(pattern.stats().ms == before.ms);
    const float size = .14f;
    REQUIRE(espSetParam(pattern.context, pattern.grammar, "size", &size, 1) == ESP_OK);
    REQUIRE(pattern.update());
    CHECK(pattern.stats().pieces < before.pieces);
    REQUIRE(pattern.draw());
    REQUIRE(espRemoveAllSeeds(pattern.context) == ESP_OK);
    REQUIRE(pattern.update());
    CHECK(pattern.stats().pieces == 0);
    EspStats plants{};
    REQUIRE(espReadStats(pattern.context, &plants) == ESP_OK);
    CHECK(plants.nodes == 0);
}

TEST_CASE("what can't be a field or a pattern is refused, and what stands stays") {
    Pattern pattern;
    const uint64_t before = pattern.stats().hash;
    EspFieldDef def = esp::defaults<EspFieldDef>();
    CHECK(espSetField(pattern.context, {12345}, "flow", &def) == ESP_INVALID_ARGUMENT);
    CHECK(espSetField(pattern.context, pattern.surface, "", &def) == ESP_INVALID_ARGUMENT);
    CHECK(espSetField(pattern.context, pattern.surface, nullptr, &def) == ESP_INVALID_ARGUMENT);
    def.elementCount = 1;
    CHECK(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_INVALID_ARGUMENT);
    EspFieldElement element{ESP_ELEMENT_NODE, {0, 0, 0}, {1, 0, 0}, -1};
    def.elements = &element;
    CHECK(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_INVALID_ARGUMENT);
    element.radius = 1;
    element.position[1] = std::numeric_limits<float>::quiet_NaN();
    CHECK(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_INVALID_ARGUMENT);
    CHECK(espPatternStats(pattern.context, nullptr) == ESP_INVALID_ARGUMENT);
    const std::string wrong = "A -> IC(\"thorus\")";
    const EspGrammarDef text = esp::grammarDef("wrong", wrong);
    CHECK(espRecompileGrammar(pattern.context, pattern.grammar, &text) == ESP_INVALID_CONTENT);
    CHECK(std::string(espLastError(pattern.context)).find("did you mean 'torus'") != std::string::npos);
    REQUIRE(pattern.update());
    CHECK(pattern.stats().hash == before);
}

TEST_CASE("strokes and a field of others turn the pattern, and what was undone is as before") {
    Pattern pattern;
    const uint64_t before = pattern.stats().hash;
    const auto hashWith = [&](const EspFieldDef& def) {
        REQUIRE_MESSAGE(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_OK,
                        espLastError(pattern.context));
        REQUIRE_MESSAGE(pattern.update(), espLastError(pattern.context));
        return pattern.stats().hash;
    };
    EspFieldDef def = esp::defaults<EspFieldDef>();
    const float way[] = {.1f, .5f, 0, .3f, .6f, 0, .5f, .7f, 0, .7f, .8f, 0};
    const EspFieldStroke strokes[] = {{ESP_FIELD_COMB, .5f, .9f, 4, way}, {ESP_FIELD_SMOOTH, .4f, .5f, 2, way}};
    def.strokes = strokes;
    def.strokeCount = 1;
    const uint64_t combed = hashWith(def);
    CHECK(combed != before);
    def.strokeCount = 2;
    (void)hashWith(def);
    def.strokeCount = 1;
    CHECK(hashWith(def) == combed);
    def = esp::defaults<EspFieldDef>();
    // The same direction at the corners, as vectors, as tensors and as a picture of it.
    const float corners[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    std::vector<float> vectors, tensors, picture;
    for (int i = 0; i < 4; ++i) vectors.insert(vectors.end(), {.6f, .8f, 0});
    for (int i = 0; i < 4; ++i) tensors.insert(tensors.end(), {.36f, .64f, 0, .48f, 0, 0});
    for (int i = 0; i < 6; ++i) picture.insert(picture.end(), {.6f, .8f, 0});
    def.points = corners;
    def.pointCount = 4;
    def.vectors = vectors.data();
    const uint64_t given = hashWith(def);
    CHECK(given != before);
    def.vectors = nullptr;
    def.tensors = tensors.data();
    CHECK(hashWith(def) == given);
    def = esp::defaults<EspFieldDef>();
    def.picture = picture.data();
    def.pictureWidth = 3;
    def.pictureHeight = 2;
    CHECK(hashWith(def) == given);
    CHECK(hashWith(esp::defaults<EspFieldDef>()) == before);
}

TEST_CASE("strokes and fields of others that can't be are refused, each with its reason") {
    Pattern pattern;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float good[] = {0, 0, 0, 1, 0, 0}, bad[] = {0, nan, 0, 1, 0, 0}, far[] = {90, 0, 0, 91, 0, 0};
    const auto refused = [&](const EspFieldDef& def, const std::string& why) {
        const EspResult set = espSetField(pattern.context, pattern.surface, "flow", &def);
        CAPTURE(espLastError(pattern.context));
        CHECK(set == ESP_INVALID_ARGUMENT);
        CHECK(std::string(espLastError(pattern.context)).find(why) != std::string::npos);
    };
    EspFieldStroke stroke{ESP_FIELD_COMB, .1f, .5f, 2, good};
    EspFieldDef def = esp::defaults<EspFieldDef>();
    def.strokeCount = 1;
    refused(def, "null pointer");
    def.strokes = &stroke;
    for (const EspFieldStroke& wrong :
         {EspFieldStroke{EspFieldBrush(7), .1f, .5f, 2, good}, EspFieldStroke{ESP_FIELD_COMB, -1, .5f, 2, good},
          EspFieldStroke{ESP_FIELD_COMB, .1f, 1.5f, 2, good}, EspFieldStroke{ESP_FIELD_COMB, .1f, .5f, 2, nullptr},
          EspFieldStroke{ESP_FIELD_COMB, .1f, nan, 2, good}, EspFieldStroke{ESP_FIELD_COMB, .1f, .5f, 2, bad}}) {
        stroke = wrong;
        refused(def, "stroke 0 is out of range");
    }
    stroke = {ESP_FIELD_COMB, .1f, .5f, 2000000, good};
    refused(def, "more than 1048576 points");

    def = esp::defaults<EspFieldDef>();
    def.pointCount = 2;
    refused(def, "points need a count");
    def.points = good;
    refused(def, "either vectors or tensors");
    def.vectors = bad;
    refused(def, "isn't finite");
    def.tensors = good;
    refused(def, "either vectors or tensors");
    def.tensors = nullptr;
    def.vectors = good;
    def.pointCount = 20000000;
    refused(def, "more than 16777216 points");
    def.pointCount = 2;
    def.picture = good;
    refused(def, "a picture needs a size");
    def = esp::defaults<EspFieldDef>();
    def.picture = good;
    def.pictureWidth = 20000;
    def.pictureHeight = 1;
    refused(def, "more than 16384 texels");

    def = esp::defaults<EspFieldDef>();
    CHECK(def.passes == 300);
    def.summed = def.exact = 1;
    refused(def, "either exact or summed");
    def.exact = 0;
    def.passes = 10001;
    refused(def, "more than 10000 passes");

    // Where they lie is known when the surface is asked.
    def = esp::defaults<EspFieldDef>();
    def.points = far;
    def.vectors = good;
    def.pointCount = 2;
    const uint64_t before = pattern.stats().hash;
    REQUIRE(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_OK);
    CHECK_FALSE(pattern.update());
    CHECK(std::string(espLastError(pattern.context)).find("field 'flow': none of its 2 points") != std::string::npos);
    CHECK(pattern.stats().hash == before);
}

TEST_CASE("an exact field that a surface has too few vertices for is refused, and says so") {
    Pattern pattern;
    const EspFieldElement element{ESP_ELEMENT_WEDGE, {.3f, .3f, 0}, {1, 0, 0}, .2f};
    EspFieldDef def = esp::defaults<EspFieldDef>();
    def.elements = &element;
    def.elementCount = 1;
    uint32_t count = 0;
    REQUIRE(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_OK);
    CHECK(espFieldSingularities(pattern.context, pattern.surface, "flow", nullptr, &count) == ESP_OK);
    def.exact = 1;
    REQUIRE(espSetField(pattern.context, pattern.surface, "flow", &def) == ESP_OK);
    CHECK(espFieldSingularities(pattern.context, pattern.surface, "flow", nullptr, &count) == ESP_INVALID_CONTENT);
    CHECK(std::string(espLastError(pattern.context)).find("too few vertices") != std::string::npos);
}

TEST_CASE("another palette is taken before a grammar knows the meshes, and a wrong one changes nothing") {
    Life life;
    EspContextDef def = esp::defaults<EspContextDef>();
    def.log = silent;
    REQUIRE(espCreate(ESP_VERSION, &def, &life.context) == ESP_OK);
    CHECK(espSetPieces(life.context, "no such.glb") == ESP_IO_FAILED);
    CHECK(std::string(espLastError(life.context)).find("no such.glb") != std::string::npos);
    REQUIRE_MESSAGE(espSetPieces(life.context, ESPALIER_CONTENT "/roofs.glb") == ESP_OK, espLastError(life.context));
    const std::string scales = "A -> IC(\"scale\")", battens = "A -> IC(\"batten\")";
    EspGrammarDef text = esp::grammarDef("scales", scales);
    CHECK(espCompileGrammar(life.context, &text, &life.grammar) == ESP_INVALID_CONTENT);
    text = esp::grammarDef("battens", battens);
    REQUIRE_MESSAGE(espCompileGrammar(life.context, &text, &life.grammar) == ESP_OK, espLastError(life.context));
    CHECK(espSetPieces(life.context, nullptr) == ESP_INVALID_ARGUMENT);
    REQUIRE(espDestroyGrammar(life.context, life.grammar) == ESP_OK);
    CHECK(espSetPieces(life.context, nullptr) == ESP_OK);
    text = esp::grammarDef("scales", scales);
    CHECK(espCompileGrammar(life.context, &text, &life.grammar) == ESP_OK);
}

TEST_CASE("a field can be seen, and its singularities listed") {
    Pattern pattern;
    esp::DrawDef def;
    def.width = 64;
    def.height = 36;
    def.camera = esp::frameAll(pattern.context);
    def.look.view = ESP_VIEW_FIELD;
    def.look.viewLayer = "grain";
    CHECK(espDraw(pattern.context, &def) == ESP_INVALID_ARGUMENT);
    def.look.viewLayer = "flow";
    const auto picture = [&] {
        std::vector<uint8_t> pixels(64 * 36 * 4);
        REQUIRE_MESSAGE(espDraw(pattern.context, &def) == ESP_OK, espLastError(pattern.context));
        REQUIRE(espReadPixels(pattern.context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    };
    const auto down = picture();
    CHECK(down == picture());
    pattern.setElement(ESP_ELEMENT_REGULAR, .2f);
    REQUIRE(pattern.update());
    CHECK(down != picture());

    uint32_t count = 0;
    CHECK(espFieldSingularities(pattern.context, pattern.surface, "grain", nullptr, &count) == ESP_INVALID_ARGUMENT);
    CHECK(espFieldSingularities(pattern.context, {12345}, "flow", nullptr, &count) == ESP_INVALID_ARGUMENT);
    pattern.setElement(ESP_ELEMENT_WEDGE, .2f);
    REQUIRE(espFieldSingularities(pattern.context, pattern.surface, "flow", nullptr, &count) == ESP_OK);
    std::vector<EspSingularity> all(count);
    REQUIRE(espFieldSingularities(pattern.context, pattern.surface, "flow", all.data(), &count) == ESP_OK);
    for (const EspSingularity& s : all) CHECK(std::abs(s.index) == .5f);
}
