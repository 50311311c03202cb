// Leaves, bark and blossoms of the user's own: chosen in the panel, saved, recorded, taken back.
#include "sample_game/dialogue.hpp"
#include "sample_game/model_bake.hpp"
#include "sample_game/panels.hpp"
#include "tests/editor/widgets.hpp"
#include "tools/document/project.hpp"

namespace looks {
namespace {

using namespace espalier::document;
using espalier::scene::TerminalLook;

const std::vector<float> kRed{.7f, .05f, .05f};

SetLook red(const char* terminal) {
    return {0, terminal, "", "", kRed};
}

// A leaf that stands, of two triangles.
std::string leaf(const Folder& folder) {
    return folder.write("leaf.obj", "v -.2 0 0\nv .2 0 0\nv .2 1 0\nv -.2 1 0\nf 1 2 3 4\n");
}

std::string terminal(const Folder& folder) {
    const Ran baked =
        run(program("espalier-bake") + " -q --terminal -o " + folder.file("leaf.terminal.glb") + " " + leaf(folder));
    REQUIRE_MESSAGE(baked.code == 0, baked.output);
    return folder.file("leaf.terminal.glb");
}

}  // namespace

TEST_CASE("a look is one step of undo, a drag of its colour too, and undo gives back the same plants to the bit") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const uint64_t before = editing.hash();
    REQUIRE_MESSAGE(editing.perform(red("leaf"), 7), editing.error);
    SetLook darker = red("leaf");
    darker.colour[0] = .3f;
    REQUIRE(editing.perform(darker, 7));
    CHECK(editing.document->undoSteps() == 1);
    CHECK(std::string(editing.document->undoName()) == "Look of leaf (ivy_guided)");
    CHECK(editing.hash() != before);  // leaves are of another kind
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.document->scene().grammars[0].looks.empty());
    CHECK(editing.hash() == before);
    REQUIRE(editing.perform(Redo{}));
    REQUIRE(editing.document->scene().grammars[0].looks.size() == 1);
    CHECK(editing.document->scene().grammars[0].looks[0].colour == darker.colour);
    CHECK(!editing.perform(SetLook{9, "leaf"}));
    CHECK(contains(editing.error, "no grammar 9"));
    CHECK(!editing.perform(SetLook{0, "leaf", folder.file("gone.glb")}));
    CHECK(contains(editing.error, "gone.glb"));
    CHECK(editing.document->undoSteps() == 1);
}

TEST_CASE("a project keeps looks, and opens with a note where a file of theirs is lost") {
    const Folder folder;
    const std::string mesh = terminal(folder);
    uint64_t hash = 0;
    {
        Editing editing(smallScene(folder));
        REQUIRE_MESSAGE(editing.perform(SetLook{0, "leaf", mesh, "", {}}), editing.error);
        REQUIRE(editing.perform(red("bark")));
        hash = editing.hash();
        REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
        CHECK(contains(readAll(folder.path / "saved/project.json"), "\"../leaf.terminal.glb\""));
    }
    {
        Editing again(folder.file("saved"));
        const auto& looks = again.document->scene().grammars[0].looks;
        REQUIRE(looks.size() == 2);
        CHECK(looks[0] == TerminalLook{"bark", "", "", kRed});
        CHECK(looks[1] == TerminalLook{"leaf", mesh, "", {}});
        CHECK(again.hash() == hash);
    }
    std::filesystem::remove(mesh);
    Editing lost(folder.file("saved"));
    REQUIRE(lost.document->scene().notes.size() == 1);
    CHECK(contains(lost.document->scene().notes[0], "leaf.terminal.glb"));
    CHECK(contains(lost.document->scene().notes[0], "looks as shipped"));
    CHECK(lost.document->scene().grammars[0].looks.size() == 2);  // and keeps what it was
}

TEST_CASE("a scene names looks; what is wrong with one is told by its place") {
    const Folder folder;
    const auto scene = [&](const std::string& looks) {
        return folder.write("scene.json", R"({"surface": ")" + smallSurface() + R"(", "grammars": [{"file": ")" +
                                              content("grammars/ivy_guided.grammar") + R"(", "looks": )" + looks +
                                              "}]}");
    };
    Editing good(scene(R"({"leaf": {"picture": ")" + content("mask.png") + R"(", "colour": [0.5, 0.2, 0.1]}})"));
    REQUIRE(good.document->scene().grammars[0].looks.size() == 1);
    const auto refuses = [&](const std::string& looks, const char* told) {
        espalier::scene::Scene out;
        espalier::scene::Request request;
        request.file = scene(looks);
        std::string error;
        CHECK(!openScene(good.context.get(), request, out, error));
        CHECK_MESSAGE(contains(error, told), error);
    };
    refuses("3", "'looks' must be an object");
    refuses(R"({"leaf": {}})", "a look needs");
    refuses(R"({"leaf": {"colour": [2, 0, 0]}})", "0 to 1");
    refuses(R"({"leaf": {"hue": 1}})", "hue");
    refuses(R"({"petal": {"colour": [1, 0, 0]}})", "petal");
    refuses(R"({"leaf": {"picture": "none.png"}})", "none.png");
}

TEST_CASE("a run names a look's files beside it") {
    RunLine line{3, 2, SetLook{0, "leaf", "leaf.terminal.glb", "", kRed}, 0}, read;
    std::string error;
    REQUIRE_MESSAGE(fromJson(toJson(line), read, error), error);
    const auto& look = std::get<SetLook>(read.action);
    CHECK(look.mesh == "leaf.terminal.glb");
    CHECK(look.colour == kRed);
}

}  // namespace looks
