// Fields in an editor's hands: elements, a comb, a smoothing brush.
#include "tests/editor/field_tool.hpp"

namespace field_tool {

TEST_CASE("a drag of the comb is one stroke along its way, live, and one step of undo") {
    const Folder folder;
    Comber comber(folder);
    const uint64_t before = comber.pattern();
    comber.work.field.kind = sample::kComb;
    comber.press(comber.on(-.6f, 1));
    CHECK(comber.fields().empty());
    comber.moveTo(comber.on(0, 1.1f), 6);
    const uint64_t live = comber.pattern();
    CHECK(live != before);
    comber.moveTo(comber.on(.6f, 1), 6);
    comber.release(comber.mouse);
    CHECK_MESSAGE(comber.work.error.empty(), comber.work.error);
    const uint64_t combed = comber.pattern();
    CHECK(combed != live);

    REQUIRE(comber.fields().size() == 1);
    REQUIRE(comber.fields()[0].strokes.size() == 1);
    const auto& stroke = comber.fields()[0].strokes[0];
    CHECK(stroke.brush == "comb");
    CHECK(stroke.radius == .3f);
    REQUIRE(stroke.points.size() > 12);
    for (size_t i = 0; i < stroke.points.size(); ++i) {
        CHECK(std::abs(stroke.points[i][2]) < 1e-4f);
        if (i > 0) CHECK(stroke.points[i][0] > stroke.points[i - 1][0]);
        if (i > 0) CHECK(glm::distance(sample::vec(stroke.points[i]), sample::vec(stroke.points[i - 1])) < .15f);
    }
    CHECK(comber.work.document->undoSteps() == 1);
    CHECK(std::string(comber.work.document->undoName()) == "Comb flow");

    const std::string lines = comber.lines();
    comber.undo();
    CHECK(comber.fields().empty());
    CHECK(comber.pattern() == before);
    comber.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    CHECK(comber.lines() == lines);
    CHECK(comber.pattern() == combed);
}

TEST_CASE("the same way combs the same, however fast the mouse is, and on a surface that stands elsewhere") {
    const Folder folder;
    std::vector<std::array<float, 3>> points;
    {
        Comber slow(folder);
        slow.work.field.kind = sample::kComb;
        slow.drag(slow.on(-.5f, 1), slow.on(.5f, 1.2f), 0, 40);
        points = slow.fields()[0].strokes[0].points;
    }
    Comber fast(folder);
    fast.work.field.kind = sample::kComb;
    fast.drag(fast.on(-.5f, 1), fast.on(.5f, 1.2f), 0, 1);
    CHECK(fast.fields()[0].strokes[0].points.size() == points.size());
    // In the surface's own space a stroke goes along.
    REQUIRE(fast.work.perform(PlaceSurface{0, {.2f, 0, -.3f}, .4f, .5f, true}));
    const glm::vec3 wanted = sample::vec(points[4]);
    espalier::scene::Placing placing = fast.work.scene().surfaces[0].placing;
    const auto world = carried(points[4], {}, placing, true);
    fast.work.field.radius = .1f;
    fast.drag(fast.at(sample::vec(world)), fast.at(sample::vec(carried(points[8], {}, placing, true))), 0, 9);
    REQUIRE(fast.fields()[0].strokes.size() == 2);
    CHECK(fast.fields()[0].strokes[1].radius == .2f);
    CHECK(glm::distance(sample::vec(fast.fields()[0].strokes[1].points[0]), wanted) < .01f);
}

TEST_CASE("elements and strokes go along when their surface is moved, and come back to the bit") {
    const Folder folder;
    Editing editing(patternScene(folder));
    SetField set;
    set.field.name = "flow";
    set.field.elements = {{"regular", {.3f, 1.1f, 0}, {.6f, .8f, 0}, .3f}};
    REQUIRE(editing.perform(set));
    REQUIRE(editing.perform(BrushField{0, "flow", {"comb", .3f, 1, {{-.3f, 1, 0}, {-.2f, 1, 0}, {-.1f, 1, 0}}}}));
    const uint64_t before = patternOf(editing.context.get());
    const SceneField field = editing.document->scene().surfaces[0].fields[0];
    REQUIRE(editing.perform(PlaceSurface{0, {1, .5f, -2}, 3.1415927f / 2, 2, false}));
    const SceneField moved = editing.document->scene().surfaces[0].fields[0];
    // A quarter turn, seen from above, takes x to -z.
    const std::array<float, 3> wanted{1, 2.7f, -2.6f};
    for (size_t i = 0; i < 3; ++i) CHECK(moved.elements[0].position[i] == doctest::Approx(wanted[i]));
    CHECK(moved.elements[0].direction[2] == doctest::Approx(-.6f));
    CHECK(moved.elements[0].radius == doctest::Approx(.6f));
    CHECK(moved.strokes == field.strokes);
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.document->scene().surfaces[0].fields[0] == field);
    CHECK(patternOf(editing.context.get()) == before);
    REQUIRE(editing.perform(Redo{}));
    CHECK(editing.document->scene().surfaces[0].fields[0] == moved);
}

TEST_CASE("a drag of a surface with elements keeps what undoes one move") {
    const Folder folder;
    Editing editing(patternScene(folder));
    SetField set;
    set.field.name = "flow";
    set.field.elements = {{"regular", {.3f, 1.1f, 0}, {.6f, .8f, 0}, .3f}};
    REQUIRE(editing.perform(set));
    const SceneField field = editing.document->scene().surfaces[0].fields[0];
    size_t bytes = 0;
    for (int i = 1; i <= 20; ++i) {
        REQUIRE(editing.perform(PlaceSurface{0, {.1f * float(i), 0, 0}, .01f * float(i), 1}, 7));
        if (i == 1) bytes = editing.document->historyBytes();
    }
    CHECK(editing.document->historyBytes() == bytes);
    CHECK(editing.document->undoSteps() == 2);
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.document->scene().surfaces[0].fields[0] == field);
    CHECK(editing.document->scene().surfaces[0].placing.position == std::array<float, 3>{0, 0, 0});
}

TEST_CASE("a surface stays where an element of it couldn't go along") {
    const Folder folder;
    Editing editing(patternScene(folder));
    SetField set;
    set.field.name = "flow";
    set.field.elements = {{"regular", {.3f, 1.1f, 0}, {.6f, .8f, 0}, 9e8f}, {"wedge", {0, 1, 0}, {1, 0, 0}, .3f}};
    REQUIRE(editing.perform(set));
    const espalier::scene::LoadedSurface& surface = editing.document->scene().surfaces[0];
    REQUIRE(editing.perform(PlaceSurface{0, {0, 0, 0}, 0, 4}));
    CHECK(surface.fields[0].elements[0].radius == 1e9f);
    REQUIRE(editing.perform(Undo{}));
    CHECK(surface.fields[0].elements[0].radius == 9e8f);

    set.field.elements[1].position[1] = 1e38f;
    REQUIRE(editing.perform(set));
    const SceneField field = surface.fields[0];
    const uint64_t before = patternOf(editing.context.get());
    const size_t steps = editing.document->undoSteps();
    CHECK_FALSE(editing.perform(PlaceSurface{0, {1, 0, 0}, 0, 1000}));
    CHECK_MESSAGE(contains(editing.error, "element 1 is out of range"), editing.error);
    CHECK(editing.document->undoSteps() == steps);
    CHECK(surface.fields[0] == field);
    CHECK(surface.placing.scale == 1);
    EspHit hit;
    const float there[] = {0, 1, 0};
    REQUIRE(espNearest(editing.context.get(), there, &hit) == ESP_OK);
    CHECK(std::abs(hit.position[1] - 1) < .1f);
    CHECK(patternOf(editing.context.get()) == before);
}

TEST_CASE("[ and ] make the brush smaller and larger, in a scene of any size") {
    const Folder folder;
    Comber comber(folder);
    for (const float scale : {1.f, 300.f}) {
        REQUIRE(comber.work.perform(PlaceSurface{0, {0, 0, 0}, 0, scale}));
        comber.work.field.kind = sample::kComb;
        comber.work.field.radius = 0;
        const float standing = sample::fieldReach(comber.work);
        comber.key(GLFW_KEY_RIGHT_BRACKET);
        CHECK(comber.work.field.radius == doctest::Approx(1.15f * standing));
        comber.key(GLFW_KEY_LEFT_BRACKET);
        CHECK(comber.work.field.radius == doctest::Approx(standing));
        for (int i = 0; i < 40; ++i) comber.key(GLFW_KEY_RIGHT_BRACKET);
        CHECK(comber.work.field.radius == sample::mostFieldReach(comber.work));
        comber.work.field.kind = "wedge";
        comber.key(GLFW_KEY_LEFT_BRACKET);
        CHECK(comber.work.field.radius == sample::mostFieldReach(comber.work));
    }
}

TEST_CASE("smoothing acts with a click, Esc forgets a stroke, and beside the surface there is none") {
    const Folder folder;
    Comber comber(folder);
    comber.work.field.kind = sample::kComb;
    comber.drag(comber.on(-.4f, .6f), comber.on(.4f, 1.4f));
    const uint64_t combed = comber.pattern();
    const std::string lines = comber.lines();
    comber.work.field.kind = sample::kSmooth;
    comber.click(comber.on(0, 1));
    REQUIRE(comber.fields()[0].strokes.size() == 2);
    CHECK(comber.fields()[0].strokes[1].brush == "smooth");
    CHECK(comber.pattern() != combed);
    CHECK(std::string(comber.work.document->undoName()) == "Smooth flow");
    comber.undo();
    CHECK(comber.lines() == lines);

    comber.work.field.kind = sample::kComb;
    comber.press(comber.on(.4f, 1));
    comber.moveTo(comber.on(.4f, .4f), 6);
    CHECK(comber.fields()[0].strokes.size() == 2);
    comber.key(GLFW_KEY_ESCAPE);
    comber.release(comber.mouse);
    CHECK(comber.lines() == lines);
    CHECK(comber.pattern() == combed);
    comber.click(comber.on(.4f, 1));
    CHECK(comber.lines() == lines);
    comber.drag(comber.at({-1.3f, 1, 0}), comber.at({-1.2f, 1, 0}));
    CHECK(comber.work.message == "No surface there");
    CHECK(comber.lines() == lines);
}

TEST_CASE("an index is told in parts of a turn") {
    using sample::indexText;
    CHECK(indexText(.5f) == "+1/2");
    CHECK(indexText(-.5f) == "-1/2");
    CHECK(indexText(1) == "+1");
    CHECK(indexText(-1) == "-1");
    CHECK(indexText(.25f) == "+1/4");
    CHECK(indexText(-2 / 3.f) == "-2/3");
    CHECK(indexText(1 / 6.f) == "+1/6");
}

}  // namespace field_tool
