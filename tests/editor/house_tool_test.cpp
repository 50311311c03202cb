// Houses in a user's hands, seen from above: what is chosen, what a drag of a corner makes of the outline and of the
// roof while the button is still down, and what takes it back.
#include <algorithm>

#include "tests/editor/over_town.hpp"

using namespace espalier::document;
using espalier::scene::House;
using sample::Tool;

namespace {

struct Builder : OverTown<Editor> {
    explicit Builder(const Folder& folder, const std::string& town = content("town.json")) : OverTown(folder, town) {}
    House house(uint32_t index) const { return espalier::scene::houseNow(work.context.get(), index); }
    // Where a place of the plan is seen at the height of the house's eaves, at which it is taken hold of.
    glm::vec2 eave(uint32_t index, glm::vec2 plan) const { return at({plan.x, info(index).eaveHeight, plan.y}); }
    glm::vec2 corner(uint32_t index, size_t i) const {
        const auto c = house(index).corners[i];
        return eave(index, {c[0], c[1]});
    }
    glm::vec2 edge(uint32_t index, size_t i) const {
        return (corner(index, i) + corner(index, (i + 1) % house(index).corners.size())) / 2.f;
    }
    void choose(uint32_t index) {
        click(middle(index));
        REQUIRE(work.house == index);
    }
    // The whole town's roofs as they are drawn now.
    EspRoofStats roofs() {
        REQUIRE_MESSAGE(espUpdate(work.context.get()) == ESP_OK, espLastError(work.context.get()));
        REQUIRE_MESSAGE(work.readStats(), work.error);
        return work.roofs;
    }
    size_t steps() const { return work.document->undoSteps(); }
};

// With one of its houses chosen.
struct Chosen : Builder {
    explicit Chosen(const Folder& folder) : Builder(folder) {
        gambrel.index = named("gambrel");
        choose(gambrel.index);
        gambrel.before = house(gambrel.index);
        gambrel.planned = roofs().hash;
    }
    struct {
        uint32_t index = 0;
        House before;
        uint64_t planned = 0;  // the town's hash
    } gambrel;
};

}  // namespace

TEST_CASE("a click chooses the house under it, another click an edge of its outline, one beside them none") {
    const Folder folder;
    Builder builder(folder);
    for (const char* id : {"mansard", "gambrel", "half-hip", "pyramid", "shed", "one-gable", "two-slopes", "oblique"}) {
        CAPTURE(id);
        const uint32_t index = builder.named(id);
        builder.click(builder.middle(index));
        CHECK(builder.work.house == index);
        CHECK(!builder.work.houseEdge);
    }
    const uint32_t index = builder.named("gambrel");
    builder.choose(index);
    for (uint32_t i = 0; i < 4; ++i) {
        builder.click(builder.edge(index, i));
        CHECK(builder.work.house == index);
        CHECK(builder.work.houseEdge == i);
    }
    builder.click(builder.at({100, 0, -20}));
    CHECK(!builder.work.house);
    CHECK(builder.done.empty());
}

TEST_CASE("a drag of a corner moves it alone, and the roof follows before the button is let go") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("mansard");
    builder.choose(index);
    const House before = builder.house(index);
    const EspRoofStats planned = builder.roofs();
    const size_t moved = 1;
    const glm::vec2 from = builder.corner(index, moved), to = from + glm::vec2(25, 18);
    builder.press(from);
    CHECK(builder.work.houseEdge == uint32_t(moved));
    CHECK(builder.roofs().hash == planned.hash);
    uint64_t last = planned.hash;
    for (int i = 1; i <= 4; ++i) {
        builder.move(glm::mix(from, to, float(i) / 4));
        const EspRoofStats now = builder.roofs();
        CHECK(now.hash != last);
        CHECK(now.housesGrown == planned.housesGrown + uint64_t(i));  // the others stand as they did
        last = now.hash;
    }
    CHECK(builder.roofs().tiles != planned.tiles);
    builder.release(to);
    CHECK(builder.roofs().hash == last);

    const House after = builder.house(index);
    REQUIRE(after.corners.size() == before.corners.size());
    CHECK(glm::distance(builder.corner(index, moved), to) < .5f);
    for (size_t i = 0; i < before.corners.size(); ++i)
        if (i != moved) CHECK(after.corners[i] == before.corners[i]);
    CHECK(after.shape == before.shape);
    CHECK(after.slope == before.slope);

    builder.moveTo(from, 3);  // the button is up
    CHECK(builder.house(index) == after);
    CHECK(builder.steps() == 1);
    builder.undo();
    CHECK(builder.house(index) == before);
    CHECK(builder.roofs().hash == planned.hash);
    builder.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    CHECK(builder.roofs().hash == last);
}

TEST_CASE(
    "Esc, Ctrl+Z and the right button in a drag give the house back as it stood, and what the button still does "
    "changes nothing") {
    const Folder folder;
    Chosen builder(folder);
    const auto& [index, before, planned] = builder.gambrel;
    const glm::vec2 from = builder.corner(index, 2), to = from + glm::vec2(20, -10);
    const auto cancelled = [&](const char* how, auto&& cancel) {
        CAPTURE(how);
        builder.press(from);
        builder.moveTo(to, 4);
        CHECK(builder.roofs().hash != planned);
        cancel();
        CHECK(builder.house(index) == before);
        builder.moveTo(to + glm::vec2(20, 0), 4);
        builder.release(builder.mouse);
        CHECK(builder.house(index) == before);
        CHECK(builder.roofs().hash == planned);
        CHECK(builder.steps() == 0);
    };
    cancelled("Esc", [&] { builder.key(GLFW_KEY_ESCAPE); });
    cancelled("Ctrl+Z", [&] { builder.undo(); });
    cancelled("the right button", [&] { builder.click(builder.mouse, 0, GLFW_MOUSE_BUTTON_RIGHT); });
    CHECK(builder.work.tool == Tool::houses);
    CHECK(builder.work.house == index);
    // A click on a corner, taken back before it moved, leaves the step before it alone.
    builder.drag(from, to);
    const uint64_t changed = builder.roofs().hash;
    builder.press(builder.corner(index, 2));
    builder.key(GLFW_KEY_ESCAPE);
    builder.release(builder.mouse);
    CHECK(builder.roofs().hash == changed);
    CHECK(builder.steps() == 1);
}

TEST_CASE("a corner that is let go where no roof can be is where it was") {
    const Folder folder;
    Chosen builder(folder);
    const auto& [index, before, planned] = builder.gambrel;
    // Over the edge that lies across from it.
    const glm::vec2 from = builder.corner(index, 2), across = builder.edge(index, 0);
    const glm::vec2 beyond = across + .3f * (across - from);
    builder.press(from);
    builder.moveTo(beyond, 12);
    builder.release(beyond);
    CHECK(builder.house(index) == before);
    CHECK(builder.roofs().hash == planned);
    CHECK(builder.steps() == 0);
    CHECK(builder.work.error != "");
    // A way that only leads over such places ends where it is let go.
    builder.press(from);
    builder.moveTo(beyond, 4);
    builder.moveTo(from + glm::vec2(20, -10), 4);
    builder.release(builder.mouse);
    CHECK(builder.house(index) != before);
    CHECK(builder.steps() == 1);
    CHECK(builder.work.error == "");
}

TEST_CASE("Ctrl and a drag of an edge make a corner there as one step, and edges behind it keep what is their own") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("one-gable");
    builder.choose(index);
    const House before = builder.house(index);
    REQUIRE(before.edges.size() == 1);
    const uint64_t planned = builder.roofs().hash;
    const auto gable = [&] {
        const House now = builder.house(index);
        REQUIRE(now.edges.size() == 1);
        CHECK(now.edges[0].end == "gable");
        return builder.edge(index, now.edges[0].edge);
    };
    const glm::vec2 stands = gable();
    const size_t edge = (before.edges[0].edge + 3) % 4;  // the one before it
    const glm::vec2 from = builder.edge(index, edge);
    const glm::vec2 outward = glm::normalize(from - builder.middle(index));
    builder.drag(from, from + 20.f * outward, GLFW_MOD_CONTROL);
    const House after = builder.house(index);
    REQUIRE(after.corners.size() == 5);
    for (const auto& corner : before.corners) CHECK(std::ranges::count(after.corners, corner) == 1);
    const auto made = std::ranges::find_if(
        after.corners, [&](const auto& corner) { return std::ranges::count(before.corners, corner) == 0; });
    CHECK(glm::distance(builder.corner(index, size_t(made - after.corners.begin())), from + 20.f * outward) < .5f);
    CHECK(builder.work.houseEdge == uint32_t(made - after.corners.begin()));
    CHECK(glm::distance(gable(), stands) < .5f);
    CHECK(builder.steps() == 1);
    CHECK(builder.roofs().hash != planned);

    builder.key(GLFW_KEY_DELETE);  // it is still the one in hand
    CHECK(builder.house(index).corners.size() == 4);
    CHECK(glm::distance(gable(), stands) < .5f);
    CHECK(builder.roofs().hash == planned);
    builder.undo();
    builder.undo();
    CHECK(builder.house(index) == before);
    CHECK(builder.roofs().hash == planned);
}

TEST_CASE("both halves of an edge that a new corner divides carry what the whole did") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("one-gable");
    builder.choose(index);
    const uint32_t gable = builder.house(index).edges.at(0).edge;
    const glm::vec2 from = builder.edge(index, gable), outward = glm::normalize(from - builder.middle(index));
    builder.drag(from, from + 20.f * outward, GLFW_MOD_CONTROL);
    const House after = builder.house(index);
    REQUIRE(after.edges.size() == 2);
    for (const House::Edge& edge : after.edges) CHECK(edge.end == "gable");
    CHECK(after.edges[1].edge == after.edges[0].edge + 1);
}

TEST_CASE("Del takes away the corner where the chosen edge begins, down to three, and undo gives it back") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("shed");
    builder.choose(index);
    const House before = builder.house(index);
    const uint64_t planned = builder.roofs().hash;
    builder.key(GLFW_KEY_DELETE);  // none is chosen
    CHECK_MESSAGE(contains(builder.work.message, "Click an edge"), builder.work.message);
    CHECK(builder.house(index) == before);
    builder.click(builder.edge(index, 1));
    builder.key(GLFW_KEY_DELETE);
    const House after = builder.house(index);
    CHECK(after.corners.size() == 3);
    CHECK(std::ranges::count(after.corners, before.corners[1]) == 0);
    CHECK(builder.roofs().hash != planned);
    builder.click(builder.edge(index, 0));
    builder.key(GLFW_KEY_X);
    CHECK(builder.house(index) == after);
    CHECK_MESSAGE(contains(builder.work.message, "three corners"), builder.work.message);
    CHECK(builder.steps() == 1);
    builder.undo();
    CHECK(builder.house(index) == before);
    CHECK(builder.roofs().hash == planned);
}

TEST_CASE("a corner that is let go over its neighbour becomes one with it, and one dragged into the sky stays") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("half-hip");
    builder.choose(index);
    const House before = builder.house(index);
    builder.drag(builder.corner(index, 0), builder.corner(index, 1) + glm::vec2(3, -3));
    const House merged = builder.house(index);
    CHECK(merged.corners.size() == 3);
    for (const auto& corner : merged.corners) CHECK(std::ranges::count(before.corners, corner) == 1);
    builder.undo();
    CHECK(builder.house(index) == before);

    builder.work.frameAll();
    builder.press(builder.corner(index, 0));
    builder.move({builder.mouse.x, 2});  // above the horizon
    CHECK(builder.house(index) == before);
    builder.release(builder.mouse);
    CHECK(builder.done.back().index() == Action(Undo{}).index());
}

TEST_CASE("a corner that is seen from a street moves by no more than a few times what the mouse does") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("mansard");
    builder.choose(index);
    const EspHouseInfo info = builder.info(index);
    const glm::vec3 target(info.boundsMin[0], info.eaveHeight, info.boundsMax[2]);
    for (const float above : {-2.f, -.4f, .4f, 2.f}) {
        CAPTURE(above);
        EspCamera camera = builder.work.camera.camera();
        const glm::vec3 eye = target + glm::vec3(0, above, 30);
        std::copy_n(&eye.x, 3, camera.eye);
        std::copy_n(&target.x, 3, camera.target);
        builder.work.lookFrom(camera);
        const House before = builder.house(index);
        const auto place = [&](const House& house, size_t i) {
            return glm::vec2(house.corners[i][0], house.corners[i][1]);
        };
        size_t nearest = 0;
        for (size_t i = 1; i < before.corners.size(); ++i)
            if (glm::distance(place(before, i), {eye.x, eye.z}) < glm::distance(place(before, nearest), {eye.x, eye.z}))
                nearest = i;
        const float distance =
            glm::distance(glm::vec3(before.corners[nearest][0], info.eaveHeight, before.corners[nearest][1]), eye);
        const float pixel = 1 / builder.work.camera.pixelsPerMetre(distance, builder.work.window.y);
        const glm::vec2 from = builder.corner(index, nearest);
        for (const float pixels : {-12.f, 12.f}) {
            builder.drag(from, from + glm::vec2(0, pixels));
            const float moved = glm::distance(place(builder.house(index), nearest), place(before, nearest));
            CHECK(moved > .8f * 12 * pixel);
            CHECK(moved < 5 * 12 * pixel);
            builder.undo();
            REQUIRE(builder.house(index) == before);
        }
    }
}

TEST_CASE("a courtyard's corners are dragged, added and taken away as the outline's are, and the roof keeps to them") {
    const Folder folder;
    Builder builder(folder, folder.write("court.json", R"({"buildings": [{"id": "court", "roof:shape": "hipped",
        "outer": [[0, 0], [24, 0], [24, 20], [0, 20]], "holes": [[[8, 7], [8, 13], [16, 13], [16, 7]]]}]})"));
    const House before = builder.house(0);
    REQUIRE(before.corners.size() == 8);
    REQUIRE(before.rings == std::vector<uint32_t>{4, 4});
    const auto place = [&](const House& house, size_t i) {
        return glm::vec2(house.corners[i][0], house.corners[i][1]);
    };
    const auto inner = [&](glm::vec2 plan) {  // that lies there
        const House now = builder.house(0);
        for (size_t i = 4; i < now.corners.size(); ++i)
            if (glm::distance(place(now, i), plan) < .3f) return i;
        FAIL("the courtyard has no corner there");
        return size_t(0);
    };
    // Who looks into the courtyard looks past the house.
    builder.click(builder.eave(0, {12, -10}));
    CHECK(!builder.work.house);
    builder.click(builder.eave(0, {4, -10}));
    REQUIRE(builder.work.house == 0u);
    const EspRoofStats planned = builder.roofs();

    builder.drag(builder.eave(0, {16, -13}), builder.eave(0, {19, -15}));
    const House wider = builder.house(0);
    CHECK(inner({19, -15}) >= 4);
    for (size_t i = 0; i < 4; ++i) CHECK(wider.corners[i] == before.corners[i]);
    CHECK(builder.work.houseEdge == uint32_t(inner({19, -15})));
    CHECK(builder.roofs().hash != planned.hash);

    builder.drag(builder.eave(0, {8, -10}), builder.eave(0, {6, -10}), GLFW_MOD_CONTROL);
    const House bent = builder.house(0);
    CHECK(bent.rings == std::vector<uint32_t>{4, 5});
    CHECK(inner({6, -10}) >= 4);
    // Dragged through the outline the courtyard is open there, and closed again when that is undone.
    builder.drag(builder.eave(0, {6, -10}), builder.eave(0, {-4, -10}), 0, 1);
    CHECK(builder.house(0).rings.size() == 1);
    builder.undo();
    CHECK(builder.house(0) == bent);

    const std::string project = folder.file("project");
    REQUIRE(builder.save(project));
    {
        Editing opened(project);
        House again = espalier::scene::houseNow(opened.context.get(), 0);
        CHECK(again.corners == bent.corners);
        CHECK(again.rings == bent.rings);
    }
    for (const uint32_t left : {4u, 3u}) {
        builder.work.houseEdge = uint32_t(inner(left == 4 ? glm::vec2(6, -10) : glm::vec2(19, -15)));
        builder.key(GLFW_KEY_DELETE);
        CHECK(builder.house(0).rings == std::vector<uint32_t>{4, left});
    }
    builder.work.houseEdge = 5;
    builder.key(GLFW_KEY_DELETE);  // the courtyard goes with the last three
    CHECK(builder.house(0).corners.size() == 4);
    // It stays away: through other changes, undo of what brings it back, and in a project.
    House steeper = builder.house(0);
    steeper.slope = 1.2f;
    REQUIRE(builder.work.perform(SetHouse{steeper}));
    const uint64_t closed = builder.roofs().hash;
    REQUIRE(builder.work.perform(ResetHouse{0}));
    CHECK(builder.house(0).corners.size() == 8);
    builder.undo();
    CHECK(builder.roofs().hash == closed);
    REQUIRE(builder.save(folder.file("closed")));
    {
        Editing opened(folder.file("closed"));
        CHECK(espalier::scene::houseNow(opened.context.get(), 0).corners.size() == 4);
    }
    while (builder.steps() > 0) builder.undo();
    CHECK(builder.house(0) == before);
    CHECK(builder.roofs().hash == planned.hash);
}

TEST_CASE("what is hidden of an outline is fainter than what is seen") {
    const Folder folder;
    Builder builder(folder);
    const uint32_t index = builder.named("pyramid");
    builder.choose(index);
    builder.key(GLFW_KEY_F);
    const auto faint = [&] {
        builder.mouse = {0, 0};
        builder.frame({});
        const auto& drawn = ImGui::GetBackgroundDrawList()->VtxBuffer;
        return std::ranges::count_if(drawn, [](const ImDrawVert& v) { return v.col >> IM_COL32_A_SHIFT == 120; });
    };
    CHECK(faint() == 0);  // from above
    builder.work.camera.turnTo(.7f, -.05f);
    CHECK(faint() > 0);  // the far side lies behind the roof
}
