// Seeds that a user plants on the wall of the small scene, by clicks, drags and in rows, and each of these taken back
// by one step of undo.
#include "tests/editor/gardener.hpp"

TEST_CASE("a click plants one seed where the mouse points, which grows upward and is the one that is chosen") {
    const Folder folder;
    Gardener gardener(folder);
    const std::vector<SeedRecord> before = gardener.seeds();
    for (const glm::vec2 place : {gardener.onWall(-1.1f, 1), gardener.onWall(-.8f, 1.4f)}) {
        gardener.click(place);
        const SeedRecord planted = gardener.seeds().back();
        CHECK(planted.position == array(gardener.under(place)));
        CHECK(planted.direction == std::array<float, 3>{0, 1, 0});
        CHECK(planted.grammar == gardener.work.plantGrammar);
        CHECK(gardener.work.selected == Keys{planted.key});
    }
    REQUIRE(gardener.seeds().size() == before.size() + 2);
    CHECK(gardener.steps() == 2);
    const std::vector<SeedRecord> after = gardener.seeds();
    gardener.undo();
    gardener.undo();
    CHECK(gardener.seeds() == before);
    gardener.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    gardener.key(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
    CHECK(gardener.seeds() == after);

    faceWall(gardener, 8);
    const glm::vec2 sky = gardener.at({-.95f, 3.8f, .3f});
    REQUIRE(!gardener.work.pick(sky));
    gardener.click(sky);
    CHECK(gardener.seeds() == after);
    CHECK(gardener.work.selected.empty());
}

TEST_CASE("a drag plants a seed that grows the way it went, and Esc before its end plants none") {
    const Folder folder;
    Gardener gardener(folder);
    const std::vector<SeedRecord> before = gardener.seeds();
    const glm::vec2 from = gardener.onWall(-1.1f, 1), to = gardener.onWall(-.8f, 1.1f);
    gardener.press(from);
    gardener.moveTo(to, 6);
    CHECK(gardener.seeds() == before);
    gardener.key(GLFW_KEY_ESCAPE);
    gardener.release(to);
    CHECK(gardener.seeds() == before);
    CHECK(gardener.steps() == 0);

    gardener.drag(from, to, 0, 6);
    REQUIRE(gardener.seeds().size() == before.size() + 1);
    const SeedRecord planted = gardener.seeds().back();
    CHECK(planted.position == array(gardener.under(from)));
    CHECK(angle(vec(planted.direction), gardener.under(to) - gardener.under(from)) < .001f);
    CHECK(glm::length(vec(planted.direction)) == doctest::Approx(1));
    CHECK(gardener.steps() == 1);
}

TEST_CASE("Ctrl and a drag plant a row at even distances, as one step, however the way comes in moves") {
    const Folder folder;
    Gardener gardener(folder);
    const std::vector<SeedRecord> before = gardener.seeds();
    const glm::vec2 from = gardener.onWall(-1.25f, 1), to = gardener.onWall(-.65f, 1.05f);
    const float pixel = glm::distance(gardener.under(from), gardener.under(from + glm::vec2(10, 0))) / 10;
    for (const float step : {.06f, .13f})
        for (const int events : {1, 10, 300}) {
            CAPTURE(step);
            CAPTURE(events);
            gardener.work.layout.rowStep = step;
            gardener.drag(from, to, GLFW_MOD_CONTROL, events);
            const std::vector<SeedRecord> after = gardener.seeds();
            const size_t first = before.size();
            REQUIRE(after.size() > first);
            CHECK(after[first].position == array(gardener.under(from)));
            for (size_t i = first + 1; i < after.size(); ++i) {
                const float apart = glm::distance(vec(after[i].position), vec(after[i - 1].position));
                CHECK(apart >= step);
                CHECK(apart < step + 5 * pixel + .02f);  // between two looks, and joints between stones
                CHECK(after[i].direction == std::array<float, 3>{0, 1, 0});
            }
            CHECK(float(after.size() - first) > .6f * .6f / step);
            CHECK(gardener.work.selected.size() == after.size() - first);
            CHECK(gardener.steps() == 1);
            const std::string name = "Plant " + std::to_string(after.size() - first) + " seeds";
            CHECK(gardener.work.document->undoName() == name);
            gardener.undo();
            CHECK(gardener.work.message == "Undone: " + name);
            CHECK(gardener.seeds() == before);
        }
}

TEST_CASE("seeds of a row look along it if that is wanted, the first too") {
    const Folder folder;
    Gardener gardener(folder);
    const size_t first = gardener.seeds().size();
    gardener.work.layout.rowAlong = true;
    gardener.work.layout.rowStep = .1f;
    const glm::vec2 from = gardener.onWall(-1.25f, 1), to = gardener.onWall(-.65f, 1.1f);
    gardener.drag(from, to, GLFW_MOD_CONTROL, 20);
    const std::vector<SeedRecord> after = gardener.seeds();
    REQUIRE(after.size() > first + 3);
    for (size_t i = first; i < after.size(); ++i) {
        const size_t a = std::max(i, first + 1) - 1;
        CHECK(angle(vec(after[i].direction), vec(after[a + 1].position) - vec(after[a].position)) < .001f);
    }
    CHECK(gardener.steps() == 1);
    gardener.press(from + glm::vec2(0, 60), GLFW_MOD_CONTROL);
    gardener.moveTo(to + glm::vec2(0, 60), 20, GLFW_MOD_CONTROL);
    CHECK(gardener.seeds().size() > after.size() + 3);
    gardener.key(GLFW_KEY_ESCAPE);  // the whole row goes
    gardener.release(gardener.mouse);
    CHECK(gardener.seeds() == after);
}

TEST_CASE("a row that begins at a seed goes on from it, and moves none, chosen or not, nor an arrow") {
    const Folder folder;
    Gardener gardener(folder);
    gardener.work.layout.rowStep = .1f;
    const uint32_t key = gardener.plant(gardener.onWall(-1.2f, .8f));
    const std::vector<SeedRecord> before = gardener.seeds();
    const glm::vec2 arrow = gardener.at(vec(gardener.seed(key).position) + glm::vec3(0, .3f, 0));
    const auto row = [&](glm::vec2 from) {
        gardener.drag(from, from + glm::vec2(300, 0), GLFW_MOD_CONTROL, 20);
        const std::vector<SeedRecord> after = gardener.seeds();
        REQUIRE(after.size() > before.size() + 2);
        CHECK(std::equal(before.begin(), before.end(), after.begin()));
        CHECK(gardener.steps() == 2);
        return std::vector(after.begin() + std::ptrdiff_t(before.size()), after.end());
    };
    for (const bool chosen : {true, false}) {
        CAPTURE(chosen);
        gardener.work.selected = chosen ? Keys{key} : Keys{};
        const std::vector<SeedRecord> made = row(gardener.marker(key));
        const float apart = glm::distance(vec(made[0].position), vec(before.back().position));
        CHECK(apart >= .1f);
        CHECK(apart < .15f);
        CHECK(gardener.work.selected.size() == made.size() + 1);
        gardener.undo();
        REQUIRE(gardener.seeds() == before);
    }
    gardener.work.selected = {key};
    CHECK(row(arrow)[0].position == array(gardener.under(arrow)));
    gardener.undo();

    gardener.click(gardener.marker(key), GLFW_MOD_CONTROL);  // and without a drag it is chosen
    CHECK(gardener.seeds() == before);
    CHECK(gardener.work.selected == Keys{key});
}

TEST_CASE("no seed is planted, moved or turned to where it isn't seen: outside of the window, and beneath a panel") {
    const Folder folder;
    Gardener gardener(folder);
    faceWall(gardener, 1.5f);
    gardener.work.layout.rowStep = .06f;
    const glm::vec2 low(760, 300), high(860, 400);  // of a panel
    gardener.panels = [&] {
        ImGui::SetNextWindowPos({low.x, low.y});
        ImGui::SetNextWindowSize({high.x - low.x, high.y - low.y});
        ImGui::Begin("panel");
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) gardener.frame({});
    const size_t before = gardener.seeds().size();
    const auto hidden = [&](const SeedRecord& seed) {
        const glm::vec2 at = gardener.at(vec(seed.position));
        return at.y > gardener.work.window.y + 1 || glm::clamp(at, low + 1.f, high - 1.f) == at;
    };
    const auto rowIsSeen = [&] {
        const std::vector<SeedRecord> seeds = gardener.seeds();
        CHECK(seeds.size() > before + 2);
        CHECK(std::none_of(seeds.begin() + std::ptrdiff_t(before), seeds.end(), hidden));
    };
    const glm::vec2 beneath(810, 350), below(800, 900);
    (void)gardener.under(beneath), (void)gardener.under(below);  // there is something that they could go to
    for (const int events : {1, 30}) {
        CAPTURE(events);
        gardener.drag({600, 350}, {1000, 350}, GLFW_MOD_CONTROL, events);
        rowIsSeen();
        CHECK(gardener.at(vec(gardener.seeds().back().position)).x > high.x - 1);
        gardener.undo();
    }
    gardener.drag({700, 500}, below, GLFW_MOD_CONTROL, 30);
    rowIsSeen();
    gardener.undo();

    const uint32_t a = gardener.plant({650, 350}), b = gardener.plant({650, 500});
    for (const glm::vec2 to : {beneath, below}) {
        gardener.work.selected = {b};
        const glm::vec2 from = gardener.marker(b);
        gardener.press(from);
        gardener.moveTo(glm::mix(from, to, .2f), 4);
        const SeedRecord seen = gardener.seed(b);
        gardener.move(to);
        CHECK(gardener.seed(b) == seen);
        gardener.release(to);
        gardener.undo();
        // Several go on from where they were seen last.
        gardener.work.selected = {a, b};
        const glm::vec3 apart = vec(gardener.seed(a).position) - vec(gardener.seed(b).position);
        gardener.press(from);
        gardener.move(to);
        CHECK(gardener.marker(b) == from);
        gardener.move(from + glm::vec2(20, 0));
        gardener.release(gardener.mouse);
        CHECK(glm::distance(gardener.marker(b), from + glm::vec2(20, 0)) < 5);
        CHECK(glm::distance(vec(gardener.seed(a).position) - vec(gardener.seed(b).position), apart) < .001f);
        gardener.undo();
    }
    gardener.work.selected = {b};
    gardener.move(gardener.marker(b) + glm::vec2(60, 0));
    gardener.key(GLFW_KEY_R);
    gardener.moveTo(gardener.mouse + glm::vec2(0, 20), 2);
    const SeedRecord turned = gardener.seed(b);
    gardener.move(beneath);
    CHECK(gardener.seed(b) == turned);
    gardener.key(GLFW_KEY_ESCAPE);
}

TEST_CASE("a chosen seed that looks along the view has a ring around it, away from it a crossed one") {
    const Folder folder;
    Gardener gardener(folder);
    const uint32_t key = gardener.plant(gardener.onWall(-1, 1));
    // How far from the seed its marks reach, in pixels, and of how many corners these are.
    const auto marks = [&](glm::vec3 direction) {
        SeedRecord seed = gardener.seed(key);
        seed.direction = array(glm::normalize(direction));
        REQUIRE(gardener.work.perform(ChangeSeeds{{seed}}));
        gardener.frame({});
        const glm::vec2 at = gardener.marker(key);
        float reach = 0;
        size_t corners = 0;
        for (const ImDrawVert& v : ImGui::GetBackgroundDrawList()->VtxBuffer) {
            const float away = glm::distance(at, glm::vec2(v.pos.x, v.pos.y));
            if (away > 30) continue;
            reach = std::max(reach, away);
            ++corners;
        }
        return std::pair(reach, corners);
    };
    const glm::vec3 towards = gardener.work.camera.eye() - vec(gardener.seed(key).position);
    const auto [near, ring] = marks(towards);
    const auto [far, crossed] = marks(-towards);
    CHECK(near > 8);
    CHECK(near < 14);
    CHECK(far == doctest::Approx(near));
    CHECK(crossed > ring);
}
