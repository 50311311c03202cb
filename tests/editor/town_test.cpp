// Houses that a designer changes: judged by what the plugin says of them, and by the roofs of the whole town.
#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
using espalier::scene::House;

namespace {

// The fingerprint of the whole town, grown as if it had just been loaded.
uint64_t roofs(Editing& editing) {
    EspContext* context = editing.context.get();
    EspGrammar grammar{};
    REQUIRE(espTownGrammar(context, &grammar) == ESP_OK);
    REQUIRE(espSetTownGrammar(context, grammar) == ESP_OK);
    REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    EspRoofStats stats;
    REQUIRE(espReadRoofStats(context, &stats) == ESP_OK);
    return stats.hash;
}

House houseOf(const Editing& editing, uint32_t index) {
    return espalier::scene::houseNow(editing.context.get(), index);
}

}  // namespace

TEST_CASE("a house is changed, undone to what its town says, done again and saved") {
    Editing editing(content("town.json"));
    const uint64_t planned = roofs(editing);
    const House before = houseOf(editing, 0);
    REQUIRE(before.corners.size() == 6);

    House wanted = before;
    wanted.shape = "gable";
    wanted.slope = .8f;
    wanted.eaveHeight = 4;
    wanted.edges = {{1, "eave", .6f}, {3, "gable", 0}};
    REQUIRE_MESSAGE(editing.perform(SetHouse{wanted}), editing.error);
    // A drag of a corner: many actions, one step.
    for (int i = 1; i <= 5; ++i) {
        wanted.corners[1][0] = before.corners[1][0] + .3f * float(i);
        REQUIRE_MESSAGE(editing.perform(SetHouse{wanted}, 7), editing.error);
    }
    CHECK(editing.document->undoSteps() == 2);
    House now = houseOf(editing, 0);
    CHECK(now.eaveHeight == doctest::Approx(4));
    CHECK(now.corners[1][0] == doctest::Approx(wanted.corners[1][0]));
    now.eaveHeight = wanted.eaveHeight;
    now.corners = wanted.corners;
    CHECK(now == wanted);
    const uint64_t changed = roofs(editing);
    CHECK(changed != planned);

    // An outline that crosses itself is refused, and the house stands.
    House crossed = wanted;
    std::swap(crossed.corners[0], crossed.corners[1]);
    CHECK(!editing.perform(SetHouse{crossed}));
    CHECK(!editing.error.empty());
    CHECK(roofs(editing) == changed);
    CHECK(!editing.perform(SetHouse{{1000}}));

    REQUIRE(editing.perform(Undo{}));
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == planned);
    CHECK(houseOf(editing, 0) == before);
    REQUIRE(editing.perform(Redo{}));
    REQUIRE(editing.perform(Redo{}));
    CHECK(roofs(editing) == changed);
    REQUIRE(editing.perform(ResetHouse{0}));
    CHECK(roofs(editing) == planned);
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == changed);

    const Folder folder;
    std::string error;
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), error), error);
    Editing opened(folder.file("project"));
    CHECK(roofs(opened) == changed);
    REQUIRE(opened.perform(ResetHouse{0}));
    CHECK(roofs(opened) == planned);
}
