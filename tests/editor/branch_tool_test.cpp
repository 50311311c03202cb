// Branches under a user's mouse: what a click would pick is shown before, and F shows the whole of what is chosen.
#include "sample_game/panels.hpp"
#include "tests/editor/widgets.hpp"

using sample::Tool;
using sample::vec;

namespace {

struct Pruner : Editor {
    explicit Pruner(const Folder& folder) : Editor(folder, smallScene(folder), Tool::branch) {
        REQUIRE(espUpdate(work.context.get()) == ESP_OK);
        REQUIRE(work.readStats());
    }
    // Lays it out in a panel at the left, 300 units high; `words` are what is written there from then on.
    void open(std::string& words, void (*panel)(sample::Workspace&)) {
        panels = [this, &words, panel] {
            words = wordsOf([&] {
                ImGui::SetNextWindowPos({0, 0});
                ImGui::SetNextWindowSize({work.panelUnits(), 300});
                ImGui::Begin("panel");
                panel(work);
                ImGui::End();
            });
        };
    }
    // Where a branch would be picked; it is what was found by rays of the test's own.
    std::pair<glm::vec2, uint64_t> someBranch() const {
        for (float y = 20; y < work.window.y; y += 9)
            for (float x = work.panelUnits() + 20; x < work.window.x; x += 9) {
                const sample::Ray ray = work.rayThrough({x, y});
                EspPlantHit hit;
                if (espPickPlant(work.context.get(), &ray.origin.x, &ray.direction.x, &hit) == ESP_OK)
                    return {{x, y}, hit.branch};
            }
        FAIL("no branch is seen");
        return {};
    }
};

bool sameWalk(const std::vector<EspPathSample>& a, const std::vector<EspPathSample>& b) {
    return std::ranges::equal(
        a, b, [](const EspPathSample& s, const EspPathSample& t) { return vec(s.position) == vec(t.position); });
}

}  // namespace

TEST_CASE("the branch under the mouse is the one that a click picks") {
    const Folder folder;
    Pruner pruner(folder);
    const auto [at, branch] = pruner.someBranch();
    pruner.move(at);
    REQUIRE(pruner.work.pointed.size() > 1);
    CHECK(!pruner.work.branch);
    const auto pointed = pruner.work.pointed;
    pruner.click(at);
    CHECK(pruner.work.branch == branch);
    CHECK(sameWalk(pointed, pruner.work.path));
    // Beside it there is none, nor while another tool is in hand.
    pruner.move({pruner.work.panelUnits() + 2, 2});
    CHECK(pruner.work.pointed.empty());
    pruner.move(at);
    REQUIRE(!pruner.work.pointed.empty());
    pruner.key(GLFW_KEY_S);
    CHECK(pruner.work.pointed.empty());
}

TEST_CASE("a branch of a frozen plant isn't pruned before it is thawed, and that is told") {
    const Folder folder;
    Pruner pruner(folder);
    auto& work = pruner.work;
    std::string words;
    pruner.open(words, sample::branchPanel);
    pruner.click(pruner.someBranch().first);
    pruner.frame({});
    CHECK_MESSAGE(contains(words, "Ends"), words);
    REQUIRE(work.branchSeed());
    const uint32_t key = work.branchSeed()->key;
    work.freeze({key}, true);
    const size_t steps = work.document->undoSteps();
    pruner.key(GLFW_KEY_DELETE);
    CHECK_MESSAGE(contains(work.message, "thaw it to prune"), work.message);
    CHECK(work.branch);
    pressWidget(pruner, "panel", {"Prune  Del"});
    CHECK(work.document->undoSteps() == steps);
    CHECK(espPrunedCount(work.context.get()) == 0);
    // The disabled button says why it is.
    const ImGuiID button = widget("panel", {"Prune  Del"});
    for (pruner.mouse = {80, 0}; ImGui::GetCurrentContext()->HoveredId != button; pruner.mouse.y += 4) {
        REQUIRE(pruner.mouse.y < 300);
        pruner.frame({});
    }
    pruner.mouse.y -= 4;
    ImGui::GetIO().DeltaTime = .3f;
    for (int i = 0; i < 4; ++i) pruner.frame({});
    CHECK_MESSAGE(contains(words, "thaw it to prune"), words);
    const ImGuiWindow* tip = ImGui::FindWindowByName("##Tooltip_00");
    REQUIRE((tip && tip->WasActive));
    CHECK(tip->Pos.x >= work.panelUnits());  // it covers nothing of the panel

    work.freeze({key}, false);
    pruner.key(GLFW_KEY_DELETE);
    CHECK(work.document->undoSteps() == steps + 2);
    CHECK(espPrunedCount(work.context.get()) == 1);
}

TEST_CASE("a picked branch is its seed's, though all seeds have been planted anew and nothing has grown") {
    const Folder folder;
    Pruner pruner(folder);
    auto& work = pruner.work;
    const auto grow = [&] {
        const uint32_t before = work.stats.expansions;
        REQUIRE(espUpdate(work.context.get()) == ESP_OK);
        REQUIRE(work.readStats());
        const bool plants = work.stats.expansions != before;
        work.noteGrown(plants);
        return plants;
    };
    const auto plantAnew = [&] {
        work.renumberSeeds();
        REQUIRE(work.perform(espalier::document::Undo{}));
    };
    plantAnew();
    grow();
    pruner.click(pruner.someBranch().first);
    REQUIRE(work.branchSeed());
    const uint32_t key = work.branchSeed()->key;
    plantAnew();
    CHECK(!grow());
    REQUIRE(work.branchSeed());
    CHECK(work.branchSeed()->key == key);
}

TEST_CASE("F shows the whole plant of the chosen seed") {
    const Folder folder;
    Pruner pruner(folder);
    pruner.key(GLFW_KEY_S);
    const auto& seed = pruner.work.scene().seeds.front();
    EspPlantInfo plant{};
    REQUIRE(espPlantInfo(pruner.work.context.get(), seed.planted, &plant) == ESP_OK);
    REQUIRE(plant.nodes > 10);
    const float size = glm::distance(vec(plant.boundsMin), vec(plant.boundsMax));
    REQUIRE(size > .3f);
    pruner.work.selected = {seed.key};
    pruner.key(GLFW_KEY_F);
    glm::vec2 low(1e9f), high(-1e9f);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::bvec3 far(corner & 1, corner & 2, corner & 4);
        const glm::vec2 at = pruner.at(glm::mix(vec(plant.boundsMin), vec(plant.boundsMax), far));
        low = glm::min(low, at), high = glm::max(high, at);
    }
    CHECK(low.x >= pruner.work.panelUnits());
    CHECK(low.y >= 0);
    CHECK(high.x <= pruner.work.window.x);
    CHECK(high.y <= pruner.work.window.y);
    CHECK(std::max(high.x - low.x, high.y - low.y) > .3f * pruner.work.window.y);
}

TEST_CASE("all that was pruned grows again by one step, which is called so") {
    const Folder folder;
    Pruner pruner(folder);
    auto& work = pruner.work;
    pruner.panels = [&] {
        ImGui::Begin("panel");
        sample::branchPanel(work);
        ImGui::End();
    };
    for (const char* branch : {"0000000000000001", "0000000000000002"})
        REQUIRE(work.perform(espalier::document::PruneBranch{branch, true}));
    for (int i = 0; i < 3; ++i) pruner.frame({});
    pressWidget(pruner, "panel", {"Let all grow again"});
    CHECK(espPrunedCount(work.context.get()) == 0);
    CHECK(work.document->undoSteps() == 3);
    CHECK(std::string(work.document->undoName()) == "Let all grow again");
    pruner.undo();
    CHECK(espPrunedCount(work.context.get()) == 2);
}

TEST_CASE("of a seed whose plant is pruned the panel says so, and nothing once it grows again") {
    const Folder folder;
    Pruner pruner(folder);
    auto& work = pruner.work;
    std::string words;
    pruner.open(words, sample::seedsPanel);
    const uint32_t seed = work.scene().seeds[0].key;
    const auto grown = [&] {
        REQUIRE(espUpdate(work.context.get()) == ESP_OK);
        REQUIRE(work.readStats());
        work.grownRevision = work.document->revision();
        for (int i = 0; i < 2; ++i) pruner.frame({});
    };
    const auto [at, branch] = pruner.someBranch();
    pruner.click(at);
    while (work.branchInfo.depth > 0) work.pickParent();
    work.choose(Tool::seeds);
    work.selected = {seed};
    grown();
    CHECK_MESSAGE(!contains(words, "Nothing grows"), words);
    work.prune();
    grown();
    CHECK_MESSAGE(contains(words, "it is pruned"), words);
    REQUIRE(work.perform(espalier::document::Undo{}));
    grown();
    CHECK_MESSAGE(!contains(words, "Nothing grows"), words);
}
