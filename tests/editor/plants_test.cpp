// Branches that are pruned, plants that are frozen: through undo, and through a project.
#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;

namespace {

// A side branch of the first plant that a ray from the camera meets.
std::string someBranch(Editing& editing) {
    const EspCamera& camera = editing.document->scene().camera;
    const auto& foot = editing.document->scene().seeds[0].position;
    for (float up = .05f; up < 1.2f; up += .01f)
        for (float aside = -.4f; aside < .4f; aside += .02f) {
            const float to[3] = {foot[0] + aside - camera.eye[0], foot[1] + up - camera.eye[1],
                                 foot[2] - camera.eye[2]};
            EspPlantHit hit;
            if (espPickPlant(editing.context.get(), camera.eye, to, &hit) != ESP_OK || hit.depth == 0) continue;
            char key[20];
            std::snprintf(key, sizeof key, "%016llx", static_cast<unsigned long long>(hit.branch));
            return key;
        }
    return {};
}

uint32_t nodesOf(Editing& editing, size_t seed) {
    REQUIRE_MESSAGE(espUpdate(editing.context.get()) == ESP_OK, espLastError(editing.context.get()));
    EspPlantInfo plant{};
    REQUIRE(espPlantInfo(editing.context.get(), editing.document->scene().seeds[seed].planted, &plant) == ESP_OK);
    return plant.nodes;
}

}  // namespace

TEST_CASE("a pruned branch stays away, through undo, redo and a project") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const uint64_t whole = editing.hash();
    const std::string branch = someBranch(editing);
    REQUIRE(branch.size() == 16);
    REQUIRE_MESSAGE(editing.perform(PruneBranch{branch, true}), editing.error);
    const uint64_t pruned = editing.hash();
    CHECK(pruned != whole);
    REQUIRE(editing.perform(PruneBranch{branch, true}));
    CHECK(editing.document->undoSteps() == 1);  // what is so already is no step
    CHECK(!editing.perform(PruneBranch{"somewhere", true}));
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == whole);
    REQUIRE(editing.perform(Redo{}));
    CHECK(editing.hash() == pruned);
    std::string error;
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), error), error);
    Editing opened(folder.file("project"));
    CHECK(opened.hash() == pruned);
    REQUIRE(opened.perform(PruneBranch{branch, false}));
    CHECK(opened.hash() == whole);
}

TEST_CASE("a frozen plant stands while others change, through undo, replanting and a project") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const uint64_t before = editing.hash();
    const uint32_t first = nodesOf(editing, 0), second = nodesOf(editing, 1);
    const uint32_t key = editing.document->scene().seeds[0].key;
    REQUIRE_MESSAGE(editing.perform(FreezeSeeds{{key}, true}), editing.error);
    CHECK(editing.hash() == before);
    REQUIRE(editing.perform(SetParam{0, {"reach", {.4f}}}));
    CHECK(nodesOf(editing, 0) == first);
    CHECK(nodesOf(editing, 1) < second);
    // Another seed comes: all are planted anew, and the frozen one still stands.
    REQUIRE(editing.perform(AddSeeds{{{editing.document->freshKey(), 0, {0, 2, .4f}, {0, 1, 0}, 5}}, {2}}));
    CHECK(nodesOf(editing, 0) == first);
    const uint64_t mixed = editing.hash();

    std::string error;
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), error), error);
    {
        Editing opened(folder.file("project"));
        CHECK(opened.document->scene().notes.empty());
        CHECK(opened.hash() == mixed);
        CHECK(nodesOf(opened, 0) == first);
        REQUIRE(opened.perform(FreezeSeeds{{opened.document->scene().seeds[0].key}, false}));
        CHECK(nodesOf(opened, 0) < first);
    }
    REQUIRE(editing.perform(FreezeSeeds{{key}, false}));
    CHECK(nodesOf(editing, 0) < first);
    REQUIRE(editing.perform(Undo{}));
    CHECK(nodesOf(editing, 0) == first);
    CHECK(editing.hash() == mixed);
    REQUIRE(editing.perform(RemoveSeeds{{key}}));
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == mixed);
    for (int i = 0; i < 3; ++i) REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == before);
    CHECK(!editing.perform(FreezeSeeds{{99}, true}));
}

TEST_CASE("a seed's own values wait while its grammar's text has no such parameters, in a project too") {
    const Folder folder;
    Editing editing(wallScene(folder, false));
    SeedRecord seed = editing.document->recordOf(editing.document->scene().seeds[0]);
    seed.params = {{"twigs", {12}}};
    const uint64_t plain = editing.hash();
    REQUIRE_MESSAGE(editing.perform(ChangeSeeds{{seed}}), editing.error);
    const uint64_t twiggy = editing.hash();
    CHECK(twiggy != plain);
    const std::string ivy = editing.document->scene().grammars[0].text;
    REQUIRE(editing.perform(editing.document->withText(0, kCreeper)));
    const uint64_t creeping = editing.hash();
    // Planted anew, with another seed among them and without.
    const AddSeeds add{{{editing.document->freshKey(), 0, {0, .1f, 0}, {0, 1, 0}, 5}}, {0}};
    REQUIRE_MESSAGE(editing.perform(add), editing.error);
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == creeping);

    std::string error;
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), error), error);
    Editing opened(folder.file("project"));
    REQUIRE(opened.document->scene().notes.size() == 1);
    CHECK(contains(opened.document->scene().notes[0], "'twigs'"));
    CHECK(opened.hash() == creeping);
    REQUIRE(opened.perform(SetText{0, ivy, {{"reach", {1}}, {"twigs", {2}}}}));
    CHECK(opened.hash() == twiggy);
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == twiggy);
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == plain);
}

TEST_CASE("a seed's own value waits while its grammar's parameter is of another kind, and its plant stands") {
    const Folder folder;
    Editing editing(wallScene(folder, false));
    const std::string number = std::string("param spare = 1 [0 .. 2] \"m\" \"Spare\"\n") + kCreeper;
    const std::string colour = std::string("param spare = #ff8000 \"Spare\"\n") + kCreeper;
    REQUIRE(editing.perform(editing.document->withText(1, number)));
    REQUIRE(editing.perform(SetParam{1, {"spare", {.5f}}}));
    SeedRecord seed = editing.document->recordOf(editing.document->scene().seeds[1]);
    seed.params = {{"reach", {.4f}}, {"spare", {1.5f}}};
    REQUIRE_MESSAGE(editing.perform(ChangeSeeds{{seed}}), editing.error);
    const uint64_t before = editing.hash();
    const auto planted = [](const Editing& of) { return of.document->scene().seeds[1].planted.id != 0; };
    REQUIRE(editing.perform(editing.document->withText(1, colour)));
    REQUIRE_MESSAGE(editing.document->scene().grammars[1].error == "", editing.document->scene().grammars[1].error);
    CHECK(planted(editing));
    CHECK(editing.hash() == before);
    CHECK(editing.param(1, "spare") == 1);  // the text's own red

    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), editing.error), editing.error);
    Editing opened(folder.file("project"));
    CHECK(planted(opened));
    CHECK(opened.hash() == before);
    REQUIRE(opened.document->scene().notes.size() == 1);
    CHECK_MESSAGE(contains(opened.document->scene().notes[0], "'spare'"), opened.document->scene().notes[0]);
    REQUIRE(opened.perform(opened.document->withText(1, number)));
    CHECK(opened.document->scene().seeds[1].params.size() == 2);
    float value[3] = {};
    uint32_t count = 0;
    REQUIRE(espSeedParam(opened.context.get(), opened.document->scene().seeds[1].planted, "spare", value, &count) ==
            ESP_OK);
    CHECK(count == 1);
    CHECK(value[0] == 1.5f);
}

TEST_CASE("seeds of one number grow on as they do, whatever grammars they are of, in a project too") {
    const Folder folder;
    Editing editing(wallScene(folder, false));
    const uint64_t plain = editing.hash();
    // The creeper is the first of its number, the ivy the second.
    REQUIRE(editing.perform(AddSeeds{{{editing.document->freshKey(), 1, {0, .1f, 0}, {0, 1, 0}, 1}}, {0}}));
    const uint64_t before = editing.hash();
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), editing.error), editing.error);
    Editing opened(folder.file("project"));
    const auto& seeds = opened.document->scene().seeds;
    REQUIRE(seeds.size() == 3);
    CHECK(seeds[0].grammar == 1);
    CHECK(seeds[1].grammar == 0);
    CHECK(opened.hash() == before);
    REQUIRE_MESSAGE(saveProject(*opened.document, folder.file("again"), opened.error), opened.error);
    CHECK(readAll(folder.file("again/project.json")) == readAll(folder.file("project/project.json")));
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.hash() == plain);
    REQUIRE(saveProject(*editing.document, folder.file("plain"), editing.error));
    CHECK(!contains(readAll(folder.file("plain/project.json")), "\"place\""));
}

TEST_CASE("a seed that is named twice is frozen once, and thawed by one undo") {
    const Folder folder;
    Editing editing(wallScene(folder, false));
    editing.hash();
    const auto frozen = [&] { return editing.document->scene().seeds[0].frozen != nullptr; };
    const uint32_t key = editing.document->scene().seeds[0].key;
    REQUIRE_MESSAGE(editing.perform(FreezeSeeds{{key, key}, true}), editing.error);
    CHECK(frozen());
    REQUIRE(editing.perform(Undo{}));
    CHECK(!frozen());
    REQUIRE(editing.perform(Redo{}));
    CHECK(frozen());
}
