// Models and grammars that come to an open scene: baked beside the frames, placed, taken back, saved and recorded.
#include <doctest/doctest.h>

#include "sample_game/additions.hpp"
#include "sample_game/model_bake.hpp"
#include "tests/editor/window.hpp"
#include "tools/document/project.hpp"

namespace additions {
namespace {

using namespace espalier::document;

// A wall of that size, which begins at `left` and `low`.
std::string wall(const Folder& folder, const char* name, float left, float low, float width, float height) {
    std::string text;
    const auto corner = [&](float x, float y) { text += "v " + std::to_string(x) + " " + std::to_string(y) + " 0\n"; };
    corner(left, low), corner(left + width, low), corner(left + width, low + height), corner(left, low + height);
    return folder.write(name, text + "f 1 2 3 4\nf 4 3 2 1\n");
}

struct Adding : Window {
    explicit Adding(const Folder& folder, const std::string& file = content("untitled.json")) : Window(folder, file) {}
    void add(const std::vector<std::string>& files) {
        sample::takeDropped(work, session, files);
        session.background().finish();
    }
    size_t surfaces() const { return work.scene().surfaces.size(); }
    std::pair<glm::vec3, glm::vec3> boundsOf(size_t surface) const {
        EspSurfaceInfo info;
        REQUIRE(espSurfaceInfo(work.context.get(), work.scene().surfaces[surface].id, &info) == ESP_OK);
        return {sample::vec(info.boundsMin), sample::vec(info.boundsMax)};
    }
};

}  // namespace

TEST_CASE("a model that is dropped into the empty scene is baked, stands on the ground, and sets the size of plants") {
    const Folder folder;
    Adding adding(folder);
    const std::string model = wall(folder, "wall.obj", -1, -.7f, 2, 3);
    REQUIRE(sample::isModel(model));
    adding.add({model});
    CHECK_MESSAGE(adding.work.error.empty(), adding.work.error);
    CHECK(adding.work.message == "Added: wall.obj");
    REQUIRE(adding.surfaces() == 1);
    CHECK(std::filesystem::exists(folder.path / "wall.surface.glb"));
    CHECK(adding.boundsOf(0).first.y == doctest::Approx(0));
    CHECK(adding.work.scene().seeds.empty());
    CHECK(std::string(adding.work.document->undoName()) == "Add wall.obj");
    CHECK(adding.work.document->undoSteps() == 1);
    REQUIRE(adding.work.perform(Undo{}));
    CHECK(adding.surfaces() == 0);
    REQUIRE(adding.work.perform(Redo{}));
    REQUIRE(adding.surfaces() == 1);
    CHECK(adding.boundsOf(0).first.y == doctest::Approx(0));
    CHECK(espUpdate(adding.work.context.get()) == ESP_OK);

    // What is baked already isn't baked again.
    const auto baked = std::filesystem::last_write_time(folder.path / "wall.surface.glb");
    CHECK(sample::isBaked(model));
    adding.add({model});
    CHECK(adding.surfaces() == 2);
    CHECK(std::filesystem::last_write_time(folder.path / "wall.surface.glb") == baked);
}

TEST_CASE("several models come in their order, and one that would stand in another stands beside it") {
    const Folder folder;
    Adding adding(folder);
    adding.add(
        {wall(folder, "a.obj", 0, 0, 2, 3), wall(folder, "b.obj", 1, 0, 2, 2), wall(folder, "far.obj", 20, 0, 1, 1)});
    CHECK_MESSAGE(adding.work.error.empty(), adding.work.error);
    REQUIRE(adding.surfaces() == 3);
    CHECK(adding.boundsOf(0).first.x == doctest::Approx(0));
    CHECK(adding.boundsOf(1).first.x > adding.boundsOf(0).second.x);
    CHECK(adding.boundsOf(2).first.x == doctest::Approx(20));
    CHECK(adding.work.document->undoSteps() == 3);
}

TEST_CASE("what is broken or no model gives a message with its name, and changes nothing") {
    const Folder folder;
    Adding adding(folder);
    const auto refuses = [&](const std::vector<std::string>& files, const std::string& told) {
        adding.work.error.clear();
        adding.add(files);
        CHECK_MESSAGE(contains(adding.work.error, told), adding.work.error);
        CHECK(adding.surfaces() == 0);
        CHECK(adding.work.document->undoSteps() == 0);
    };
    refuses({folder.write("torn.glb", "glTF and no more")}, "torn.glb");
    refuses({folder.write("bad.obj", "v 0 0 0\nf 1 2 3\n")}, "bad.obj:2");
    refuses({folder.file("gone.obj")}, "gone.obj");
    refuses({folder.write("a.txt", "text"), folder.write("b.txt", "text")}, "no models");
    // A file of the user's own has the name that the surface would have.
    const std::string own = folder.write("mine.surface.glb", "not to be lost");
    refuses({wall(folder, "mine.obj", 0, 0, 1, 1)}, "is no surface");
    CHECK(readAll(own) == "not to be lost");
}

TEST_CASE("of several models the broken ones are told of, and the others come") {
    const Folder folder;
    Adding adding(folder);
    adding.add({folder.write("torn.glb", "glTF and no more"), wall(folder, "wall.obj", 0, 0, 2, 3)});
    CHECK_MESSAGE(contains(adding.work.error, "torn.glb"), adding.work.error);
    CHECK(adding.work.message == "Added: wall.obj");
    CHECK(adding.surfaces() == 1);
}

TEST_CASE("a bake that is called off, or whose document goes, adds nothing") {
    const Folder folder;
    const std::string model = wall(folder, "wall.obj", 0, 0, 2, 3);
    Adding adding(folder);
    sample::addModels(adding.work, adding.session, {model});
    REQUIRE(adding.session.background().busy());
    (void)adding.session.background().step();
    adding.session.background().cancel();
    adding.session.background().finish();
    CHECK(adding.work.error.empty());
    CHECK(contains(adding.work.message, "Cancelled"));
    CHECK(adding.surfaces() == 0);
    CHECK_FALSE(std::filesystem::exists(folder.path / "wall.surface.glb"));

    sample::addModels(adding.work, adding.session, {model});
    adding.session.background().leave();
    adding.session.background().finish();
    CHECK(adding.surfaces() == 0);
}

TEST_CASE("added models and grammars are saved in a project, and seeds go with a model that is moved") {
    const Folder folder;
    Adding adding(folder);
    adding.add({wall(folder, "wall.obj", 0, 0, 2, 3)});
    REQUIRE(adding.work.perform(AddGrammar{content("grammars/ivy_guided.grammar")}));
    const uint32_t grammar = uint32_t(adding.work.scene().grammars.size() - 1);
    const SeedRecord seed{adding.work.document->freshKey(), grammar, {.5f, .2f, 0}, {0, 1, 0}, 1};
    REQUIRE(adding.work.perform(AddSeeds{{seed}, {0}}));
    REQUIRE(adding.work.perform(PlaceSurface{0, {5, 0, 0}, 0, 2}));
    CHECK(adding.work.scene().seeds[0].position == std::array<float, 3>{6, .4f, 0});
    REQUIRE(adding.save(folder.file("saved")));

    Editing again(folder.file("saved"));
    REQUIRE(again.document->scene().surfaces.size() == 1);
    CHECK(again.document->scene().surfaces[0].placing.position == std::array<float, 3>{5, 0, 0});
    CHECK(again.document->scene().surfaces[0].placing.scale == 2);
    CHECK(again.document->scene().grammars.size() == grammar + 1);
    CHECK(again.document->scene().seeds.size() == 1);

    REQUIRE(adding.work.perform(Undo{}));
    CHECK(adding.work.scene().seeds[0].position == seed.position);
    CHECK(adding.work.scene().surfaces[0].placing.scale == 1);
    for (int i = 0; i < 3; ++i) REQUIRE_MESSAGE(adding.work.perform(Undo{}), adding.work.error);
    CHECK(adding.surfaces() == 0);
    CHECK(adding.work.scene().grammars.size() == grammar);
}

TEST_CASE("places that no surface can stand at are refused") {
    const Folder folder;
    Editing editing(smallScene(folder));
    CHECK_FALSE(editing.perform(PlaceSurface{0, {2e9f, 0, 0}, 0, 1}));
    CHECK_FALSE(editing.perform(PlaceSurface{0, {0, 0, 0}, 0, 0}));
    CHECK_FALSE(editing.perform(PlaceSurface{7, {0, 0, 0}, 0, 1}));
    CHECK(contains(editing.error, "no surface 7"));
    CHECK_FALSE(editing.perform(AddSurface{folder.file("none.glb")}));
    CHECK_FALSE(editing.perform(AddGrammar{folder.write("bad.grammar", "Ivy ->")}));
    CHECK(editing.document->undoSteps() == 0);
}

}  // namespace additions
