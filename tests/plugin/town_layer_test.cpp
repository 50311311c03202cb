// What is painted over a town and what is painted on surfaces.
#include <algorithm>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace {

void dab(EspContext* context, const char* layer) {
    stroke(context, brushOn(layer, 3), {{.5f, .5f, 0}, {0, 0, 1}, 1});
}

}  // namespace

TEST_CASE("a layer that roofs alone read is painted over the town, and on surfaces once plants read it") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    EspContext* context = life.context;
    constexpr const char* kTown = "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}";
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kTown;
    town.length = std::strlen(kTown);
    town.grammar = compiled(context, "roofs",
                            "context decay = 0\ncontext moss = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
                            "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
                            "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\n"
                            "Tile -> Drop(decay) Moss(moss) Shape(\"slate\")\n");
    REQUIRE(espLoadTown(context, &town) == ESP_OK);
    EspStroke filled{};
    dab(context, "decay");
    REQUIRE(espFillLayer(context, "moss", .5f, &filled) == ESP_OK);
    CHECK(espTownLayerCount(context) == 2);
    CHECK(espPaintedLayerCount(context) == 0);
    dab(context, "mask");  // nobody's: a surface's, for who will read it
    CHECK(espPaintedLayerCount(context) == 1);
    compiled(context, "ivy", "context decay = 0\nA -> Marching(0.1, 0, decay(texCoord) > 0.5) {A}\n");
    dab(context, "decay");
    CHECK(espPaintedLayerCount(context) == 2);
}

TEST_CASE("a layer that was set over a town without a grammar is filled and painted") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    EspContext* context = life.context;
    load(context, {}, "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}");
    const float half = .5f;
    REQUIRE(espSetTownLayer(context, "x", &half, 1, 1, nullptr) == ESP_OK);
    EspStroke filled{};
    REQUIRE(espFillLayer(context, "x", 1, &filled) == ESP_OK);
    CHECK(std::ranges::all_of(layerOf(context, "x"), [](float v) { return v == 1; }));
    CHECK(espPaintedLayerCount(context) == 0);
    EspBrush brush = brushOn("x", 3);
    brush.value = 0;
    stroke(context, brush, {{5, 0, -4}, {0, 1, 0}, 1});
    CHECK(std::ranges::any_of(layerOf(context, "x"), [](float v) { return v < 1; }));
    REQUIRE(espUpdate(context) == ESP_OK);
}

TEST_CASE("a stroke that goes on over another town takes back what it did to that one") {
    const Bare host;
    EspContext* context = host.context;
    const EspGrammar roofs = compiled(context, "roofs", kDecaying);
    load(context, roofs, "{\"buildings\": [{\"id\": \"a\", \"outer\": [[0,0],[400,0],[400,8],[0,8]]}]}");
    REQUIRE(espUpdate(context) == ESP_OK);
    const EspBrush brush = brushOn("decay", 3);
    EspStroke stroke{};
    REQUIRE(espBeginStroke(context, &brush, &stroke) == ESP_OK);
    const EspDab far = {{390, 0, -4}, {0, 1, 0}, 1}, near = {{5, 0, -4}, {0, 1, 0}, 1};
    REQUIRE(espStrokeDabs(context, stroke, &far, 1) == ESP_OK);
    load(context, roofs, "{\"buildings\": [{\"id\": \"b\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}");
    REQUIRE(espUpdate(context) == ESP_OK);
    const std::vector<float> before = layerOf(context, "decay");
    REQUIRE(espStrokeDabs(context, stroke, &near, 1) == ESP_OK);
    CHECK(layerOf(context, "decay") != before);
    REQUIRE(espEndStroke(context, stroke) == ESP_OK);
    REQUIRE(espSwapStroke(context, stroke) == ESP_OK);
    CHECK(layerOf(context, "decay") == before);
}

TEST_CASE("over a town a layer has the value that the town's grammar wants, whatever plants want") {
    const Bare host;
    EspContext* context = host.context;
    compiled(context, "ivy", "context decay = 1\nA -> Marching(0.1, 0, decay(texCoord) > 0.5) {A}\n");
    load(context, compiled(context, "roofs", kDecaying),
         "{\"buildings\": [{\"id\": \"b\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}");
    const std::vector<float> bare = layerOf(context, "decay");
    CHECK(bare == std::vector<float>(bare.size(), 0.f));
    const float half = .5f;
    EspStroke imported{};
    REQUIRE(espSetTownLayer(context, "decay", &half, 1, 1, &imported) == ESP_OK);
    CHECK(layerOf(context, "decay") != bare);
    EspBrush brush = brushOn("decay", 100);
    brush.mode = ESP_BRUSH_ERASE;
    brush.strength = brush.hardness = 1;
    const EspStroke erased = stroke(context, brush, {{5, 0, -4}, {0, 1, 0}, 1});
    CHECK(layerOf(context, "decay") == bare);
    REQUIRE(espSwapStroke(context, erased) == ESP_OK);
    REQUIRE(espSwapStroke(context, imported) == ESP_OK);
    CHECK(layerOf(context, "decay") == bare);
}

TEST_CASE("a house that grows to nothing has no triangles any more") {
    const Bare host;
    EspContext* context = host.context;
    const EspGrammar roofs = compiled(context, "roofs",
                                      "context decay = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
                                      "Top : decay(house) > 0.5 -> NULL\n"
                                      "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
                                      "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Shape(\"slate\")\n");
    load(context, roofs,
         "{\"buildings\": [{\"id\": \"a\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]},"
         " {\"id\": \"b\", \"outer\": [[40,0],[50,0],[50,8],[40,8]]}]}");
    const auto triangles = [&] {
        EspTriangles made{};
        REQUIRE(espUpdate(context) == ESP_OK);
        REQUIRE(espMaterialise(context, &made) == ESP_OK);
        return made.indexCount / 3;
    };
    const size_t two = triangles();
    REQUIRE(two > 1000);
    EspBrush brush = brushOn("decay", 12);
    brush.strength = brush.hardness = 1;
    stroke(context, brush, {{5, 0, -4}, {0, 1, 0}, 1});
    CHECK(triangles() == two / 2);
}

namespace {

// A house that has its roof where `decay` is small over it, in the mean.
const std::string kHiding =
    "context decay = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\nTop : decay(house) > 0.5 -> NULL\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Shape(\"slate\")\n";

// Two houses far from each other.
struct Hiding : Bare {
    EspGrammar roofs{};
    Hiding() {
        roofs = compiled(context, "roofs", kHiding);
        load(context, roofs,
             "{\"buildings\": [{\"id\": \"a\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]},"
             " {\"id\": \"b\", \"outer\": [[40,0],[50,0],[50,8],[40,8]]}]}");
    }
    size_t triangles() const {
        EspTriangles made{};
        REQUIRE(espUpdate(context) == ESP_OK);
        REQUIRE(espMaterialise(context, &made) == ESP_OK);
        return made.indexCount / 3;
    }
    void swap(EspStroke stroke) const { REQUIRE(espSwapStroke(context, stroke) == ESP_OK); }
    EspStroke hideFirst() const {
        EspBrush brush = brushOn("decay", 12);
        brush.strength = brush.hardness = 1;
        return stroke(context, brush, {{5, 0, -4}, {0, 1, 0}, 1});
    }
    void wantElsewhere(const char* fill) const {
        std::string text = kHiding;
        text.replace(text.find("decay = 0"), 9, std::string("decay = ") + fill);
        const EspGrammarDef def = esp::grammarDef("roofs", text);
        REQUIRE(espRecompileGrammar(context, roofs, &def) == ESP_OK);
    }
};

}  // namespace

TEST_CASE("a town's layer that a stroke, a fill or an import made goes when that is undone, and comes back as it was") {
    const Hiding host;
    const size_t whole = host.triangles();
    REQUIRE(whole > 1000);
    EspStroke made{};
    size_t left = 0;
    SUBCASE("a stroke") {
        made = host.hideFirst();
        left = whole / 2;
    }
    SUBCASE("a fill") {
        REQUIRE(espFillLayer(host.context, "decay", 1, &made) == ESP_OK);
    }
    SUBCASE("an import") {
        const float one = 1;
        REQUIRE(espSetTownLayer(host.context, "decay", &one, 1, 1, &made) == ESP_OK);
    }
    CHECK(espStrokePainted(host.context, made, {}) == 1);
    CHECK(host.triangles() == left);
    const std::vector<float> painted = layerOf(host.context, "decay");
    for (int i = 0; i < 2; ++i) {
        host.swap(made);
        CHECK(espTownLayerCount(host.context) == 0);
        CHECK(host.triangles() == whole);
        host.swap(made);
        CHECK(espTownLayerCount(host.context) == 1);
        CHECK(layerOf(host.context, "decay") == painted);
        CHECK(host.triangles() == left);
    }
    // Undone, roofs read what the grammar says, whatever that was when the layer was made; done again they don't.
    host.swap(made);
    host.wantElsewhere("1");
    CHECK(host.triangles() == 0);
    host.swap(made);
    CHECK(host.triangles() == left);
    host.swap(made);
    CHECK(host.triangles() == 0);
}

TEST_CASE("a town's layer that a stroke made stays where something else is painted on it") {
    const Hiding host;
    const size_t whole = host.triangles();
    const EspStroke first = host.hideFirst();
    const EspDab far = {{45, 0, -4}, {0, 1, 0}, 1};
    SUBCASE("which is undone first") {
        const EspStroke later = stroke(host.context, brushOn("decay", 3), far);
        host.swap(later);
        CHECK(espTownLayerCount(host.context) == 1);
        host.swap(first);
        CHECK(espTownLayerCount(host.context) == 0);
        host.swap(first);
        host.swap(later);
        CHECK(espTownLayerCount(host.context) == 1);
        CHECK(host.triangles() == whole / 2);
    }
    SUBCASE("which can't be undone") {
        REQUIRE(espDestroyStroke(host.context, stroke(host.context, brushOn("decay", 3), far)) == ESP_OK);
        host.swap(first);
        CHECK(espTownLayerCount(host.context) == 1);
        CHECK(host.triangles() == whole);
    }
    SUBCASE("or it was set") {
        const float half = .5f;
        REQUIRE(espSetTownLayer(host.context, "decay", &half, 1, 1, nullptr) == ESP_OK);
        host.swap(first);
        CHECK(espTownLayerCount(host.context) == 1);
    }
    SUBCASE("which a stroke that changed nothing isn't") {
        EspBrush brush = brushOn("decay", 3);
        brush.value = 0;
        CHECK(espStrokeBytes(host.context, stroke(host.context, brush, far)) == 0);
        host.swap(first);
        CHECK(espTownLayerCount(host.context) == 0);
    }
}
