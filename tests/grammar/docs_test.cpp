// Every block of these pages that says it is a grammar compiles without warnings.
#include "tests/grammar/support.hpp"

using namespace grammar_test;

TEST_CASE("the manual's examples compile") {
    const std::string text = contentsOf("docs/grammar.md") + contentsOf("docs/painting.md");
    const std::string open = "```grammar\n", close = "\n```";
    int blocks = 0;
    for (size_t at = text.find(open); at != std::string::npos; at = text.find(open, at)) {
        at += open.size();
        size_t end = text.find(close, at);
        REQUIRE(end != std::string::npos);
        RuleMap map = compiled(text.substr(at, end - at));
        CHECK(toString(map.warnings()) == "");
        ++blocks;
    }
    CHECK(blocks >= 7);
}
