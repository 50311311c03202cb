// How much of undo is kept, and what of it goes first.
#include "tests/editor/editing.hpp"
#include "tools/scene/hash.hpp"

using namespace espalier::document;

namespace {

void paint(Editing& editing, float x) {
    StrokeBegin stroke;
    stroke.layer = "mask";
    stroke.radius = .2f;
    stroke.value = 0;
    for (const Action& action : {Action(stroke), Action(StrokeDabs{{{x, 1, 0, 0, 0, 1, 1}}}), Action(StrokeEnd{})})
        REQUIRE_MESSAGE(editing.perform(action), editing.error);
}

std::string masked(Editing& editing) {
    espalier::scene::GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(0, "mask", picture, editing.error), editing.error);
    return espalier::scene::hashName(picture.texels.data(), picture.texels.size() * sizeof(float));
}

// Freezes a plant; the bytes that it is kept in.
size_t freeze(Editing& editing, size_t seed) {
    editing.hash();
    REQUIRE_MESSAGE(editing.perform(FreezeSeeds{{editing.document->scene().seeds[seed].key}}), editing.error);
    return editing.document->scene().seeds[seed].frozen->size();
}

}  // namespace

TEST_CASE("past its bound undo forgets the oldest steps, and takes back all that are left") {
    const Folder folder;
    constexpr size_t kBound = 20000;
    constexpr int kStrokes = 40;
    Editing editing(wallScene(folder, false), 20000, kBound);
    Document& document = *editing.document;
    std::vector<std::string> layers;
    std::vector<uint64_t> states;
    const auto note = [&] {
        layers.push_back(masked(editing));
        states.push_back(document.state());
        CHECK(document.historyBytes() <= kBound);
    };
    note();
    for (int i = 0; i < kStrokes; ++i) {
        paint(editing, -1.8f + .09f * float(i));
        note();
    }
    const size_t left = document.undoSteps();
    CHECK(left > 5);
    CHECK(left < kStrokes - 5);
    CHECK(document.historyBytes() > kBound / 2);
    for (size_t i = 1; i <= left; ++i) {
        REQUIRE(editing.perform(Undo{}));
        CHECK(masked(editing) == layers[kStrokes - i]);
        CHECK(document.state() == states[kStrokes - i]);
        CHECK(document.historyBytes() <= kBound);
    }
    CHECK(!editing.perform(Undo{}));
    for (size_t i = 0; i < left; ++i) REQUIRE(editing.perform(Redo{}));
    CHECK(masked(editing) == layers.back());
    CHECK(document.state() == states.back());

    // One step that is too large by itself is kept, and alone.
    REQUIRE(editing.perform(FillLayer{"mask", .3f}));
    CHECK(document.undoSteps() == 1);
    REQUIRE(editing.perform(Undo{}));
    CHECK(masked(editing) == layers.back());
}

TEST_CASE("seeds and the plants that they are frozen as count for undo's bound") {
    const Folder folder;
    const std::string scene = wallScene(folder, false);
    size_t plant = 0;
    {
        Editing editing(scene);
        Document& document = *editing.document;
        plant = freeze(editing, 0);
        const uint32_t key = document.scene().seeds[0].key;
        size_t before = document.historyBytes();
        CHECK(before < plant);  // the plant is the scene's
        for (int i = 0; i < 100; ++i) {
            SeedRecord seed = document.recordOf(document.scene().seeds[0]);
            seed.params = {{"reach", {.5f + .01f * float(i)}}};
            REQUIRE_MESSAGE(editing.perform(ChangeSeeds{{seed}}), editing.error);
        }
        const size_t changes = document.historyBytes() - before;
        CHECK(changes > 100 * (sizeof(Action) + sizeof(SeedRecord)));
        CHECK(changes < 100 * 2 * (sizeof(Action) + sizeof(SeedRecord)));
        CHECK(document.scene().seeds[0].frozen.use_count() == 1);  // they keep no plant
        before = document.historyBytes();
        REQUIRE(editing.perform(RemoveSeeds{{key}}));
        CHECK(document.historyBytes() > before + plant);  // now it is undo's
        REQUIRE(editing.perform(Undo{}));
        CHECK(document.historyBytes() < before + plant);
    }
    // Undone, plants are what redo keeps: those that are farthest from being done again go first.
    Editing editing(scene, 20000, plant * 5 / 2);
    Document& document = *editing.document;
    constexpr uint32_t kPlants = 6;
    AddSeeds add;
    for (uint32_t i = 0; i < kPlants - 2; ++i) {
        add.seeds.push_back({document.freshKey(), 0, {-1, .1f, 0}, {0, 1, 0}, 1});  // twins of the first
        add.places.push_back(2 + i);
    }
    REQUIRE_MESSAGE(editing.perform(add), editing.error);
    for (uint32_t i = 0; i < kPlants; ++i) freeze(editing, i);
    REQUIRE(document.undoSteps() == 1 + kPlants);
    for (uint32_t i = 0; i < kPlants; ++i) {
        REQUIRE(editing.perform(Undo{}));
        CHECK(document.historyBytes() <= plant * 5 / 2);
    }
    uint32_t again = 0;
    for (; document.redoName(); ++again) REQUIRE_MESSAGE(editing.perform(Redo{}), editing.error);
    CHECK(again > 0);
    CHECK(again < kPlants);
    for (uint32_t i = 0; i < kPlants; ++i) CHECK(bool(document.scene().seeds[i].frozen) == (i < again));
}
