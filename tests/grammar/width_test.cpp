// The statement `width`: how it is written, and what its value follows.
#include "tests/grammar/support.hpp"

using namespace grammar_test;

namespace {

const std::string kMarch = "A -> Marching(0.1, 0, true) {A}\n";

float widthOf(const std::string& text) {
    RuleMap map = compiled(text);
    CHECK(toString(map.warnings()) == "");
    return map.width();
}

void set(RuleMap& map, const char* name, float value) {
    map.setParam(map.findParam(name).value(), {&value, 1});
}

}  // namespace

TEST_CASE("a grammar without a width has 0, a constant one has it, wherever it stands") {
    CHECK(widthOf(kMarch) == 0.0f);
    CHECK(widthOf("width 0.25\n" + kMarch) == 0.25f);
    CHECK(widthOf(kMarch + "width 0.25;\n") == 0.25f);
    CHECK(widthOf("width 0\n" + kMarch) == 0.0f);
    CHECK(widthOf("width (1 + 1) * 0.5 " + kMarch) == 1.0f);
    CHECK(widthOf("width -(1) + 3\n" + kMarch) == 2.0f);
    CHECK(widthOf("let half = 0.5\nwidth half * half\n" + kMarch) == 0.25f);
}

TEST_CASE("the width follows the parameters, which it uses, and is never below 0") {
    RuleMap map = compiled(
        "param thin = 0.02 [0 .. 1]\nparam scale = 1 [0 .. 10]\nlet twig = thin * scale\n"
        "width twig - 0.01\n" +
        kMarch);
    CHECK(toString(map.warnings()) == "");
    std::vector<uint32_t> words(map.words().begin(), map.words().end());
    CHECK(map.width() == doctest::Approx(0.01f));
    set(map, "scale", 3);
    CHECK(map.width() == doctest::Approx(0.05f));
    set(map, "thin", 0.5f);
    CHECK(map.width() == doctest::Approx(1.49f));
    set(map, "thin", 0);
    CHECK(map.width() == 0.0f);
    set(map, "thin", NAN);
    CHECK(map.width() == 0.0f);
    set(map, "thin", 0.02f);
    set(map, "scale", 1);
    CHECK(map.width() == doctest::Approx(0.01f));
    CHECK(std::equal(words.begin(), words.end(), map.words().begin()));  // nothing else hung on them

    RuleMap twig = compiled("param big = false\nwidth big ? 2 : 1\n" + kMarch);
    CHECK(twig.width() == 1.0f);
    set(twig, "big", 1);
    CHECK(twig.width() == 2.0f);
    RuleMap root = compiled("param x = 1 [-2 .. 2]\nwidth sqrt(x) / x\n" + kMarch);
    for (float x : {-2.0f, 0.0f, 2.0f}) {
        set(root, "x", x);
        CHECK(std::isfinite(root.width()));
        CHECK(root.width() >= 0.0f);
    }
}

TEST_CASE("rules, parameters, lets and arguments may be called width") {
    CHECK(widthOf("param width = 0.3\nwidth width\n" + kMarch) == 0.3f);
    CHECK(widthOf("let width = 0.3\nwidth width\n" + kMarch) == 0.3f);
    RuleMap map =
        compiled("A -> width(1)\nwidth(n) : n > 5 -> NULL\nwidth(n)\n  -> Marching(n, 0, true) {width(n + 1)}");
    CHECK(map.findSymbol("width"));
    CHECK(map.width() == 0.0f);
    CHECK(compiled("width -> Marching(0.1, 0, true) {width}\nwidth 0.5").width() == 0.5f);
    CHECK(compiled("width : depth > 3 -> NULL\nwidth -> Marching(0.1, 0, true) {width}").symbols().size() == 1);
    CHECK(compiled("A(width) -> Marching(0.1, width, true) {A(width)}").width() == 0.0f);
}

TEST_CASE("a width from an include is the grammar's, and a second one is refused") {
    CompileOptions options;
    options.readInclude = [](const std::string&) { return Result<std::string>("width 0.125\n"); };
    Result<RuleMap> map = compileGrammar("include \"base.grammar\"\n" + kMarch, options);
    if (!map) FAIL(map.failure().text());
    CHECK(map->width() == 0.125f);
    Result<RuleMap> twice = compileGrammar("include \"base.grammar\"\nwidth 1\n" + kMarch, options);
    REQUIRE_FALSE(twice);
    CHECK(twice.failure().text().find("the width is given twice") != std::string::npos);
}

TEST_CASE("the shipped ivies are as wide as their twigs, at any scale") {
    for (const char* file : {"content/grammars/ivy_free.grammar", "content/grammars/ivy_guided.grammar"}) {
        Result<RuleMap> map = compileGrammarFile(file);
        if (!map) FAIL(map.failure().text());
        CHECK(map->width() == 0.005f);
        set(*map, "scale", 4);
        CHECK(map->width() == doctest::Approx(0.02f));
        set(*map, "twigWidth", 0.01f);
        CHECK(map->width() == doctest::Approx(0.04f));
    }
}
