// What is coloured of a grammar's text, and what is found in it.
#include "sample_game/grammar_colours.hpp"

#include <doctest/doctest.h>

#include <string>

namespace grammar_colours {

using sample::findLine;
using sample::tokensOf;

// Each token as a letter of its kind and its text.
std::string told(const std::string& line, bool& inComment) {
    std::string all;
    for (const auto& token : tokensOf(line, inComment))
        if (token.kind != sample::TokenKind::plain)
            all += std::string(1, " cwn#t"[size_t(token.kind)]) + line.substr(token.begin, token.length) + "|";
    return all;
}

TEST_CASE("declarations, names, numbers, texts and remarks are told apart, whatever is unfinished") {
    bool in = false;
    CHECK(told("param leafSize = 0.08 [0.02 .. 0.2] \"m\" // size", in) == "wparam|#0.08|#0.02|#0.2|t\"m\"|c// size|");
    CHECK(told("Vine -> Marching(0.05, rand()) {Vine}", in) == "nVine|nMarching|#0.05|nVine|");
    CHECK(told("param green = #4a7c2f \"open", in) == "wparam|t#4a7c2f|t\"open|");
    CHECK(told("\"", in) == "t\"|");
    CHECK(told("", in).empty());
    CHECK(!in);
    CHECK(told("a /* one", in) == "c/* one|");
    CHECK(in);
    CHECK(told("still", in) == "cstill|");
    CHECK(told("end */ Vine", in) == "cend */|nVine|");
    CHECK(!in);
    CHECK(told("/*/ no end", in) == "c/*/ no end|");
    CHECK(in);
}

TEST_CASE("a word is found behind the cursor, then from the beginning, in whatever case") {
    const std::string text = "Ivy -> Stem\nLeaf -> S(1)\nstem -> Leaf";
    CHECK(findLine(text, "STEM", 0) == 1);
    CHECK(findLine(text, "stem", 1) == 3);
    CHECK(findLine(text, "stem", 3) == 1);
    CHECK(findLine(text, "pebble", 0) == 0);
    CHECK(findLine(text, "", 0) == 0);
    CHECK(findLine("", "a", 0) == 0);
}

}  // namespace grammar_colours
