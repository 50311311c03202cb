// Steps of undo and states; projects, judged by opening them in another context.

#include <chrono>
#include <filesystem>
#include <set>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"
#include "tools/document/run.hpp"
#include "tools/scene/scene_file.hpp"

using namespace espalier::document;
using espalier::scene::Scene;

namespace {

// Something that a user may do, by chance.
Action randomEdit(std::mt19937& random, Editing& editing) {
    const auto chance = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    const Scene& scene = editing.document->scene();
    const auto anySeed = [&] { return editing.document->recordOf(scene.seeds[random() % scene.seeds.size()]); };
    switch (scene.seeds.empty() ? 0 : random() % 6) {
        case 0: {
            // Numbers that come often, so that the order of planting counts.
            const SeedRecord seed{editing.document->freshKey(),
                                  0,
                                  {chance(-3, 3), chance(0, 1), .4f},
                                  {chance(-1, 1), 1, 0},
                                  uint32_t(random() % 2)};
            return AddSeeds{{seed}, {uint32_t(random() % (scene.seeds.size() + 1))}};
        }
        case 1:
            return RemoveSeeds{{anySeed().key}};
        case 2: {
            SeedRecord seed = anySeed();
            seed.position[0] = chance(-3, 3);
            if (random() % 2) seed.number = random() % 2;
            if (random() % 2) seed.params = {{"reach", {chance(.3f, 1.5f)}}};
            return ChangeSeeds{{seed}};
        }
        case 3:
            return SetParam{0, {"reach", {chance(.3f, 1.5f)}}};
        case 4:
            return SetLight{chance(0, 24), chance(-1, 1), random() % 2 == 0};
        default: {
            std::string text = scene.grammars[0].text;
            if (random() % 2)
                text += "Broken -> }\n";
            else
                text += "// a comment\n";
            SetText action = editing.document->withText(0, text);
            action.params.push_back({"wander", {chance(0, .6f)}});
            return action;
        }
    }
}

}  // namespace

TEST_CASE("a gesture is one step, and a new edit forgets what was undone") {
    const Folder folder;
    Editing editing(smallScene(folder));
    for (int i = 0; i < 5; ++i) CHECK(editing.perform(SetParam{0, {"reach", {1 + .1f * float(i)}}}, 1));
    CHECK(editing.document->undoSteps() == 1);
    for (int i = 0; i < 5; ++i) CHECK(editing.perform(SetParam{0, {"reach", {2}}}, 2));
    CHECK(editing.document->undoSteps() == 2);
    CHECK(editing.perform(Undo{}));
    CHECK(editing.param(0, "reach") == doctest::Approx(1.4));
    CHECK(editing.perform(Undo{}));
    CHECK(editing.param(0, "reach") == 1);
    CHECK(editing.perform(SetParam{0, {"twigs", {3}}}));
    CHECK(editing.document->redoName() == nullptr);
}

TEST_CASE("undone or done again to where it was, a document is in the state that it was in") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const auto set = [&](float reach, uint32_t gesture) {
        REQUIRE(editing.perform(SetParam{0, {"reach", {reach}}}, gesture));
        return editing.document->state();
    };
    const uint64_t opened = editing.document->state();
    const uint64_t begun = set(1.2f, 1), dragged = set(1.3f, 1), other = set(1.4f, 2);
    CHECK(std::set<uint64_t>{opened, begun, dragged, other}.size() == 4);
    CHECK(editing.perform(SetView{"lod", ""}));
    CHECK(editing.document->state() == other);
    CHECK(editing.perform(Undo{}));
    CHECK(editing.document->state() == dragged);
    CHECK(editing.perform(Redo{}));
    CHECK(editing.document->state() == other);
    for (int i = 0; i < 2; ++i) CHECK(editing.perform(Undo{}));
    CHECK(editing.document->state() == opened);
    // The same value by another way is told apart; nobody compares what is in the two.
    const uint64_t again = set(1.3f, 3);
    CHECK(std::set<uint64_t>{opened, begun, dragged, other, again}.size() == 5);
}

TEST_CASE("what can't be done changes nothing") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const uint64_t before = editing.hash();
    CHECK(!editing.perform(SetParam{0, {"no such parameter", {1}}}));
    CHECK(!editing.perform(SetParam{9, {"reach", {1}}}));
    CHECK(!editing.perform(RemoveSeeds{{77}}));
    CHECK(!editing.perform(ChangeSeeds{{SeedRecord{77, 0, {}, {0, 1, 0}, 1}}}));
    CHECK(!editing.perform(AddSeeds{{SeedRecord{1, 0, {}, {0, 1, 0}, 1}}, {0}}));  // a key that is taken
    CHECK(!editing.perform(AddSeeds{{SeedRecord{9, 0, {NAN, 0, 0}, {0, 1, 0}, 1}}, {0}}));
    CHECK(!editing.perform(AddSeeds{{SeedRecord{9, 0, {}, {0, 1, 0}, 1}}, {9}}));
    CHECK(!editing.perform(SetLight{25, 0, true}));
    CHECK(editing.document->undoSteps() == 0);
    CHECK(editing.document->revision() == 0);
    CHECK(editing.hash() == before);
}

TEST_CASE("what can't be undone stays, to be tried again") {
    const Folder folder;
    Editing editing(smallScene(folder));
    REQUIRE(editing.perform(SetParam{0, {"reach", {1.3f}}}));
    const uint64_t state = editing.document->state();
    REQUIRE(espDestroyGrammar(editing.context.get(), editing.document->scene().grammars[0].id) == ESP_OK);
    for (int i = 0; i < 2; ++i) {
        CHECK(!editing.perform(Undo{}));
        CHECK(editing.document->undoSteps() == 1);
        CHECK(editing.document->state() == state);
    }
    CHECK(editing.document->redoName() == nullptr);
}

TEST_CASE("a step of several edits is undone as a whole or not at all") {
    const Folder folder;
    Editing editing(smallScene(folder));
    REQUIRE(editing.perform(SetParam{0, {"reach", {1.3f}}}, 7));
    REQUIRE(editing.perform(SetLight{9, 0, true}, 7));
    REQUIRE(editing.document->undoSteps() == 1);
    const uint64_t state = editing.document->state();
    REQUIRE(espDestroyGrammar(editing.context.get(), editing.document->scene().grammars[0].id) == ESP_OK);
    for (int i = 0; i < 2; ++i) {
        CHECK(!editing.perform(Undo{}));  // the light could be undone, the parameter can't
        CHECK(editing.document->scene().hour == 9);
        CHECK(editing.document->undoSteps() == 1);
        CHECK(editing.document->state() == state);
        CHECK(editing.document->redoName() == nullptr);
    }
}

TEST_CASE("a layer may be called as what tells a town from a scene") {
    for (const char* layer : {"buildings", "FeatureCollection"}) {
        const Folder folder;
        Editing editing(wallScene(folder, false));
        StrokeBegin stroke;
        stroke.layer = layer;
        for (const Action& action : {Action(stroke), Action(StrokeDabs{{{0, 1, 0, 0, 0, 1, 1}}}), Action(StrokeEnd{})})
            REQUIRE_MESSAGE(editing.perform(action), editing.error);
        REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
        const Editing opened(folder.file("saved"));
        CHECK(espPaintedLayerCount(opened.context.get()) == 1);
    }
}

TEST_CASE("a plant is frozen though its town's grammar can't grow") {
    const Folder folder;
    Editing editing(wallScene(folder, true));
    editing.hash();
    REQUIRE(editing.perform(
        editing.document->withText(2, "House -> Extrude(wallHeight) {Box, NULL}\nBox -> Extrude(0.1) {Box, Box}\n")));
    CHECK(espUpdate(editing.context.get()) == ESP_INVALID_CONTENT);
    const uint32_t key = editing.document->scene().seeds[0].key;
    REQUIRE_MESSAGE(editing.perform(FreezeSeeds{{key}, true}), editing.error);
    CHECK(editing.document->scene().seeds[0].frozen);
}

TEST_CASE("a branch's key is sixteen hexadecimal digits and nothing else") {
    const Folder folder;
    Editing editing(smallScene(folder));
    for (const char* key : {"-00000000000000f", "0x0000000000000f", "              0f", "0", ""}) {
        CAPTURE(key);
        CHECK(!editing.perform(PruneBranch{key, true}));
        CHECK(contains(editing.error, "16 hexadecimal digits"));
    }
    CHECK(editing.perform(PruneBranch{"000000000000000f", true}));
}

TEST_CASE("a text with mistakes stands with its message while the last good one grows") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const uint64_t before = editing.hash();
    const std::string good = editing.document->scene().grammars[0].text;
    CHECK(editing.perform(editing.document->withText(0, good + "Ivy -> }\n")));
    CHECK(contains(editing.document->scene().grammars[0].error, ".grammar:"));
    CHECK(editing.hash() == before);
    CHECK(editing.perform(Undo{}));
    CHECK(editing.document->scene().grammars[0].error.empty());
    CHECK(editing.hash() == before);

    // Over a text that grows something else, and back: what grew under the mistake grows there again.
    const auto set = [&](const std::string& text) {
        REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, text)), editing.error);
        return editing.hash();
    };
    CHECK(set(good + "Ivy -> }\n") == before);
    const uint64_t other = set(kCreeper);
    CHECK(other != before);
    for (int i = 0; i < 3; ++i) {
        REQUIRE(editing.perform(Undo{}));
        CHECK(contains(editing.document->scene().grammars[0].error, ".grammar:"));
        CHECK(editing.hash() == before);
        REQUIRE(editing.perform(Redo{}));
        CHECK(editing.hash() == other);
    }
}

TEST_CASE("a project opens as it was saved, in another context and from another place") {
    const Folder folder;
    Editing editing(smallScene(folder));
    std::mt19937 random(11);
    for (int i = 0; i < 12; ++i) REQUIRE_MESSAGE(editing.perform(randomEdit(random, editing)), editing.error);
    const float fov = espalier::scene::fovOfDegrees(38);
    REQUIRE(editing.perform(SetCamera{{1, 2, 3}, {0, 1, 0}, fov}));
    const std::string good = editing.document->scene().grammars[0].grows;
    REQUIRE(editing.perform(editing.document->withText(0, good + "Unfinished -> Marching(\n")));
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("garden"), editing.error), editing.error);

    Editing again(folder.file("garden"));
    CHECK(again.hash() == editing.hash());
    const Scene &a = editing.document->scene(), &b = again.document->scene();
    CHECK(a.hour == b.hour);
    CHECK(a.look.exposure == b.look.exposure);
    CHECK(a.look.shadows == b.look.shadows);
    CHECK(a.grammars[0].text == b.grammars[0].text);
    CHECK(contains(b.grammars[0].error, ".grammar:"));
    REQUIRE(a.seeds.size() == b.seeds.size());
    for (size_t i = 0; i < a.seeds.size(); ++i) {
        CHECK(a.seeds[i].position == b.seeds[i].position);
        CHECK(a.seeds[i].number == b.seeds[i].number);
        CHECK(a.seeds[i].params == b.seeds[i].params);
    }
    for (int i = 0; i < 3; ++i) CHECK(a.camera.eye[i] == b.camera.eye[i]);
    CHECK(b.camera.fovY == fov);

    // Saving what was opened gives the same file.
    REQUIRE(saveProject(*again.document, folder.file("garden2"), again.error));
    CHECK(readAll(folder.file("garden2/project.json")) == readAll(folder.file("garden/project.json")));
}

TEST_CASE("what a project couldn't say isn't done, whatever a run asks for") {
    const Folder folder;
    Editing editing(wallScene(folder, true));
    for (const char* name : {"../../../x", "my-layer", "a b", "", ".r"}) {
        CAPTURE(name);
        StrokeBegin stroke;
        stroke.layer = name;
        CHECK(!editing.perform(stroke));
        CHECK(!editing.document->stroking());
        const auto picture = std::make_shared<std::vector<espalier::scene::GreyPicture>>(1);
        (*picture)[0] = {2, 2, std::vector<float>(4)};
        const Action asked[] = {FillLayer{name, .5f}, LoadLayer{name, "", 0, picture},
                                LoadTownLayer{name, "", picture}};
        for (const Action& action : asked) {
            CHECK(!editing.perform(action));
            CHECK_MESSAGE(contains(editing.error, "no layer's name"), editing.error);
        }
    }
    CHECK(!editing.perform(SetLight{12, 25, true}));
    CHECK(!editing.perform(SetLight{12, -25, true}));
    for (const float fov : {.012f, 3.f}) CHECK(!editing.perform(SetCamera{{1, 2, 3}, {0, 1, 0}, fov}));
    espalier::scene::House house = espalier::scene::houseNow(editing.context.get(), 0);
    house.edges = {{2000000, "gable", 0}};
    CHECK(!editing.perform(SetHouse{house}));
    CHECK(editing.document->undoSteps() == 0);
    // What is at the limits is saved and opens.
    for (const float degrees : {1.f, 170.f}) {
        CAPTURE(degrees);
        const float fov = espalier::scene::fovOfDegrees(degrees);
        REQUIRE_MESSAGE(editing.perform(SetCamera{{1, 2, 3}, {0, 1, 0}, fov}), editing.error);
        REQUIRE_MESSAGE(editing.perform(SetLight{12, 20, true}), editing.error);
        REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("garden"), editing.error), editing.error);
        CHECK(Editing(folder.file("garden")).document->scene().camera.fovY == fov);
    }
}

TEST_CASE("angles are read from the degrees that are written of them, to the bit") {
    using namespace espalier::scene;
    for (int i = 0; i < 1700; ++i)
        for (float (*read)(float) : {turnOfDegrees, fovOfDegrees}) {
            const float angle = read(.1f * float(i));
            CHECK(read(degreesOf(angle, read)) == angle);
            CHECK(read(degreesOf(-angle, read)) == -angle);
        }
}

namespace {

StrokeBegin brush(const std::string& mode, float radius) {
    StrokeBegin begin;
    begin.layer = "mask";
    begin.mode = mode;
    begin.radius = radius;
    return begin;
}

std::vector<float> texels(Editing& editing) {
    espalier::scene::GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(0, "mask", picture, editing.error), editing.error);
    return picture.texels;
}

// Painted, filled or imported, by chance.
void randomPaint(std::mt19937& random, Editing& editing, const Folder& folder) {
    const auto chance = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    if (random() % 8 == 0) {
        REQUIRE_MESSAGE(editing.perform(FillLayer{"mask", chance(0, 1)}), editing.error);
        return;
    }
    if (random() % 8 == 0) {
        espalier::scene::GreyPicture picture{64, 64, std::vector<float>(64 * 64)};
        for (float& texel : picture.texels) texel = chance(0, 1);
        REQUIRE_MESSAGE(writeGrey(folder.file("import.exr"), picture, editing.error), editing.error);
        REQUIRE_MESSAGE(editing.perform(LoadLayer{"mask", folder.file("import.exr"), 0}), editing.error);
        return;
    }
    const uint32_t gesture = random();
    REQUIRE_MESSAGE(editing.perform(brush(random() % 3 ? "paint" : "erase", chance(.05f, .8f)), gesture),
                    editing.error);
    for (int i = 0; i < 3; ++i)
        REQUIRE_MESSAGE(
            editing.perform(StrokeDabs{{{chance(-3, 3), chance(0, 3), .3f, 0, 0, 1, 1}, {0, 1, .3f, 0, 0, 1, .5f}}},
                            gesture),
            editing.error);
    REQUIRE_MESSAGE(editing.perform(StrokeEnd{}, gesture), editing.error);
}

}  // namespace

TEST_CASE("what is painted, filled and imported is undone and done again to the bit") {
    const Folder folder;
    Editing editing(smallScene(folder));
    std::mt19937 random(5);
    const std::vector<float> before = texels(editing);
    for (int i = 0; i < 30; ++i) randomPaint(random, editing, folder);
    const std::vector<float> after = texels(editing);
    const size_t steps = editing.document->undoSteps();  // some strokes erase nothing
    CHECK(after != before);
    CHECK(steps > 20);
    CHECK(editing.document->historyBytes() > 1000);
    for (size_t i = 0; i < steps; ++i) REQUIRE_MESSAGE(editing.perform(Undo{}), editing.error);
    CHECK(texels(editing) == before);
    for (size_t i = 0; i < steps; ++i) REQUIRE_MESSAGE(editing.perform(Redo{}), editing.error);
    CHECK(texels(editing) == after);

    // A stroke that isn't ended keeps other edits waiting, and one without a dab is no step.
    REQUIRE(editing.perform(brush("paint", 1)));
    CHECK(!editing.perform(Undo{}));
    CHECK(!editing.perform(FillLayer{"mask", 0}));
    CHECK(editing.perform(SetView{"layer", "mask"}));
    CHECK(editing.perform(StrokeEnd{}));
    CHECK(!editing.perform(StrokeEnd{}));
    CHECK(editing.document->undoSteps() == steps);
}

TEST_CASE("a project keeps its layers to the bit, and no file of theirs too many") {
    const Folder folder;
    Editing editing(smallScene(folder));
    std::mt19937 random(6);
    const std::string garden = folder.file("garden");
    for (int i = 0; i < 3; ++i) {
        randomPaint(random, editing, folder);
        REQUIRE_MESSAGE(saveProject(*editing.document, garden, editing.error), editing.error);
    }
    const std::vector<float> painted = texels(editing);
    size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(garden)) files += entry.is_regular_file();
    CHECK(files == 3);  // project.json, one layer and the bake that it lies over
    Editing again(garden);
    CHECK(texels(again) == painted);
    CHECK(again.hash() == editing.hash());
}
