// What the compiler says of a text, as the grammar's window shows it.
#include "sample_game/remarks.hpp"
#include "tests/editor/editing.hpp"

using namespace espalier::document;
using sample::Remark;
using sample::remarksOf;

namespace {

int lineOfEnd(const std::string& text) {
    return 1 + int(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace

TEST_CASE("warnings of a text that grows stand at their lines, and go with what caused them") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const auto& grammar = editing.document->scene().grammars[0];
    const std::string good = grammar.text + "\n";
    CHECK(remarksOf(grammar).empty());
    const uint64_t before = editing.hash();

    REQUIRE(editing.perform(editing.document->withText(0, good + "param idle = 1 [0 .. 2]\n")));
    CHECK(grammar.error.empty());
    CHECK(editing.param(0, "idle") == 1);  // it isn't blocked
    std::vector<Remark> remarks = remarksOf(grammar);
    REQUIRE(remarks.size() == 1);
    CHECK(remarks[0].warning);
    CHECK(remarks[0].line == lineOfEnd(good));
    CHECK_MESSAGE(contains(remarks[0].text, "'idle' is never used"), remarks[0].text);
    CHECK(remarks[0].text.starts_with("line " + std::to_string(lineOfEnd(good)) + ":"));
    CHECK(editing.hash() == before);

    // A mistake comes first, wherever it stands, and those of what grew before are gone.
    REQUIRE(editing.perform(editing.document->withText(0, good + "param idle = 1 [0 .. 2]\nIvy -> }\n")));
    remarks = remarksOf(grammar);
    REQUIRE(!remarks.empty());
    CHECK(!remarks[0].warning);
    CHECK(remarks[0].line == lineOfEnd(good) + 1);
    CHECK(grammar.warnings.empty());

    REQUIRE(editing.perform(Undo{}));
    CHECK(remarksOf(grammar).size() == 1);
    REQUIRE(editing.perform(Undo{}));
    CHECK(remarksOf(grammar).empty());
}

TEST_CASE("remarks on files that are included, or on no place, have no line of this text") {
    espalier::scene::LoadedGrammar grammar;
    grammar.file = "/a/ivy.grammar";
    grammar.error =
        "/a/ivy.grammar:12:3: warning: Ivy: later rules stay unused\nprelude.grammar:4:1: Twig: 'x: warning: y' is "
        "not known\n/a/ivy.grammar: no rule grows\n/a/ivy.grammar:3:7: Ivy: expected ')'";
    const std::vector<Remark> remarks = remarksOf(grammar);
    REQUIRE(remarks.size() == 4);
    CHECK(remarks[0].line == 0);
    CHECK(!remarks[0].warning);
    CHECK(remarks[0].text.starts_with("prelude.grammar:4:1:"));
    CHECK(remarks[1].line == 0);
    CHECK(remarks[2].line == 3);
    CHECK(remarks[2].text == "line 3:7: in 'Ivy': expected ')'");
    CHECK(remarks[3].text == "line 12:3: warning: in 'Ivy': later rules stay unused");
    CHECK(remarks[0].text == "prelude.grammar:4:1: in 'Twig': 'x: warning: y' is not known");
    CHECK(remarks[3].line == 12);
    CHECK(remarks[3].warning);
}
