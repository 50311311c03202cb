// Seeds that a user chooses on the wall of the small scene: moved, turned, copied and removed, each taken back by one
// step of undo, and what frozen ones are left.
#include "tests/editor/gardener.hpp"

TEST_CASE("a click chooses a seed, Shift one more or one less, Shift and a drag those within, A all or none") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, 1)), b = gardener.plant(gardener.onWall(-1, 1)),
                   c = gardener.plant(gardener.onWall(-.8f, 1.4f));
    const std::vector<SeedRecord> before = gardener.seeds();
    const Keys& chosen = gardener.work.selected;
    const size_t steps = gardener.steps();
    gardener.click(gardener.marker(a) + glm::vec2(6, -6));  // beside it, within its reach
    CHECK(chosen == Keys{a});
    gardener.click(gardener.marker(b), GLFW_MOD_SHIFT);
    CHECK(chosen == Keys{a, b});
    gardener.click(gardener.marker(c), GLFW_MOD_SHIFT);
    gardener.click(gardener.marker(a), GLFW_MOD_SHIFT);
    CHECK(chosen == Keys{b, c});
    gardener.click(gardener.marker(b));
    CHECK(chosen == Keys{b});

    gardener.drag(gardener.marker(a) - glm::vec2(40, 40), gardener.marker(b) + glm::vec2(20, 40), GLFW_MOD_SHIFT);
    CHECK(chosen == Keys{a, b});
    gardener.drag(gardener.marker(c) + glm::vec2(30, 30), gardener.marker(c) - glm::vec2(30, 30), GLFW_MOD_SHIFT);
    CHECK(chosen == Keys{a, b, c});  // besides what is chosen, whichever way it is drawn
    gardener.key(GLFW_KEY_A);
    CHECK(chosen.size() == before.size());
    gardener.key(GLFW_KEY_A);
    CHECK(chosen.size() == before.size());
    gardener.key(GLFW_KEY_A, GLFW_MOD_ALT);
    CHECK(chosen.empty());
    CHECK(gardener.seeds() == before);
    CHECK(gardener.steps() == steps);
}

TEST_CASE("a drag moves what is chosen as one step, a single seed onto the surface under the mouse") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, .9f)), b = gardener.plant(gardener.onWall(-1, .9f));
    const std::vector<SeedRecord> before = gardener.seeds();
    const size_t steps = gardener.steps();
    const glm::vec2 to = gardener.onWall(-.8f, 1.3f);
    gardener.drag(gardener.marker(b), to, 0, 9);
    CHECK(gardener.seed(b).position == array(gardener.under(to)));
    CHECK(gardener.seed(b).direction == before.back().direction);
    CHECK(gardener.steps() == steps + 1);
    gardener.undo();
    CHECK(gardener.seeds() == before);
    CHECK(gardener.steps() == steps);

    gardener.click(gardener.marker(a));
    gardener.click(gardener.marker(b), GLFW_MOD_SHIFT);
    const glm::vec2 from = gardener.marker(b);
    const glm::vec3 by = gardener.under(to) - gardener.under(from);
    gardener.press(from);
    gardener.moveTo(to, 9);
    for (const uint32_t key : {a, b}) {
        const SeedRecord was = *std::ranges::find(before, key, &SeedRecord::key);
        CHECK(glm::distance(vec(gardener.seed(key).position), vec(was.position) + by) < .001f);
    }
    gardener.release(to);
    CHECK(gardener.work.selected == Keys{a, b});
    CHECK(gardener.steps() == steps + 1);
    gardener.undo();
    CHECK(gardener.seeds() == before);

    // A hand that trembles in a click moves nothing.
    gardener.drag(gardener.marker(a), gardener.marker(a) + glm::vec2(2, 2));
    CHECK(gardener.seeds() == before);
    CHECK(gardener.work.selected == Keys{a});
    gardener.press(gardener.marker(a));
    gardener.moveTo(to, 5);
    gardener.key(GLFW_KEY_ESCAPE);
    gardener.moveTo(from, 5);
    gardener.release(from);
    CHECK(gardener.seeds() == before);
    CHECK(gardener.steps() == steps);
}

TEST_CASE("Shift and a drag choose also where they begin on an arrow") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t key = gardener.plant(gardener.onWall(-1.1f, 1));
    const SeedRecord before = gardener.seed(key);
    const glm::vec2 tip = gardener.at(vec(before.position) + .3f * glm::normalize(vec(before.direction)));
    gardener.drag(tip, tip + glm::vec2(60, 40), GLFW_MOD_SHIFT);
    CHECK(gardener.seed(key) == before);
    CHECK(gardener.steps() == 1);
    CHECK(gardener.work.selected == Keys{key});
}

TEST_CASE("the arrow of a chosen seed, dragged, and R turn what is chosen to where the mouse points") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, .8f)), b = gardener.plant(gardener.onWall(-1, .8f));
    const std::vector<SeedRecord> before = gardener.seeds();
    const size_t steps = gardener.steps();
    const glm::vec2 to = gardener.onWall(-.7f, 1.2f);
    const auto turned = [&](uint32_t key) {
        return angle(vec(gardener.seed(key).direction), gardener.under(to) - vec(gardener.seed(key).position)) < .001f;
    };
    gardener.drag(gardener.at(vec(gardener.seed(b).position) + glm::vec3(0, .3f, 0)), to);  // as long as it is drawn
    CHECK(turned(b));
    CHECK(gardener.seed(b).position == before.back().position);
    CHECK(gardener.seed(a) == before[before.size() - 2]);
    CHECK(gardener.steps() == steps + 1);
    gardener.undo();
    CHECK(gardener.seeds() == before);

    gardener.click(gardener.marker(a), GLFW_MOD_SHIFT);
    CHECK(gardener.work.selected == Keys{a, b});
    gardener.move(gardener.onWall(-1, 1));
    gardener.key(GLFW_KEY_R);
    CHECK(gardener.work.underWay);
    gardener.moveTo(to, 6);
    gardener.click(to);
    CHECK(!gardener.work.underWay);
    gardener.moveTo(gardener.onWall(-1, 1), 6);  // it is kept
    CHECK(turned(a));
    CHECK(turned(b));
    CHECK(gardener.steps() == steps + 1);
    CHECK(gardener.seeds().size() == before.size());
}

TEST_CASE("Shift+D makes copies that follow the mouse, as one step, and Esc takes them away again") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, .9f)), b = gardener.plant(gardener.onWall(-1, .9f));
    SeedRecord own = gardener.seed(b);
    own.params = {{"reach", {.5f}}};
    REQUIRE(gardener.work.perform(ChangeSeeds{{own}}));
    const std::vector<SeedRecord> before = gardener.seeds();
    const size_t steps = gardener.steps();
    gardener.work.selected = {a, b};
    const glm::vec2 from = gardener.onWall(-1, 1), to = gardener.onWall(-.8f, 1.3f);
    const glm::vec3 by = gardener.under(to) - gardener.under(from);
    for (const int mods : {GLFW_MOD_SHIFT, GLFW_MOD_CONTROL}) {
        CAPTURE(mods);
        gardener.move(from);
        gardener.key(GLFW_KEY_D, mods);
        CHECK(gardener.seeds().size() == before.size() + 2);
        gardener.moveTo(to, 6);
        gardener.key(GLFW_KEY_ESCAPE);
        CHECK(gardener.seeds() == before);
        CHECK(gardener.work.selected == Keys{a, b});
        CHECK(gardener.steps() == steps);
    }
    gardener.move(from);
    gardener.key(GLFW_KEY_D, GLFW_MOD_SHIFT);
    gardener.moveTo(to, 6);
    gardener.click(to);
    gardener.moveTo(from, 3);  // they stay
    const std::vector<SeedRecord> after = gardener.seeds();
    REQUIRE(after.size() == before.size() + 2);
    CHECK(std::equal(before.begin(), before.end(), after.begin()));
    for (size_t i = 0; i < 2; ++i) {
        const SeedRecord &copy = after[before.size() + i], &of = before[before.size() - 2 + i];
        CHECK(gardener.work.selected.count(copy.key));
        CHECK(glm::distance(vec(copy.position), vec(of.position) + by) < .001f);
        CHECK(copy.direction == of.direction);
        CHECK(copy.params == of.params);
        CHECK(copy.number != of.number);
    }
    CHECK(gardener.steps() == steps + 1);
    gardener.undo();
    CHECK(gardener.seeds() == before);

    // Of seeds that aren't there any more there are no copies, and they can still be brought back.
    gardener.key(GLFW_KEY_D, GLFW_MOD_SHIFT);
    CHECK(gardener.steps() == steps);
    gardener.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    CHECK(gardener.seeds() == after);
}

TEST_CASE(
    "G moves what is chosen without a button, until a click keeps it, or Esc, Ctrl+Z or the right button give it "
    "back") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, .8f));
    const std::vector<SeedRecord> before = gardener.seeds();
    const size_t steps = gardener.steps();
    const glm::vec2 from = gardener.onWall(-1, 1), to = gardener.onWall(-.7f, 1.2f), stood = gardener.marker(a);
    // By as much as the mouse, wherever that was.
    const auto off = [&] { return glm::distance(gardener.marker(a) - stood, to - from); };
    for (const int how : {0, 1, 2}) {
        CAPTURE(how);
        gardener.move(from);
        gardener.key(GLFW_KEY_G);
        gardener.move(from + glm::vec2(1, 0));
        CHECK(glm::distance(gardener.marker(a), stood) < 2);
        gardener.moveTo(to, 5);
        CHECK(off() < 1);
        if (how == 0) gardener.key(GLFW_KEY_ESCAPE);
        if (how == 1) gardener.click(to, 0, GLFW_MOUSE_BUTTON_RIGHT);
        if (how == 2) gardener.undo();
        gardener.moveTo(from, 5);
        CHECK(gardener.seeds() == before);
        CHECK(gardener.steps() == steps);
        CHECK(gardener.work.selected == Keys{a});
        CHECK(!gardener.work.underWay);
    }
    gardener.key(GLFW_KEY_G);
    gardener.key(GLFW_KEY_ESCAPE);  // before a move: nothing was done that it could take back
    CHECK(gardener.seeds() == before);
    CHECK(gardener.steps() == steps);

    gardener.key(GLFW_KEY_G);
    gardener.moveTo(to, 5);
    gardener.click(to);
    gardener.moveTo(from, 5);
    CHECK(off() < 1);
    CHECK(gardener.seeds().size() == before.size());
    CHECK(gardener.steps() == steps + 1);
}

TEST_CASE("seeds that undo has taken away count as chosen only once redo has brought them back") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, .8f)), b = gardener.plant(gardener.onWall(-1, .8f));
    const glm::vec2 to = gardener.onWall(-.7f, 1.2f);
    gardener.undo();
    REQUIRE(gardener.work.selected == Keys{b});
    gardener.key(GLFW_KEY_G);  // nothing that it could move is chosen
    CHECK(!gardener.work.underWay);
    gardener.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    gardener.key(GLFW_KEY_G);
    CHECK(gardener.work.underWay);
    gardener.key(GLFW_KEY_ESCAPE);
    gardener.undo();
    gardener.click(gardener.marker(a), GLFW_MOD_SHIFT);
    REQUIRE(gardener.work.selected == Keys{a, b});
    gardener.drag(gardener.marker(a) + glm::vec2(8, 0), to, 0, 5);  // the only one goes where the mouse is
    CHECK(gardener.seed(a).position == array(gardener.under(to)));
}

TEST_CASE("Del and X remove what is chosen, and undo brings all of it back, chosen") {
    const Folder folder;
    Gardener gardener(folder);
    (void)gardener.plant(gardener.onWall(-1.2f, .8f));
    const std::vector<SeedRecord> before = gardener.seeds();
    REQUIRE(before.size() == 3);
    const size_t steps = gardener.steps();
    for (const int key : {GLFW_KEY_DELETE, GLFW_KEY_X}) {
        gardener.work.selected = {before[0].key, before[2].key};
        gardener.key(key);
        CHECK(gardener.seeds() == std::vector{before[1]});
        CHECK(gardener.steps() == steps + 1);
        gardener.key(key);  // those that are gone aren't chosen
        CHECK(gardener.work.message == "No seed is chosen: click one");
        CHECK(gardener.steps() == steps + 1);
        gardener.undo();  // nor are others, once they are back
        CHECK(gardener.seeds() == before);
        CHECK(gardener.work.selected == Keys{before[0].key, before[2].key});
        gardener.work.message.clear();
    }
}

TEST_CASE("a frozen plant stays where it is, and says so") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t a = gardener.plant(gardener.onWall(-1.2f, .8f)), b = gardener.plant(gardener.onWall(-1, .8f));
    gardener.work.freeze({a}, true);
    REQUIRE(gardener.work.document->seed(a)->frozen);
    const SeedRecord before = gardener.seed(a);
    gardener.click(gardener.marker(a), GLFW_MOD_SHIFT);
    REQUIRE(gardener.work.selected == Keys{a, b});
    const glm::vec3 stood = vec(gardener.seed(b).position);
    gardener.drag(gardener.marker(b), gardener.onWall(-.8f, 1.2f));
    CHECK(gardener.seed(a) == before);
    CHECK(glm::distance(vec(gardener.seed(b).position), stood) > .3f);
    CHECK_MESSAGE(contains(gardener.work.message, "frozen"), gardener.work.message);
}

TEST_CASE("why nothing is done is told, also where something else has failed before") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t key = gardener.plant(gardener.onWall(-1, .8f));
    gardener.work.freeze({key}, true);
    const glm::vec2 frozen = gardener.marker(key), there = gardener.onWall(-.8f, 1.2f);
    const auto told = [&](const char* what, const std::function<void()>& act) {
        CAPTURE(what);
        gardener.work.error = "what failed before";
        act();
        CHECK_MESSAGE(gardener.work.error.empty(), gardener.work.error);
        CHECK_MESSAGE(contains(gardener.work.message, what), gardener.work.message);
    };
    told("A frozen plant stays", [&] { gardener.drag(frozen, there); });
    faceWall(gardener, 8);
    const glm::vec2 sky = gardener.at({-.95f, 3.8f, .3f});
    REQUIRE(!gardener.work.pick(sky));
    told(sample::kNoGround, [&] { gardener.click(sky); });
    told(sample::kNoGround, [&] { gardener.click(sky, GLFW_MOD_CONTROL); });
    told("No seed is chosen", [&] { gardener.key(GLFW_KEY_DELETE); });
    while (gardener.steps() > 0) gardener.undo();
    told("Nothing to undo", [&] { gardener.undo(); });
    gardener.key(GLFW_KEY_P);
    told("No branch there", [&] { gardener.click(sky); });
    told("No branch is picked", [&] { gardener.key(GLFW_KEY_DELETE); });
}

TEST_CASE("what is changed of a frozen plant's seed is kept for when it is thawed, and that is told") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t key = gardener.plant(gardener.onWall(-1, .8f));
    gardener.panels = [&] {
        ImGui::SetNextWindowSize({500, 700});
        ImGui::Begin("panel");
        sample::seedsPanel(gardener.work);
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) gardener.frame({});
    pressWidget(gardener, "panel", {"Values of their own"});
    const std::vector<Part> box{"Values of their own", int(key), "scale", "Scale of all lengths (a 3 m wall: 1)"};
    const auto& news = gardener.work.message;
    for (const bool frozen : {true, false}) {
        CAPTURE(frozen);
        gardener.work.freeze({key}, frozen);
        const uint32_t number = gardener.seed(key).number;
        pressWidget(gardener, "panel", {"Another"});
        CHECK(gardener.seed(key).number != number);
        CHECK_MESSAGE(contains(news, "frozen") == frozen, news);
        pressWidget(gardener, "panel", box);
        CHECK(gardener.seed(key).params.size() == (frozen ? 1 : 0));
        CHECK_MESSAGE(contains(news, "frozen") == frozen, news);
        gardener.key(GLFW_KEY_R, GLFW_MOD_SHIFT);
        CHECK_MESSAGE(contains(news, "frozen") == frozen, news);
    }
}
