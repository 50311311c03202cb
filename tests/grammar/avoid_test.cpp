// The statement `avoid`: how it is written, and what its value follows. It reads as `width` does (width_test.cpp).
#include "tests/grammar/support.hpp"

using namespace grammar_test;

namespace {

const std::string kStem = "A -> Marching(0.1, 0, true) {A}\n";

float distanceOf(const std::string& text) {
    RuleMap map = compiled(text);
    CHECK(toString(map.warnings()) == "");
    return map.avoid();
}
std::string refusalOf(const std::string& text) {
    Result<RuleMap> map = compileGrammar(text);
    return map ? "" : map.failure().text();
}
bool says(const std::string& text, const std::string& message) {
    return refusalOf(text).find(message) != std::string::npos;
}

}  // namespace

TEST_CASE("a grammar without a distance has 0, and one with it keeps it beside its width") {
    CHECK(distanceOf(kStem) == 0.0f);
    CHECK(distanceOf("avoid 0.25\n" + kStem) == 0.25f);
    CHECK(distanceOf(kStem + "avoid (1 + 1) * 0.5;\n") == 1.0f);
    RuleMap both = compiled("width 0.5\navoid 0.125\n" + kStem);
    CHECK(both.width() == 0.5f);
    CHECK(both.avoid() == 0.125f);
    CHECK(compiled("width 0.5\n" + kStem).avoid() == 0.0f);
    CHECK(distanceOf("param avoid = 0.3\navoid avoid\n" + kStem) == 0.3f);
    CHECK(compiled("avoid -> Marching(0.1, 0, true) {avoid}\navoid 0.5").avoid() == 0.5f);
}

TEST_CASE("the distance follows parameters, is never below 0, and is kept in files of rule maps") {
    RuleMap map =
        compiled("param apart = 0.02 [0 .. 1]\nparam scale = 2 [0 .. 10]\navoid apart * scale - 0.01\n" + kStem);
    CHECK(map.avoid() == doctest::Approx(0.03f));
    Result<RuleMap> loaded = RuleMap::load(map.save(), "test.rulemap");
    if (!loaded) FAIL(loaded.failure().text());
    CHECK(loaded->avoid() == doctest::Approx(0.03f));
    CHECK(loaded->growsAs(map));
    const float none = 0;
    for (RuleMap* one : {&map, &*loaded}) {
        one->setParam(*one->findParam("apart"), {&none, 1});
        CHECK(one->avoid() == 0.0f);
    }
    CHECK(!compiled("avoid 0.25\n" + kStem).growsAs(compiled("avoid 0.5\n" + kStem)));
}

TEST_CASE("what is wrong about a distance is told at its place") {
    CHECK(says("avoid -0.1\n" + kStem, "grammar:1:7: avoid: the distance can't be negative"));
    CHECK(says("avoid rand()\n" + kStem, "the distance may use numbers and parameters only"));
    CHECK(says("avoid = 0.1\n" + kStem, "the distance follows without '=': avoid 0.01"));
    CHECK(says("avoid 0.1\n" + kStem + "avoid 0.2", "grammar:3:1: avoid: the distance is given twice"));
    CHECK(says("avoid 0.1\nHouse -> Extrude(3) {Wall, NULL}\nWall -> Shape(\"leaf\")",
               "only stems of plants keep a distance"));
}

TEST_CASE("the shipped climbers keep no distance until somebody asks for it, and scale it") {
    for (const char* file : {"ivy_free", "ivy_guided", "ivy_path", "clematis"}) {
        CAPTURE(std::string(file));
        Result<RuleMap> map = compileGrammarFile("content/grammars/" + std::string(file) + ".grammar");
        if (!map) FAIL(map.failure().text());
        CHECK(map->avoid() == 0.0f);
        const float apart = 0.03f, scale = 4;
        map->setParam(map->findParam("apart").value(), {&apart, 1});
        CHECK(map->avoid() == doctest::Approx(0.03f));
        map->setParam(map->findParam("scale").value(), {&scale, 1});
        CHECK(map->avoid() == doctest::Approx(0.12f));
    }
}
