// What a town's roofs are while nothing new of them has grown: as they stand, whatever is asked for.
#include <algorithm>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace {

// Two houses whose tiles go where `decay` is painted, and beside it a layer that nothing reads.
const std::string kHead = "context decay = 0\ncontext moss = 0\n";
const std::string kRules =
    "House -> Extrude(wallHeight) {NULL, Top}\nTop -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Drop(decay) Shape(\"slate\")\n";
const std::string kEndless = "House -> Extrude(1) {Box, NULL}\nBox -> Extrude(1) {Box, Box}\n";

struct Houses : Bare {
    EspGrammar roofs{};
    Houses() {
        roofs = compiled(context, "roofs", kHead + kRules);
        load(context, roofs,
             "{\"buildings\": [{\"id\": \"a\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]},"
             " {\"id\": \"b\", \"outer\": [[40,0],[50,0],[50,8],[40,8]]}]}");
        update(ESP_OK);
    }
    void update(EspResult expected) const {
        const EspResult got = espUpdate(context);
        REQUIRE_MESSAGE(got == expected, espLastError(context));
    }
    void ask(const std::string& text) const {
        const EspGrammarDef def = esp::grammarDef("roofs", text);
        REQUIRE_MESSAGE(espRecompileGrammar(context, roofs, &def) == ESP_OK, espLastError(context));
    }
    std::vector<std::byte> triangles() const {
        EspTriangles made{};
        REQUIRE(espMaterialise(context, &made) == ESP_OK);
        const auto* bytes = static_cast<const std::byte*>(made.vertices);
        return {bytes, bytes + made.vertexCount * 16};
    }
    std::vector<uint8_t> picture(const EspCamera& camera) const {
        esp::DrawDef def;
        def.width = 160;
        def.height = 90;
        def.camera = camera;
        REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, espLastError(context));
        std::vector<uint8_t> pixels(size_t(def.width) * def.height * 4);
        REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    }
    EspRoofStats stats() const {
        EspRoofStats roofStats;
        REQUIRE(espReadRoofStats(context, &roofStats) == ESP_OK);
        return roofStats;
    }
};

EspHouseDef hipped() {
    EspHouseDef def{};
    def.shape = ESP_ROOF_HIP;
    return def;
}

}  // namespace

TEST_CASE("where a town's growth fails its roofs are drawn and given as triangles as they stood, layers and all") {
    const Houses host;
    const EspHouseDef hip = hipped();
    REQUIRE(espSetHouse(host.context, 1, &hip) == ESP_OK);  // grown behind the others
    stroke(host.context, brushOn("moss", 3), {{5, 0, -4}, {0, 1, 0}, 1});
    host.update(ESP_OK);
    const EspCamera camera = esp::frameAll(host.context);
    const std::vector<uint8_t> before = host.picture(camera);
    const std::vector<std::byte> stood = host.triangles();
    REQUIRE(stood.size() > 16000);
    SUBCASE("by a text that wants a layer otherwise") {
        host.ask("context decay = 1\ncontext moss = 0\n" + kEndless);
    }
    SUBCASE("by one that names layers in another order") {
        host.ask("context moss = 0\ncontext decay = 0\n" + kEndless);
    }
    for (int i = 0; i < 2; ++i) {
        host.update(ESP_INVALID_CONTENT);
        CHECK(host.picture(camera) == before);
        CHECK(host.triangles() == stood);
    }
    host.ask(kHead + kRules);
    host.update(ESP_OK);
    CHECK(host.picture(camera) == before);
}

TEST_CASE("a text that hasn't grown yet changes no triangles") {
    const Houses host;
    const std::vector<std::byte> stood = host.triangles();
    host.ask("context decay = 1\n" + kRules);
    CHECK(host.triangles() == stood);
    host.update(ESP_OK);
    CHECK(host.triangles().size() < stood.size() / 2);
}

TEST_CASE("a house beyond the square of its town's layers reads their border, whether it grows alone or with all") {
    const Houses host;
    host.ask("context decay = 1\nHouse -> Extrude(wallHeight * decay(house)) {Wall, NULL}\nWall -> Shape(\"slate\")\n");
    host.update(ESP_OK);
    const uint64_t bare = host.stats().hash;
    EspHouseInfo info{};
    REQUIRE(espHouseInfo(host.context, 1, &info) == ESP_OK);
    std::vector<float> corners(size_t(2) * info.cornerCount);
    REQUIRE(espHouseShape(host.context, 1, corners.data(), nullptr) == ESP_OK);
    for (size_t i = 1; i < corners.size(); i += 2) corners[i] -= 200;
    EspHouseDef moved{};
    moved.corners = corners.data();
    moved.cornerCount = info.cornerCount;
    REQUIRE_MESSAGE(espSetHouse(host.context, 1, &moved) == ESP_OK, espLastError(host.context));
    host.update(ESP_OK);
    const uint64_t away = host.stats().hash;
    CHECK(away != bare);
    // Painted far from it, with what is there already.
    EspBrush brush = brushOn("decay", 1);
    brush.value = 1;
    stroke(host.context, brush, {{20, 0, -4}, {0, 1, 0}, 1});
    const float whole = 1;
    REQUIRE(espSetTownLayer(host.context, "decay", &whole, 1, 1, nullptr) == ESP_OK);
    host.update(ESP_OK);
    CHECK(host.stats().hash == away);
    REQUIRE(espSetTownGrammar(host.context, host.roofs) == ESP_OK);  // all anew
    host.update(ESP_OK);
    CHECK(host.stats().hash == away);
}

TEST_CASE("a layer that went with its stroke's undoing and comes again shows nothing of before") {
    const EspDab first = {{5, 0, -4}, {0, 1, 0}, 1}, second = {{45, 0, -4}, {0, 1, 0}, 1};
    EspBrush brush = brushOn("decay", 3);
    brush.strength = brush.hardness = 1;
    std::vector<std::vector<uint8_t>> pictures;
    for (const bool before : {false, true}) {
        const Houses host;
        if (before) {
            const EspStroke undone = stroke(host.context, brush, first);
            host.update(ESP_OK);
            REQUIRE(espSwapStroke(host.context, undone) == ESP_OK);
            REQUIRE(espTownLayerCount(host.context) == 0);
            host.update(ESP_OK);
        }
        const EspCamera camera = esp::frameAll(host.context);
        pictures.push_back(host.picture(camera));
        stroke(host.context, brush, second);
        host.update(ESP_OK);
        pictures.push_back(host.picture(camera));
    }
    CHECK(pictures[0] != pictures[1]);
    CHECK(pictures[2] == pictures[0]);
    CHECK(pictures[3] == pictures[1]);
}

TEST_CASE("of roofs whose grammar is gone nothing is told") {
    const Houses host;
    REQUIRE(host.stats().tiles > 0);
    REQUIRE(espDestroyGrammar(host.context, host.roofs) == ESP_OK);
    EspGrammar grammar{};
    REQUIRE(espTownGrammar(host.context, &grammar) == ESP_OK);
    CHECK(grammar.id == 0);
    host.update(ESP_OK);
    CHECK(host.stats().tiles == 0);
    CHECK(host.stats().hash == 0);
    CHECK(host.stats().houses == 2);
}

TEST_CASE("a stroke that reaches nothing of a town makes no layer over it") {
    const Houses host;
    const EspBrush brush = brushOn("decay", 3);
    EspStroke made{};
    REQUIRE(espBeginStroke(host.context, &brush, &made) == ESP_OK);
    const EspDab away = {{5000, 0, 0}, {0, 1, 0}, 1}, over = {{5, 0, -4}, {0, 1, 0}, 1};
    REQUIRE(espStrokeDabs(host.context, made, nullptr, 0) == ESP_OK);
    REQUIRE(espStrokeDabs(host.context, made, &away, 1) == ESP_OK);
    CHECK(espTownLayerCount(host.context) == 0);
    REQUIRE(espStrokeDabs(host.context, made, &over, 1) == ESP_OK);
    CHECK(espTownLayerCount(host.context) == 1);
    REQUIRE(espEndStroke(host.context, made) == ESP_OK);
}

TEST_CASE("a grammar that is refused leaves no layers behind") {
    const Bare host;
    const auto reading = [](const std::string& prefix) {
        std::string contexts, condition;
        for (int i = 0; i < 10; ++i) {
            const std::string name = prefix + std::to_string(i);
            contexts += "context " + name + " = 1\n";
            condition += (i > 0 ? " && " : "") + name + "(texCoord) > 0.5";
        }
        return contexts + "A -> Marching(0.1, 0, " + condition + ") {A}\n";
    };
    (void)compiled(host.context, "first", reading("a"));
    const std::string text = reading("b");  // more than there are layers
    const EspGrammarDef second = esp::grammarDef("second", text);
    EspGrammar refused{};
    REQUIRE(espCompileGrammar(host.context, &second, &refused) == ESP_INVALID_CONTENT);
    esp::DrawDef draw;
    draw.width = draw.height = 16;
    draw.camera = esp::frameAll(host.context);
    draw.look.view = ESP_VIEW_LAYER;
    for (const auto& [layer, result] : {std::pair("a3", ESP_OK), {"b3", ESP_INVALID_ARGUMENT}}) {
        draw.look.viewLayer = layer;
        CHECK(espDraw(host.context, &draw) == result);
    }
}
