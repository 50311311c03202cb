// Names that the grammar's window offers while one types.
#include <doctest/doctest.h>

#include "sample_game/grammar_completion.hpp"

using namespace sample;

namespace completion {
namespace {

const std::vector<Completion> kWords{{"max", "max(a, b)"},
                                     {"Marching", "Marching(length, angle, condition) {T, E}"},
                                     {"mix", "mix(a, b, t)"},
                                     {"arc", ""}};
constexpr const char* kText =
    "param maturity = 0.5 [0 .. 1] \"\" \"How old it is\"\n"
    "context mask = 1 \"Where it grows\"\n"
    "// marble isn't a name\n"
    "Main -> Marching(maturity, 0, mask(texCoord) > ma";

std::vector<std::string> namesAt(std::string text, size_t cursor) {
    std::vector<std::string> names;
    for (const Completion& found : completionsOf(text, cursor, kWords)) names.push_back(found.name);
    return names;
}

}  // namespace

TEST_CASE("letters are completed by names of the text, then by words of the language") {
    const std::string text = kText;
    CHECK(lettersBefore(text, text.size()) == 2);
    const std::vector<Completion> found = completionsOf(text, text.size(), kWords);
    REQUIRE(found.size() == 5);
    CHECK(found[0] == Completion{"Main", "rule"});
    CHECK(found[1] == Completion{"mask", "context: Where it grows"});
    CHECK(found[2] == Completion{"maturity", "param: How old it is"});
    CHECK(found[3].name == "Marching");
    CHECK(found[4] == Completion{"max", "max(a, b)"});
    CHECK(insertedBy(found[4]) == "max(");
    CHECK(insertedBy(found[2]) == "maturity");
}

TEST_CASE("what is typed in full, what stands in a remark or a text, and what begins nothing is offered nothing") {
    CHECK(namesAt("arc", 3).empty());
    CHECK(namesAt("x -> ar", 7) == std::vector<std::string>{"arc"});
    CHECK(namesAt("// ma", 5).empty());
    CHECK(namesAt("param a = 1 \"ma", 15).empty());
    CHECK(namesAt("zz", 2).empty());
    CHECK(namesAt("a ", 2).empty());
    CHECK(namesAt("", 0).empty());
    CHECK(namesAt("12", 2).empty());
    // In the middle of a name its letters before the cursor count.
    CHECK(namesAt("marx", 2) == std::vector<std::string>{"Marching", "max"});
}

}  // namespace completion
