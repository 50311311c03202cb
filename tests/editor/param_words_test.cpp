// What labels of parameters say, the panel that shows them by groups, and parameters that leave growth as it was.
#include "tools/scene/param_words.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/widgets.hpp"

namespace param_words {

using espalier::document::SetParam;
using espalier::scene::holdsWords;
using espalier::scene::paramWords;

TEST_CASE("a label has a group, a name and a tip, of which only the name is needed") {
    const auto parts = [](const char* label) {
        const auto words = paramWords(label);
        return words.group + "|" + words.name + "|" + words.tip;
    };
    CHECK(parts("Leaves / Leaf spacing. Less is denser") == "Leaves|Leaf spacing|Less is denser");
    CHECK(parts("Leaves / Leaf size") == "Leaves|Leaf size|");
    CHECK(parts("Forks. More branch. And so on") == "|Forks|More branch. And so on");
    CHECK(parts("Scale of all lengths (a 3 m wall: 1)") == "|Scale of all lengths (a 3 m wall: 1)|");
    CHECK(parts("Twigs 1/m") == "|Twigs 1/m|");
    CHECK(parts("") == "||");
    CHECK(parts(" / . ") == "||");
}

TEST_CASE("words are found in whatever case and order, all of them") {
    CHECK(holdsWords("Leaves / Leaf size", ""));
    CHECK(holdsWords("Leaves / Leaf size", "SIZE leaf"));
    CHECK(!holdsWords("Leaves / Leaf size", "size stem"));
}

TEST_CASE("the panel shows parameters by their groups, by their names alone") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), sample::Tool::look);
    editor.frame({});
    editor.panels = [&] {
        ImGui::SetNextWindowSize({400, 4000});  // what is scrolled out of sight says nothing
        ImGui::Begin("panel");
        sample::grammarsPanel(editor.work);
        ImGui::End();
    };
    std::string words;
    const auto panels = editor.panels;
    editor.panels = [&] { words = wordsOf(panels); };
    editor.frame({});
    editor.frame({});
    const size_t stems = words.find("Stems"), twigs = words.find("Twigs"), spacing = words.find("Leaf spacing");
    REQUIRE(spacing != std::string::npos);
    CHECK(stems < twigs);
    CHECK(twigs < spacing);
    CHECK(!contains(words, "Leaves / "));
    CHECK(!contains(words, "Less is denser"));
}

TEST_CASE("gravity, hanging length and adhesion change ivy, and back at the grammar's values it is as it was") {
    const Folder folder;
    Editing editing(smallScene(folder));
    REQUIRE(editing.perform(SetParam{0, {"climb", {0}}}));
    const uint64_t before = editing.hash();
    for (const auto& [name, value] : {std::pair{"gravity", 1.f}, {"hanging", 1.f}, {"adhesion", 0.f}}) {
        const float own = editing.param(0, name);
        REQUIRE(editing.perform(SetParam{0, {name, {value}}}));
        CHECK_MESSAGE(editing.hash() != before, name);
        REQUIRE(editing.perform(SetParam{0, {name, {own}}}));
        CHECK_MESSAGE(editing.hash() == before, name);
    }
}

}  // namespace param_words
