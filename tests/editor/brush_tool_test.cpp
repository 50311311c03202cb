// The brush in a user's hands: where its dabs lie, what the keys make of them, and what is left of a stroke that is
// taken back.
#include <algorithm>
#include <array>

#include "sample_game/panels.hpp"
#include "tests/editor/faults.hpp"
#include "tests/editor/widgets.hpp"

using namespace espalier::document;
using sample::Tool;

namespace {

struct Painter : Editor {
    explicit Painter(const Folder& folder, float metres = 1.4f) : Editor(folder, smallScene(folder), Tool::paint) {
        faceWall(*this, metres);
        fill(0);
        done.clear();
    }
    glm::vec2 onWall(float x, float y) const { return at({x, y, .36f}); }
    std::vector<glm::vec3> dabs() const {
        std::vector<glm::vec3> places;
        for (const StrokeDabs& some : all<StrokeDabs>())
            for (const auto& dab : some.dabs) places.emplace_back(dab[0], dab[1], dab[2]);
        return places;
    }
    std::vector<float> texels() {
        espalier::scene::GreyPicture mask;
        REQUIRE_MESSAGE(work.document->readLayer(0, "mask", mask, work.error), work.error);
        return mask.texels;
    }
    float step() const { return work.brush.spacing * work.brushRadius(); }
};

// Metres on the wall that a pixel is.
float pixel(const Painter& painter) {
    return glm::distance(painter.under(painter.onWall(-1, 1)),
                         painter.under(painter.onWall(-1, 1) + glm::vec2(10, 0))) /
           10;
}

}  // namespace

TEST_CASE("dabs lie a part of the radius from each other in the scene, however near the camera is") {
    const Folder folder;
    Painter painter(folder);
    for (const float metres : {1.4f, 1.1f})
        for (const float radius : {.05f, .2f}) {
            CAPTURE(metres);
            CAPTURE(radius);
            faceWall(painter, metres);
            painter.work.brush.radius = radius;
            painter.done.clear();
            painter.drag(painter.onWall(-1.2f, .9f), painter.onWall(-.7f, 1.2f));
            const std::vector<glm::vec3> dabs = painter.dabs();
            CHECK(float(dabs.size()) > .5f * .58f / painter.step());
            for (size_t i = 1; i < dabs.size(); ++i) {
                CHECK(glm::distance(dabs[i - 1], dabs[i]) >= painter.step());
                // A few pixels lie between two looks, and joints between stones.
                CHECK(glm::distance(dabs[i - 1], dabs[i]) < painter.step() + 4 * pixel(painter) + .03f);
            }
        }
    CHECK(painter.all<StrokeBegin>().size() == 1);
    CHECK(painter.all<StrokeEnd>().size() == 1);
}

TEST_CASE("a stroke is the same paint whether its way comes in one move or in many, in one frame or in many") {
    const Folder folder;
    Painter painter(folder);
    painter.work.brush.radius = .05f;
    const glm::vec2 from = painter.onWall(-1.25f, .8f), to = painter.onWall(-.65f, 1.3f);
    const auto stroke = [&](int events) {
        painter.done.clear();
        painter.drag(from, to, 0, events);
        return painter.dabs();
    };
    const std::vector<glm::vec3> once = stroke(1);
    const std::vector<float> painted = painter.texels();
    REQUIRE(once.size() > 15);
    for (const int events : {2, 7, 60, 500, 3000}) {
        CAPTURE(events);
        painter.undo();
        const std::vector<glm::vec3> split = stroke(events);
        REQUIRE(split.size() == once.size());
        for (size_t i = 0; i < split.size(); ++i) CHECK(glm::distance(split[i], once[i]) < .002f);
        const std::vector<float> again = painter.texels();
        float worst = 0;
        for (size_t i = 0; i < again.size(); ++i) worst = std::max(worst, std::abs(again[i] - painted[i]));
        CHECK(worst < .1f);
    }

    painter.undo();
    painter.done.clear();
    using sample::PointerEvent;
    std::vector<sample::InputEvent> events{PointerEvent{PointerEvent::Kind::press, 0, 0, from.x, from.y}};
    for (int i = 1; i <= 7; ++i) {
        const glm::vec2 place = glm::mix(from, to, float(i) / 7);
        events.push_back(PointerEvent{PointerEvent::Kind::move, 0, 0, place.x, place.y});
    }
    events.push_back(PointerEvent{PointerEvent::Kind::release, 0, 0, to.x, to.y});
    painter.frame(events);
    CHECK(painter.all<StrokeDabs>().size() == 1);  // what a frame brings goes there together
    CHECK(painter.dabs().size() == once.size());
    CHECK(!painter.work.document->stroking());
}

TEST_CASE("nothing is painted where it isn't seen: outside of the window, and beneath a panel") {
    const Folder folder;
    Painter painter(folder, 1.5f);
    painter.work.brush.radius = .05f;
    const glm::vec2 inside(800, 600), below(800, 900);
    (void)painter.under(below);  // there is something that it could go over
    painter.press(inside);
    painter.moveTo(below, 10);
    const size_t before = painter.dabs().size();
    painter.moveTo(below + glm::vec2(100, 0), 10);
    CHECK(painter.dabs().size() == before);
    painter.moveTo(inside + glm::vec2(100, 0), 10);
    painter.release(painter.mouse);
    std::vector<glm::vec3> dabs = painter.dabs();
    CHECK(dabs.size() > before + 2);
    for (const glm::vec3& dab : dabs) CHECK(painter.at(dab).y <= painter.work.window.y + 1);

    const glm::vec2 low(760, 300), high(860, 400);  // of a panel
    painter.panels = [&] {
        ImGui::SetNextWindowPos({low.x, low.y});
        ImGui::SetNextWindowSize({high.x - low.x, high.y - low.y});
        ImGui::Begin("panel");
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) painter.frame({});
    painter.done.clear();
    painter.drag({600, 350}, {1000, 350});
    int sides[2] = {0, 0};
    for (const glm::vec3& dab : painter.dabs()) {
        const float x = painter.at(dab).x;
        CHECK((x < low.x + 1 || x > high.x - 1));
        ++sides[x > high.x - 1];
    }
    CHECK(sides[0] > 3);
    CHECK(sides[1] > 3);

    // What goes down on the panel is the panel's, wherever it is dragged to.
    painter.done.clear();
    painter.drag({800, 350}, {1000, 350});
    CHECK(painter.done.empty());

    // Figures are none: they let through what is seen behind them.
    painter.work.layout.figures = true;
    painter.panels = [&] { sample::showFigures(painter.work, 0, false); };
    for (int i = 0; i < 3; ++i) painter.frame({});
    const glm::vec2 figures(painter.work.window.x - 60, 80);
    (void)painter.under(figures);
    painter.drag(figures, figures + glm::vec2(10, 30));
    CHECK(painter.all<StrokeEnd>().size() == 1);
    CHECK(painter.dabs().size() > 1);
}

TEST_CASE("Ctrl erases and Shift smooths what was painted, for as long as the stroke lasts") {
    const Folder folder;
    Painter painter(folder);
    painter.work.brush.strength = 1;
    painter.work.brush.value = 0;
    painter.fill(1);  // which is what the layer is where nothing was painted
    const glm::vec2 from = painter.onWall(-1.2f, 1), to = painter.onWall(-.7f, 1);
    const auto painted = [&] {
        double sum = 0;
        for (const float texel : painter.texels()) sum += 1 - texel;
        return sum;
    };
    painter.drag(from, to);
    const std::vector<float> sharp = painter.texels();
    const double full = painted();
    CHECK(full > 0);
    painter.drag(from, to, GLFW_MOD_SHIFT);
    CHECK(painter.texels() != sharp);
    CHECK(painted() == doctest::Approx(full).epsilon(.2));
    painter.drag(from, to, GLFW_MOD_CONTROL);
    CHECK(painted() < .2 * full);
    // Keys that change under way change the next stroke.
    painter.press(from);
    painter.moveTo(to, 4, GLFW_MOD_CONTROL);
    painter.release(to, GLFW_MOD_CONTROL);

    std::vector<std::string> modes;
    for (const StrokeBegin& stroke : painter.all<StrokeBegin>()) {
        modes.push_back(stroke.mode);
        CHECK(stroke.layer == "mask");
        CHECK(stroke.radius == painter.work.brush.radius);
        CHECK(stroke.strength == 1);
    }
    CHECK(modes == std::vector<std::string>{"paint", "smooth", "erase", "paint"});
    CHECK(painter.work.document->undoSteps() == 6);  // with the layer's fillings
}

TEST_CASE("what the brush does is chosen in the panel, and keys turn it round") {
    const Folder folder;
    Painter painter(folder);
    const glm::vec2 from = painter.onWall(-1.2f, 1), to = painter.onWall(-.9f, 1);
    for (const char* mode : {"erase", "smooth", "paint"}) {
        painter.work.brush.mode = mode;
        for (const int mods : {0, GLFW_MOD_CONTROL, GLFW_MOD_SHIFT}) painter.drag(from, to, mods);
    }
    std::vector<std::string> modes;
    for (const StrokeBegin& stroke : painter.all<StrokeBegin>()) modes.push_back(stroke.mode);
    CHECK(modes == std::vector<std::string>{"erase", "paint", "smooth", "smooth", "erase", "smooth", "paint", "erase",
                                            "smooth"});
}

TEST_CASE("over a layer of colours the brush paints its colour, and Ctrl the grammar's") {
    const Folder folder;
    Painter painter(folder);
    const glm::vec2 from = painter.onWall(-1.2f, 1), to = painter.onWall(-.9f, 1);
    painter.work.chooseLayer("colour");
    painter.work.brush.strength = painter.work.brush.hardness = 1;
    std::copy_n(std::array{.25f, .5f, .125f}.begin(), 3, painter.work.brush.colour);
    const auto least = [&](const char* channel) {
        espalier::scene::GreyPicture picture;
        REQUIRE(painter.work.document->readLayer(0, channel, picture, painter.work.error));
        return *std::ranges::min_element(picture.texels);
    };
    const size_t before = painter.work.document->undoSteps();
    painter.drag(from, to);
    CHECK(painter.all<StrokeBegin>().back().layer == "colour");
    CHECK(least("colour.r") == .25f);
    CHECK(least("colour.g") == .5f);
    CHECK(least("colour.b") == .125f);
    CHECK(painter.work.document->undoSteps() == before + 1);
    painter.drag(from, to, GLFW_MOD_CONTROL);
    CHECK(least("colour.g") > .99f);
}

TEST_CASE("a click beside all ground says so, and undo when there is nothing to undo") {
    const Folder folder;
    Painter painter(folder);
    painter.work.lookFrom(painter.work.scene().camera);
    const glm::vec2 sky(painter.work.window.x * .7f, 5);
    REQUIRE(!painter.work.pick(sky));
    painter.click(sky);
    CHECK(painter.work.message == sample::kNoGround);
    painter.click(painter.onWall(-1, 1));
    CHECK(painter.work.message != sample::kNoGround);
    painter.key(GLFW_KEY_S);
    painter.click(sky);
    CHECK(painter.work.message == sample::kNoGround);
    for (size_t steps = painter.work.document->undoSteps(); steps > 0; --steps) {
        painter.undo();
        CHECK(painter.work.message != "Nothing to undo");
    }
    painter.undo();
    CHECK(painter.work.message == "Nothing to undo");
}

TEST_CASE("Esc and Ctrl+Z in a stroke give back every texel, and what the button still does paints nothing") {
    const Folder folder;
    Painter painter(folder);
    painter.drag(painter.onWall(-1.2f, .9f), painter.onWall(-.7f, .9f));
    const std::vector<float> before = painter.texels();
    const size_t steps = painter.work.document->undoSteps();
    const glm::vec2 from = painter.onWall(-1.1f, .8f), to = painter.onWall(-.8f, 1.1f);
    for (const bool escape : {true, false}) {
        CAPTURE(escape);
        painter.press(from);
        painter.moveTo(to, 5);
        CHECK(painter.texels() != before);  // it is seen while it is painted
        escape ? painter.key(GLFW_KEY_ESCAPE) : painter.undo();
        CHECK(painter.texels() == before);
        CHECK(!painter.work.document->stroking());
        painter.moveTo(from, 5);
        painter.release(from);
        CHECK(painter.texels() == before);
        CHECK(painter.work.document->undoSteps() == steps);
        CHECK(painter.work.tool == Tool::paint);
    }
    // A stroke that met nothing has nothing to give back: what was painted before it stays.
    faceWall(painter, 8);
    const glm::vec2 sky = painter.at({-.95f, 3.8f, .3f});
    REQUIRE(!painter.work.pick(sky));
    painter.press(sky);
    painter.key(GLFW_KEY_ESCAPE);
    painter.release(sky);
    CHECK(painter.texels() == before);
    CHECK(painter.work.document->undoSteps() == steps);
    painter.key(GLFW_KEY_ESCAPE);
    CHECK(painter.work.tool == Tool::look);
}

TEST_CASE("Esc in a stroke that can't be ended leaves alone what was painted before it") {
    const Folder folder;
    Painter painter(folder);
    painter.drag(painter.onWall(-1.2f, .9f), painter.onWall(-.7f, .9f));
    const std::vector<float> before = painter.texels();
    const size_t steps = painter.work.document->undoSteps();
    painter.press(painter.onWall(-1.1f, .8f));
    painter.moveTo(painter.onWall(-.8f, 1.1f), 5);
    callsUntilFailure = 1;
    painter.key(GLFW_KEY_ESCAPE);
    CHECK(callsUntilFailure == 0);
    callsUntilFailure = 0;
    painter.release(painter.mouse);
    CHECK(painter.work.error != "");
    CHECK(painter.work.document->undoSteps() == steps);
    CHECK(painter.texels() == before);
}

TEST_CASE("F and a move set the radius alone, Shift+F the strength, and neither paints") {
    const Folder folder;
    Painter painter(folder);
    sample::Brush& brush = painter.work.brush;
    const sample::Brush before = brush;
    const glm::vec2 from = painter.onWall(-1, 1);
    painter.move(from);
    painter.key(GLFW_KEY_F);
    painter.moveTo(from + glm::vec2(90, 30), 5);
    const float larger = brush.radius;
    CHECK(larger > 1.5f * before.radius);
    painter.moveTo(from - glm::vec2(90, 30), 5);
    CHECK(brush.radius == doctest::Approx(before.radius * before.radius / larger));  // as much to either side
    painter.moveTo(from + glm::vec2(90, 0), 5);
    painter.click(painter.mouse);  // keeps it
    CHECK(brush.radius == doctest::Approx(larger));
    painter.moveTo(from, 5);
    CHECK(brush.radius == doctest::Approx(larger));
    CHECK(brush.strength == before.strength);

    for (const bool escape : {true, false}) {
        painter.key(GLFW_KEY_F);
        painter.moveTo(painter.mouse + glm::vec2(200, 0), 3);
        CHECK(brush.radius > 1.5f * larger);
        escape ? painter.key(GLFW_KEY_ESCAPE) : painter.click(painter.mouse, 0, GLFW_MOUSE_BUTTON_RIGHT);
        CHECK(brush.radius == doctest::Approx(larger));
        painter.moveTo(painter.mouse - glm::vec2(200, 0), 3);
        CHECK(brush.radius == doctest::Approx(larger));
    }
    painter.key(GLFW_KEY_F, GLFW_MOD_SHIFT);
    painter.moveTo(painter.mouse + glm::vec2(60, 0), 3);
    painter.click(painter.mouse);
    CHECK(brush.strength > before.strength + .1f);
    CHECK(brush.radius == doctest::Approx(larger));
    painter.moveTo(from, 3);

    CHECK(painter.done.empty());
    CHECK(painter.work.tool == Tool::paint);
    painter.drag(from, from + glm::vec2(40, 0));
    REQUIRE(painter.all<StrokeBegin>().size() == 1);
    CHECK(painter.all<StrokeBegin>()[0].radius == doctest::Approx(larger));
}

TEST_CASE("a stroke that changes nothing says so") {
    const Folder folder;
    Painter painter(folder);
    REQUIRE(painter.work.perform(FillLayer{"mask", 1}));
    const glm::vec2 from = painter.onWall(-1, 1), to = painter.onWall(-.6f, 1);
    for (const std::string mode : {"erase", "paint"}) {
        CAPTURE(mode);
        painter.work.brush.mode = mode;
        painter.work.message.clear();
        painter.drag(from, to);
        CHECK_MESSAGE(contains(painter.work.message, "Nothing changed"), painter.work.message);
    }
    painter.work.brush.mode = "paint";
    painter.key(GLFW_KEY_X);
    painter.work.message.clear();
    painter.drag(from, to);
    CHECK(painter.work.message == "");
}

TEST_CASE("X paints the opposite value") {
    const Folder folder;
    Painter painter(folder);
    painter.work.brush.value = .75f;
    painter.key(GLFW_KEY_X);
    painter.drag(painter.onWall(-1, 1), painter.onWall(-.6f, 1));
    REQUIRE(painter.all<StrokeBegin>().size() == 1);
    CHECK(painter.all<StrokeBegin>()[0].value == .25f);

    // What is erased has no value: the opposite is painted.
    painter.work.brush.mode = "erase";
    painter.key(GLFW_KEY_X);
    CHECK(painter.work.brush.mode == "paint");
    CHECK(painter.work.brush.value == .75f);
    painter.work.brush.value = .25f;

    // A colour has none, and the value isn't seen with one in hand.
    painter.work.chooseLayer("colour");
    painter.key(GLFW_KEY_X);
    CHECK(painter.work.brush.value == .25f);
}

TEST_CASE("a stroke goes on as it began, and so it is shown, whichever keys are pressed meanwhile") {
    const Folder folder;
    Painter painter(folder);
    sample::Brush& brush = painter.work.brush;
    brush.value = .75f;
    const glm::vec2 from = painter.onWall(-1.1f, 1), to = painter.onWall(-.8f, 1);
    // The vertices of the circle that is drawn around a place where it has been let lie.
    const auto circle = [&](glm::vec2 at, int mods) {
        painter.mouse = at;
        painter.frame({}, mods);
        std::vector<std::pair<ImVec2, ImU32>> drawn;
        for (const ImDrawVert& vertex : ImGui::GetBackgroundDrawList()->VtxBuffer)
            drawn.emplace_back(vertex.pos, vertex.col);
        return drawn;
    };
    const auto same = [](const auto& a, const auto& b) {
        return std::ranges::equal(a, b, [](const auto& v, const auto& w) {
            return v.first.x == w.first.x && v.first.y == w.first.y && v.second == w.second;
        });
    };
    const auto before = circle(to, 0);
    REQUIRE(before.size() > 40);
    REQUIRE(!same(circle(to, GLFW_MOD_CONTROL), before));
    const float radius = brush.radius;
    painter.press(from);
    painter.moveTo(to, 5);
    for (const int key : {GLFW_KEY_LEFT_BRACKET, GLFW_KEY_LEFT_BRACKET, GLFW_KEY_RIGHT_BRACKET, GLFW_KEY_X, GLFW_KEY_F})
        painter.key(key);
    CHECK(brush.radius == radius);
    CHECK(brush.value == .75f);
    for (const int mods : {0, GLFW_MOD_CONTROL, GLFW_MOD_SHIFT}) CHECK(same(circle(to, mods), before));
    painter.release(to);
    CHECK(!same(circle(to, GLFW_MOD_CONTROL), before));
    painter.key(GLFW_KEY_LEFT_BRACKET);
    CHECK(brush.radius < radius);
}

TEST_CASE("Esc gives back the radius that was there before F, whichever keys are pressed until then") {
    const Folder folder;
    Painter painter(folder);
    const sample::Brush before = painter.work.brush;
    const sample::Brush& brush = painter.work.brush;
    painter.move(painter.onWall(-1, 1));
    painter.key(GLFW_KEY_F);
    painter.moveTo(painter.mouse + glm::vec2(90, 0), 3);
    painter.key(GLFW_KEY_F);
    painter.key(GLFW_KEY_F, GLFW_MOD_SHIFT);
    painter.key(GLFW_KEY_RIGHT_BRACKET);
    painter.key(GLFW_KEY_X);
    painter.moveTo(painter.mouse + glm::vec2(90, 0), 3);
    CHECK(brush.radius > 2 * before.radius);
    painter.key(GLFW_KEY_ESCAPE);
    CHECK(brush.radius == before.radius);
    CHECK(brush.strength == before.strength);
    CHECK(brush.value == before.value);
}

TEST_CASE("a click on the name of a value paints with it, which the line at the bottom tells") {
    const Folder folder;
    Painter painter(folder);
    std::string status;
    painter.panels = [&] {
        ImGui::SetNextWindowPos({0, 0});
        ImGui::Begin("panel");
        sample::brushPanel(painter.work);
        ImGui::End();
        status = wordsOf([&] { sample::showStatus(painter.work, false, false); });
    };
    for (int i = 0; i < 2; ++i) painter.frame({});
    CHECK_MESSAGE(contains(status, "paint mask: 1.00 (freely)"), status);
    pressWidget(painter, "panel", {"named", 0, "nowhere"});
    CHECK(painter.work.brush.value == 0);
    CHECK_MESSAGE(contains(status, "paint mask: 0.00 (nowhere)"), status);
}

TEST_CASE("a brush that was used in a scene of quite another size suits this one, any other stays as it is") {
    const Folder folder;
    Painter painter(folder);
    auto& work = painter.work;
    const float reach = work.reach();
    REQUIRE(reach > 1);
    for (const float radius : {.01f * reach, .1f * reach}) {
        work.brush.radius = radius;
        work.fitBrush();
        CHECK(work.brush.radius == radius);
    }
    work.brush.radius = 20 * reach;
    work.fitBrush();
    CHECK(work.brush.radius < .2f * reach);
    work.brush.radius = 1e-5f * reach;
    work.fitBrush();
    CHECK(work.brush.radius > .0019f * reach);
}
