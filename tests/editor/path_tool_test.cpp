// One drag, one plant: ivy along a line that is drawn over the wall of the small scene.
#include "tests/editor/gardener.hpp"

namespace path_tool {
namespace {

struct Trainer : Gardener {
    explicit Trainer(const Folder& folder) : Gardener(folder) { work.choose(Tool::path); }
    EspPlantInfo plant(uint32_t key) {
        REQUIRE(espUpdate(work.context.get()) == ESP_OK);
        EspPlantInfo info;
        REQUIRE(espPlantInfo(work.context.get(), work.document->seed(key)->planted, &info) == ESP_OK);
        return info;
    }
    void drawLine(std::initializer_list<glm::vec2> corners) {
        const glm::vec2* corner = corners.begin();
        press(*corner);
        while (++corner != corners.end()) moveTo(*corner, 12);
        release(mouse);
    }
};

}  // namespace

TEST_CASE("ivy follows a line that runs sideways and down to its end, and is one step of undo") {
    const Folder folder;
    Trainer trainer(folder);
    const size_t grammars = trainer.work.scene().grammars.size();
    const std::vector<SeedRecord> before = trainer.seeds();
    const uint64_t state = trainer.work.document->state();
    const glm::vec2 from = trainer.onWall(-1.25f, 1.3f), corner = trainer.onWall(-.7f, 1.3f),
                    to = trainer.onWall(-.7f, .95f);
    trainer.drawLine({from, corner, to});
    CHECK_MESSAGE(trainer.work.error.empty(), trainer.work.error);
    REQUIRE(trainer.seeds().size() == before.size() + 1);
    const SeedRecord seed = trainer.seeds().back();
    CHECK(seed.position == array(trainer.under(from)));
    CHECK(seed.direction[0] > .9f);
    CHECK(trainer.work.scene().grammars.size() == grammars + 1);  // the scene had none that follows lines
    CHECK(trainer.steps() == 1);
    CHECK(std::string(trainer.work.document->undoName()) == "Ivy along a line");

    // Its ground is the line's: it gets to both ends of it, and not far beyond.
    const EspPlantInfo plant = trainer.plant(seed.key);
    CHECK(plant.nodes > 30);
    CHECK(plant.boundsMin[1] < trainer.under(to).y + .12f);
    CHECK(plant.boundsMax[0] > trainer.under(corner).x - .12f);
    CHECK(plant.boundsMin[1] > trainer.under(to).y - .75f);  // twigs are up to half a metre long
    CHECK(plant.boundsMax[1] < trainer.under(from).y + .75f);

    trainer.undo();
    CHECK(trainer.seeds() == before);
    CHECK(trainer.work.scene().grammars.size() == grammars);
    CHECK(trainer.work.document->state() == state);
    trainer.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
    CHECK(trainer.seeds().back() == seed);
    CHECK(trainer.plant(seed.key).nodes == plant.nodes);
}

TEST_CASE("the same line leads the same plant in its project, and by shaders as by native code") {
    const Folder folder;
    Trainer trainer(folder);
    trainer.drawLine({trainer.onWall(-1.25f, .9f), trainer.onWall(-.8f, 1.35f)});
    REQUIRE(trainer.save(folder.file("saved")));
    REQUIRE(espUpdate(trainer.work.context.get()) == ESP_OK);
    EspStats stats;
    REQUIRE(espReadStats(trainer.work.context.get(), &stats) == ESP_OK);
    const std::string capture = program("espalier-capture") + " " + folder.file("saved") + " --size 64x36 -o " +
                                folder.file("out") + " --stats ";
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(stats.hash));
    for (const char* option : {"", " --shaders"}) {
        const Ran ran = run(capture + folder.file("stats.json") + " --max-nodes 20000" + option);
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        CHECK(contains(readAll(folder.path / "stats.json"), hash));
    }
}

TEST_CASE("Esc forgets a line that is being drawn, a click draws none, and beside all ground there is none") {
    const Folder folder;
    Trainer trainer(folder);
    const std::vector<SeedRecord> before = trainer.seeds();
    trainer.press(trainer.onWall(-1.2f, 1));
    trainer.moveTo(trainer.onWall(-.8f, 1), 6);
    CHECK(trainer.controls.painting() == false);
    trainer.key(GLFW_KEY_ESCAPE);
    trainer.release(trainer.mouse);
    CHECK(trainer.work.tool == Tool::path);
    trainer.click(trainer.onWall(-1.2f, 1));
    CHECK(contains(trainer.work.message, "Drag"));
    faceWall(trainer, 8);
    trainer.click(trainer.at({-.95f, 3.8f, .3f}));
    CHECK(trainer.work.message == sample::kNoGround);
    CHECK(trainer.seeds() == before);
    CHECK(trainer.steps() == 0);
}

TEST_CASE("lines are recorded as what they are made of: strokes and a seed, of one gesture") {
    const Folder folder;
    Trainer trainer(folder);
    trainer.drawLine({trainer.onWall(-1.2f, 1), trainer.onWall(-.8f, 1.3f)});
    const auto strokes = trainer.all<StrokeBegin>();
    REQUIRE(strokes.size() >= 1);
    for (const StrokeBegin& stroke : strokes) {
        CHECK(stroke.layer == "way");
        REQUIRE(stroke.colour.size() == 3);
        for (float part : stroke.colour) CHECK((part >= 0 && part <= 1));
    }
    CHECK(trainer.all<StrokeEnd>().size() == strokes.size());
    CHECK(trainer.all<AddSeeds>().size() == 1);
    CHECK(trainer.all<AddGrammar>().size() == 1);
    // A second one takes the grammar that is there.
    trainer.drawLine({trainer.onWall(-.75f, 1), trainer.onWall(-1.1f, .9f)});
    CHECK(trainer.all<AddGrammar>().size() == 1);
    CHECK(trainer.all<AddSeeds>().size() == 2);
}

TEST_CASE("a line's points are dragged, added and taken away, each as one step, and its plant follows") {
    const Folder folder;
    Trainer trainer(folder);
    const glm::vec2 from = trainer.onWall(-1.25f, 1.3f), corner = trainer.onWall(-.7f, 1.3f),
                    to = trainer.onWall(-.7f, .95f), aside = trainer.onWall(-1.2f, .95f);
    trainer.drawLine({from, corner, to});
    const SeedRecord drawn = trainer.seeds().back();
    REQUIRE(drawn.line.size() == 3);
    CHECK(trainer.plant(drawn.key).boundsMax[0] > trainer.under(corner).x - .12f);

    // Its end goes over to the other side, and with its middle no plant stays where the line was.
    trainer.drawLine({to, aside});
    CHECK_MESSAGE(trainer.work.error.empty(), trainer.work.error);
    CHECK(trainer.steps() == 2);
    CHECK(std::string(trainer.work.document->undoName()) == "Edit a line");
    trainer.drawLine({corner, trainer.onWall(-1.2f, 1.1f)});
    CHECK(trainer.steps() == 3);
    const SeedRecord moved = trainer.seeds().back();
    CHECK(moved.key == drawn.key);
    CHECK(moved.position == drawn.position);
    REQUIRE(moved.line.size() == 3);
    CHECK(moved.params != drawn.params);  // as long as the line is
    const EspPlantInfo plant = trainer.plant(moved.key);
    CHECK(plant.nodes > 10);
    CHECK(plant.boundsMax[0] < trainer.under(corner).x + .1f);
    CHECK(plant.boundsMin[1] < trainer.under(aside).y + .15f);

    // A drag of the line between two points makes one more; Del takes it away.
    const glm::vec2 between = (trainer.onWall(-1.2f, 1.1f) + aside) * .5f;
    trainer.drawLine({between, between + glm::vec2(25, 0)});
    CHECK(trainer.seeds().back().line.size() == 4);
    trainer.key(GLFW_KEY_DELETE);
    CHECK(trainer.seeds().back().line.size() == 3);
    CHECK(trainer.steps() == 5);
    for (int i = 0; i < 4; ++i) trainer.undo();
    CHECK(trainer.seeds().back() == drawn);
    CHECK(trainer.steps() == 1);
    // Without a chosen point the line goes, with its plant and its paint.
    trainer.work.selected = {drawn.key};
    trainer.key(GLFW_KEY_DELETE);
    CHECK(trainer.seeds().size() == 2);
    trainer.undo();
    CHECK(trainer.seeds().back() == drawn);
}

TEST_CASE("a click chooses a line, Esc lets go of a point, Shift draws anew, and a project keeps the points") {
    const Folder folder;
    Trainer trainer(folder);
    const glm::vec2 from = trainer.onWall(-1.25f, 1.2f), to = trainer.onWall(-.75f, 1.2f);
    trainer.drawLine({from, to});
    const SeedRecord drawn = trainer.seeds().back();
    trainer.work.selected.clear();
    trainer.click((from + to) * .5f);
    CHECK(trainer.work.selected == std::set<uint32_t>{drawn.key});
    trainer.click(to);  // a click on a point only chooses it
    trainer.press(to);
    trainer.moveTo(to + glm::vec2(0, 40), 6);
    trainer.key(GLFW_KEY_ESCAPE);
    trainer.release(trainer.mouse);
    CHECK(trainer.seeds().back() == drawn);
    CHECK(trainer.steps() == 1);
    REQUIRE(trainer.save(folder.file("saved")));
    Editing again(folder.file("saved"));
    CHECK(again.document->scene().seeds.back().line == drawn.line);
}

}  // namespace path_tool
