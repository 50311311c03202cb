// Looks of terminals: what a host chooses in place of the shipped meshes, and what it can't choose.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <vector>

#include "tests/plugin/life.hpp"
#include "tests/support/scratch_folder.hpp"

namespace espalier::looks {
namespace {

using Pixels = std::vector<uint8_t>;

std::string contentFile(const char* name) {
    return std::string(ESPALIER_CONTENT) + "/" + name;
}

struct Grown : Life {
    Grown() {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = silent;
        REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
        REQUIRE((load() && compile() && plant(4) && plant(6) && update()));
    }
    EspResult set(const char* terminal, const EspTerminalLook* look) {
        return espSetTerminalLook(context, grammar, terminal, look);
    }
    EspResult colour(const char* terminal, float r, float g, float b) {
        EspTerminalLook look = {};
        look.coloured = 1;
        look.colour[0] = r, look.colour[1] = g, look.colour[2] = b;
        return set(terminal, &look);
    }
    std::string error() const { return espLastError(context); }
    Pixels picture() {
        REQUIRE(update());
        esp::DrawDef def;
        def.width = 320;
        def.height = 240;
        def.camera = esp::frameAll(context);
        // The first picture after a change may fade levels of detail.
        for (int i = 0; i < 2; ++i) REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, error());
        Pixels pixels(size_t(def.width) * def.height * 4);
        REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    }
};

// Pixels that are clearly redder than green and blue, or bluer.
size_t count(const Pixels& pixels, size_t most) {
    size_t found = 0;
    for (size_t i = 0; i < pixels.size(); i += 4) {
        bool clear = true;
        for (size_t c = 0; c < 3; ++c) clear = clear && (c == most || pixels[i + most] > pixels[i + c] + 40);
        found += clear;
    }
    return found;
}
constexpr size_t kRed = 0, kBlue = 2;

}  // namespace

TEST_CASE("a grammar's leaves take a colour, no stem moves, and they are as shipped again to the bit") {
    Grown grown;
    CHECK(espTerminalCount(grown.context, grown.grammar) == 2);
    CHECK(std::string(espTerminalName(grown.context, grown.grammar, 0)) == "bark");
    CHECK(std::string(espTerminalName(grown.context, grown.grammar, 1)) == "leaf");
    CHECK(std::string(espTerminalName(grown.context, grown.grammar, 2)).empty());
    const Pixels before = grown.picture();
    const EspStats stats = grown.stats();
    CHECK(count(before, kRed) == 0);
    REQUIRE_MESSAGE(grown.colour("leaf", .8f, .02f, .02f) == ESP_OK, grown.error());
    const Pixels red = grown.picture();
    CHECK(count(red, kRed) > 300);
    CHECK(grown.stats().nodes == stats.nodes);
    CHECK(grown.stats().leaves == stats.leaves);
    REQUIRE(grown.colour("leaf", .05f, .05f, .8f) == ESP_OK);
    CHECK(count(grown.picture(), kRed) == 0);
    CHECK(count(grown.picture(), kBlue) > 300);
    REQUIRE(grown.set("leaf", nullptr) == ESP_OK);
    CHECK(grown.picture() == before);
    CHECK(grown.stats().hash == stats.hash);
}

TEST_CASE("bark takes a colour by itself, and looks outlive another text and go with their grammar") {
    Grown grown;
    REQUIRE_MESSAGE(grown.colour("bark", .7f, .02f, .02f) == ESP_OK, grown.error());
    REQUIRE(grown.colour("leaf", .05f, .05f, .8f) == ESP_OK);
    const Pixels both = grown.picture();
    CHECK(count(both, kRed) > 10);
    CHECK(count(both, kBlue) > 300);
    std::string text = kLifeIvy;
    text.replace(text.find("S(0.01)"), 7, "S(0.03)");
    const EspGrammarDef def = esp::grammarDef("ivy", text);
    REQUIRE(espRecompileGrammar(grown.context, grown.grammar, &def) == ESP_OK);
    const Pixels thick = grown.picture();
    CHECK(count(thick, kRed) > 2 * count(both, kRed));
    CHECK(count(thick, kBlue) > 300);
    // Each grammar has its own.
    EspGrammar other{};
    const EspGrammarDef second = esp::grammarDef("other", kLifeIvy);
    REQUIRE(espCompileGrammar(grown.context, &second, &other) == ESP_OK);
    REQUIRE(espDestroyGrammar(grown.context, grown.grammar) == ESP_OK);
    grown.grammar = other;
    REQUIRE((grown.plant(4) && grown.plant(6)));
    CHECK(count(grown.picture(), kRed) == 0);
    CHECK(count(grown.picture(), kBlue) == 0);
}

TEST_CASE("leaves take meshes of a file and a picture") {
    Grown grown;
    const Pixels before = grown.picture();
    const std::string meshes = contentFile("pieces.glb"), mask = contentFile("mask.png");
    EspTerminalLook look = {};
    look.mesh = meshes.c_str();
    REQUIRE_MESSAGE(grown.set("leaf", &look) == ESP_OK, grown.error());
    const Pixels pieces = grown.picture();
    CHECK(pieces != before);
    look.mesh = nullptr;
    look.picture = mask.c_str();
    REQUIRE_MESSAGE(grown.set("leaf", &look) == ESP_OK, grown.error());
    const Pixels cards = grown.picture();
    CHECK(cards != before);
    CHECK(cards != pieces);
    REQUIRE_MESSAGE(grown.set("bark", &look) == ESP_OK, grown.error());
    CHECK(grown.picture() != cards);
    // What goes out to other programs is what is seen.
    EspPartsInfo parts;
    const EspPartsDef all = esp::defaults<EspPartsDef>();
    REQUIRE_MESSAGE(espReadParts(grown.context, &all, &parts) == ESP_OK, grown.error());
    bool card = false;
    for (uint32_t i = 0; i < parts.parts; ++i) {
        EspPartInfo info;
        REQUIRE(espPartInfo(grown.context, i, &info) == ESP_OK);
        card = card || std::string(info.name).starts_with("card");
    }
    CHECK(card);
}

TEST_CASE("a look that can't be is refused with its cause, and what is drawn stays") {
    const test::ScratchFolder folder;
    Grown grown;
    REQUIRE(grown.colour("leaf", .8f, .02f, .02f) == ESP_OK);
    const Pixels before = grown.picture();
    const auto refuses = [&](EspResult expected, const char* terminal, const EspTerminalLook& look, const char* told) {
        CHECK(grown.set(terminal, &look) == expected);
        CHECK_MESSAGE(grown.error().find(told) != std::string::npos, grown.error());
    };
    EspTerminalLook look = {};
    refuses(ESP_INVALID_ARGUMENT, "petal", look, "petal");
    refuses(ESP_INVALID_ARGUMENT, nullptr, look, "there is no terminal");
    const std::string meshes = contentFile("pieces.glb"), gone = folder.file("gone.glb"),
                      torn = folder.file("torn.glb");
    std::ofstream(torn) << "glTF and no more";
    look.mesh = meshes.c_str();
    refuses(ESP_INVALID_ARGUMENT, "bark", look, "bark");
    look.mesh = gone.c_str();
    refuses(ESP_IO_FAILED, "leaf", look, "gone.glb");
    look.mesh = torn.c_str();
    refuses(ESP_INVALID_CONTENT, "leaf", look, "torn.glb");
    look.mesh = nullptr;
    look.picture = torn.c_str();
    refuses(ESP_INVALID_CONTENT, "leaf", look, "torn.glb");
    EspTerminalLook bright = {};
    bright.coloured = 1;
    bright.colour[1] = 2;
    refuses(ESP_INVALID_ARGUMENT, "leaf", bright, "colour");
    CHECK(espSetTerminalLook(grown.context, EspGrammar{}, "leaf", &bright) == ESP_INVALID_ARGUMENT);
    CHECK(espSetTerminalLook(nullptr, grown.grammar, "leaf", &bright) == ESP_INVALID_ARGUMENT);
    CHECK(espTerminalCount(grown.context, EspGrammar{}) == 0);
    CHECK(grown.picture() == before);
}

TEST_CASE("there is room for the leaves of some grammars, and the next is told that there is no more") {
    Grown grown;
    EspTerminalLook look = {};
    const std::string mask = contentFile("mask.png");
    look.picture = mask.c_str();
    std::vector<EspGrammar> grammars{grown.grammar};
    for (int i = 0; i < 5; ++i) {
        const EspGrammarDef def = esp::grammarDef("another", kLifeIvy);
        REQUIRE(espCompileGrammar(grown.context, &def, &grammars.emplace_back()) == ESP_OK);
    }
    for (size_t i = 0; i < 5; ++i)
        REQUIRE_MESSAGE(espSetTerminalLook(grown.context, grammars[i], "leaf", &look) == ESP_OK, grown.error());
    CHECK(espSetTerminalLook(grown.context, grammars[5], "leaf", &look) == ESP_INVALID_ARGUMENT);
    CHECK(grown.error().find("five grammars") != std::string::npos);
    REQUIRE(espSetTerminalLook(grown.context, grammars[0], "leaf", nullptr) == ESP_OK);
    CHECK(espSetTerminalLook(grown.context, grammars[5], "leaf", &look) == ESP_OK);
    REQUIRE(grown.update());
}

}  // namespace espalier::looks
