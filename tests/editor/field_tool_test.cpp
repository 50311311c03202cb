// Fields in an editor's hands: elements, a comb, a smoothing brush, files of other programs.
#include <map>
#include <random>

#include "sample_game/field_tool.hpp"
#include "tests/editor/widgets.hpp"
#include "tools/document/run.hpp"

using namespace espalier::document;
using espalier::scene::SceneField;
using sample::Tool;

namespace field_tool {
namespace {

constexpr uint32_t kCells = 24;

// A wall of many triangles, 2 m wide and high, on which arrows lie along a field.
std::string patternScene(const Folder& folder) {
    std::string model;
    for (uint32_t y = 0; y <= kCells; ++y)
        for (uint32_t x = 0; x <= kCells; ++x)
            model += "v " + std::to_string(2. * x / kCells - 1) + " " + std::to_string(2. * y / kCells) + " 0\n";
    for (uint32_t y = 0; y < kCells; ++y)
        for (uint32_t x = 0; x < kCells; ++x) {
            const uint32_t a = y * (kCells + 1) + x + 1, b = a + kCells + 1;
            for (const uint32_t corner : {a, a + 1, b + 1, b})
                model += (corner == a ? "f " : " ") + std::to_string(corner);
            model += "\n";
        }
    folder.write("plate.obj", model);
    const Ran baked = run(program("espalier-bake") + " -q --resolution 128 -o " + folder.file("plate.surface.glb") +
                          " " + folder.file("plate.obj"));
    REQUIRE_MESSAGE(baked.code == 0, baked.output);
    folder.write("rows.grammar",
                 "field flow : vector \"Direction\"\n"
                 "Start -> A\n"
                 "A -> [S(0.06) IC(\"scale\")] [T(0.1, 0, 0) A] [T(0, 0.1, 0) A] [T(0, -0.1, 0) A]\n");
    return folder.write("plate.json",
                        R"({"surfaces": [{"file": "plate.surface.glb"}], "grammars": [{"file": "rows.grammar",
      "seeds": [{"position": [0, 1, 0], "direction": [1, 0, 0], "seed": 1}]}],
      "camera": {"eye": [0, 1, 4], "target": [0, 1, 0], "fov": 40}})");
}

uint64_t patternOf(EspContext* context) {
    REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    EspPatternStats stats;
    REQUIRE(espPatternStats(context, &stats) == ESP_OK);
    REQUIRE(stats.pieces > 20);
    return stats.hash;
}

struct Comber : Editor {
    explicit Comber(const Folder& folder) : Editor(folder, patternScene(folder), Tool::fields) {
        work.field.radius = .3f;
    }
    uint64_t pattern() { return patternOf(work.context.get()); }
    glm::vec2 on(float x, float y) const { return at({x, y, 0}); }
    const std::vector<SceneField>& fields() const { return work.scene().surfaces[0].fields; }
    std::string lines() const {
        std::string all;
        for (const SceneField& field : fields()) {
            all += toJson({0, 0, SetField{0, field}});
            for (const auto& stroke : field.strokes) all += toJson({0, 0, BrushField{0, field.name, stroke}});
        }
        return all;
    }
};

std::string plyOf(const std::string& rows, int count) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
    for (const char* name : {"x", "y", "z", "vx", "vy", "vz"}) text += std::string("property float ") + name + "\n";
    return text + "end_header\n" + rows;
}

}  // namespace

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

TEST_CASE("strokes are in the project, and a replayed run lays the same") {
    const Folder folder;
    const std::string path = folder.file("run.jsonl");
    uint64_t combed = 0;
    {
        Comber comber(folder);
        Recorder recorder;
        std::string error;
        REQUIRE(recorder.begin(path, {1, folder.file("plate.json"), 64, 36, .1f}, error));
        comber.work.document->listen([&](const Action& action, uint32_t gesture) { recorder.note(action, gesture); });
        comber.work.field.kind = sample::kComb;
        comber.drag(comber.on(-.4f, .6f), comber.on(.4f, 1.4f));
        comber.work.field.kind = sample::kSmooth;
        comber.drag(comber.on(0, .6f), comber.on(0, 1.4f));
        comber.undo();
        comber.work.field.kind = sample::kComb;
        comber.drag(comber.on(.5f, 1.5f), comber.on(.4f, .5f));
        comber.work.field.kind = "wedge";
        CHECK_MESSAGE(recorder.end(error), error);
        combed = comber.pattern();
        REQUIRE(comber.save(folder.file("saved")));
    }
    Editing opened(folder.file("saved"));
    REQUIRE(opened.document->scene().surfaces[0].fields.size() == 1);
    CHECK(opened.document->scene().surfaces[0].fields[0].strokes.size() == 2);
    CHECK(patternOf(opened.context.get()) == combed);
    Run run;
    std::string error;
    REQUIRE_MESSAGE(readRun(path, run, error), error);
    Editing replayed(run.head.scene);
    for (const RunLine& line : run.lines) REQUIRE_MESSAGE(replayed.perform(line.action, line.gesture), replayed.error);
    CHECK(patternOf(replayed.context.get()) == combed);
}

TEST_CASE("a thousand edits of fields are undone and done again, bit for bit") {
    constexpr int kEdits = 1000, kLooks = 200;
    const Folder folder;
    Editing editing(patternScene(folder));
    std::mt19937 random(7);
    const auto chance = [&](float low, float high) { return std::uniform_real_distribution<float>(low, high)(random); };
    const auto place = [&] { return std::array<float, 3>{chance(-1, 1), chance(0, 2), 0}; };
    const auto said = [&] {
        std::string all;
        for (const SceneField& field : editing.document->scene().surfaces[0].fields) {
            all += toJson({0, 0, SetField{0, field}});
            for (const auto& stroke : field.strokes) all += toJson({0, 0, BrushField{0, field.name, stroke}});
        }
        return all;
    };
    const auto fieldNow = [&] {
        const auto& fields = editing.document->scene().surfaces[0].fields;
        return fields.empty() ? SceneField{.name = "flow", .elements = {}} : fields[0];
    };
    const auto edit = [&]() -> Action {
        SetField set{0, fieldNow()};
        const size_t strokes = set.field.strokes.size();
        switch (random() % 6) {
            case 0:
                set.field.elements.push_back({"node", place(), {1, 0, 0}, chance(.1f, .4f)});
                if (set.field.elements.size() > 4) set.field.elements.clear();
                return set;
            case 1:
                set.field.lean = chance(0, 2);
                return set;
            case 2:
                if (strokes == 0) return set;
                return TrimField{0, "flow", uint32_t(random() % strokes), 0, random() % 4 > 0};
            default:
                return BrushField{0, "flow", {random() % 3 ? "comb" : "smooth", .3f, chance(0, 1), {place(), place()}}};
        }
    };
    std::vector<std::string> states{said()};
    std::map<size_t, uint64_t> patterns{{0, patternOf(editing.context.get())}};
    while (states.size() <= kEdits) {
        REQUIRE_MESSAGE(editing.perform(edit()), editing.error);
        states.push_back(said());
        if ((states.size() - 1) % kLooks == 0) patterns[states.size() - 1] = patternOf(editing.context.get());
    }
    REQUIRE(editing.document->undoSteps() == kEdits);
    const auto check = [&](size_t at) {
        REQUIRE(said() == states[at]);
        if (const auto seen = patterns.find(at); seen != patterns.end())
            CHECK(patternOf(editing.context.get()) == seen->second);
    };
    for (size_t at = kEdits; at-- > 0;) {
        REQUIRE_MESSAGE(editing.perform(Undo{}), editing.error);
        check(at);
    }
    for (size_t at = 1; at <= kEdits; ++at) {
        REQUIRE_MESSAGE(editing.perform(Redo{}), editing.error);
        check(at);
    }
}

TEST_CASE("a field's file turns the pattern, is undone, saved, and missed with a message") {
    const Folder folder;
    const std::string rows = "-1 0 0 .6 .8 0\n1 0 0 .6 .8 0\n1 2 0 .6 .8 0\n-1 2 0 .6 .8 0\n";
    const std::string file = folder.write("wind.ply", plyOf(rows, 4));
    uint64_t turned = 0;
    {
        Comber comber(folder);
        const uint64_t before = comber.pattern();
        SetField load;
        load.field.name = "flow";
        load.field.file = file;
        REQUIRE_MESSAGE(comber.work.perform(load), comber.work.error);
        CHECK(std::string(comber.work.document->undoName()) == "Load wind.ply");
        turned = comber.pattern();
        CHECK(turned != before);
        // What is said of the field beside stays when the file is there already.
        comber.work.field.kind = sample::kComb;
        comber.drag(comber.on(-.4f, .6f), comber.on(.4f, 1.4f));
        comber.undo();
        CHECK(comber.pattern() == turned);
        comber.undo();
        CHECK(comber.fields().empty());
        CHECK(comber.pattern() == before);
        comber.key(GLFW_KEY_Y, GLFW_MOD_CONTROL);
        CHECK(comber.pattern() == turned);
        load.field.file = folder.write("cut.ply", plyOf(rows, 5));
        CHECK_FALSE(comber.work.perform(load));
        CHECK(contains(comber.work.error, "cut.ply:11: the file ends before the 5 elements"));
        CHECK(comber.pattern() == turned);
        REQUIRE(comber.save(folder.file("saved")));
    }
    {
        Editing opened(folder.file("saved"));
        CHECK(patternOf(opened.context.get()) == turned);
    }
    const std::string scene = readAll(folder.file("plate.json"));
    const std::string name = R"("file": "plate.surface.glb")";
    std::string lost = scene;
    lost.replace(lost.find(name), name.size(), name + R"(, "fields": {"flow": {"file": "lost.ply"}})");
    const Ran ran = run(program("espalier-capture") + " " + folder.write("lost.json", lost) + " --size 64x36 -o " +
                        folder.file("out"));
    CHECK(ran.code != 0);
    CHECK(contains(ran.output, "lost.ply: can't be read: No such file"));
    std::filesystem::remove(file);
    Editing without(folder.file("saved"));
    const auto& notes = without.document->scene().notes;
    REQUIRE(notes.size() == 1);
    CHECK(contains(notes[0], "wind.ply: "));
    CHECK(contains(notes[0], "; the field 'flow' is without it"));
    CHECK(contains(without.document->scene().surfaces[0].fields[0].file, "wind.ply"));
    CHECK(patternOf(without.context.get()) != turned);
}

TEST_CASE("a run and the field's file that it loads may be moved together") {
    const Folder folder;
    const std::filesystem::path from = folder.path / "from", to = folder.path / "to";
    std::filesystem::create_directories(from);
    const std::string rows = "-1 0 0 .6 .8 0\n1 0 0 .6 .8 0\n1 2 0 .6 .8 0\n-1 2 0 .6 .8 0\n";
    uint64_t turned = 0;
    {
        Editing editing(patternScene(folder));
        for (const char* name : {"plate.json", "plate.surface.glb", "rows.grammar"})
            std::filesystem::copy_file(folder.file(name), from / name);
        Recorder recorder;
        std::string error;
        REQUIRE(recorder.begin((from / "run.jsonl").string(), {1, (from / "plate.json").string(), 64, 36, .1f}, error));
        editing.document->listen([&](const Action& action, uint32_t gesture) { recorder.note(action, gesture); });
        SetField load;
        load.field.name = "flow";
        REQUIRE(editing.perform(load));  // which names no file
        load.field.file = folder.write("from/wind.ply", plyOf(rows, 4));
        REQUIRE(editing.perform(load));
        REQUIRE(recorder.end(error));
        turned = patternOf(editing.context.get());
    }
    std::filesystem::rename(from, to);
    Run run;
    std::string error;
    REQUIRE_MESSAGE(readRun((to / "run.jsonl").string(), run, error), error);
    Editing replayed(run.head.scene);
    for (const RunLine& line : run.lines) REQUIRE_MESSAGE(replayed.perform(line.action, line.gesture), replayed.error);
    CHECK(patternOf(replayed.context.get()) == turned);
    CHECK(replayed.document->scene().surfaces[0].fields[0].file == (to / "wind.ply").string());
}

TEST_CASE("passes are kept while nothing is summed") {
    const Folder folder;
    Comber comber(folder);
    SetField set;
    set.field.name = "flow";
    set.field.passes = 20;
    RunLine back;
    REQUIRE_MESSAGE(fromJson(toJson({0, 0, set}), back, comber.work.error), comber.work.error);
    CHECK(std::get<SetField>(back.action).field.passes == 20);
    REQUIRE(comber.work.perform(set));
    REQUIRE(comber.save(folder.file("saved")));
    CHECK(Editing(folder.file("saved")).document->scene().surfaces[0].fields[0] == comber.fields()[0]);
}

TEST_CASE("the history counts a field's file once, when the scene has another") {
    const Folder folder;
    Editing editing(patternScene(folder));
    std::string rows;
    for (int i = 0; i < 4000; ++i) rows += std::to_string(i / 2000. - 1) + " 1 0 .6 .8 0\n";
    SetField load;
    load.field.name = "flow";
    load.field.file = folder.write("wind.ply", plyOf(rows, 4000));
    REQUIRE(editing.perform(load));
    constexpr size_t kFile = 4000 * (3 * sizeof(double) + 3 * sizeof(float));
    for (int i = 0; i < 5; ++i) {
        load.field.lean = .1f * float(i);
        REQUIRE(editing.perform(load));
    }
    const size_t before = editing.document->historyBytes();
    CHECK(before < kFile);
    load.field.file.clear();
    REQUIRE(editing.perform(load));
    CHECK(editing.document->historyBytes() > before + kFile);
    CHECK(editing.document->historyBytes() < before + kFile + kFile / 2);
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.document->historyBytes() < kFile);
}

TEST_CASE("a project refuses a field's file that it can't name") {
    const Folder folder;
    Comber comber(folder);
    SetField load;
    load.field.name = "flow";
    load.field.file = folder.write("w\xfcnd.ply", plyOf("0 1 0 .6 .8 0\n", 1));
    REQUIRE_MESSAGE(comber.work.perform(load), comber.work.error);
    CHECK_FALSE(comber.save(folder.file("saved")));
    CHECK_MESSAGE(contains(comber.work.error, "nd.ply: its name isn't UTF-8"), comber.work.error);
}

TEST_CASE("what can't be done to a field is told, and leaves it as it is") {
    const Folder folder;
    Editing editing(patternScene(folder));
    const auto refused = [&](const Action& action, const char* why) {
        CHECK_FALSE(editing.perform(action));
        CHECK(contains(editing.error, why));
        CHECK(editing.document->scene().surfaces[0].fields.empty());
    };
    const espalier::scene::SceneStroke good{"comb", .1f, .5f, {{0, 1, 0}, {0, 1.1f, 0}}};
    refused(BrushField{7, "flow", good}, "no surface 7");
    refused(BrushField{0, "flow", {"rake", .1f, .5f, {}}}, "no brush 'rake'");
    refused(BrushField{0, "flow", {"comb", -1, .5f, {}}}, "radius");
    refused(BrushField{0, "flow", {"comb", 1, 2, {}}}, "strength");
    refused(BrushField{0, "flow", {"comb", 1, 1, {{0, 0, INFINITY}}}}, "isn't finite");
    refused(BrushField{0, "flow", good, true}, "no stroke of this brush");
    refused(TrimField{0, "flow", 1, 0}, "fewer strokes");
    REQUIRE(editing.perform(BrushField{0, "flow", good}));
    CHECK_FALSE(editing.perform(BrushField{0, "flow", {"smooth", .1f, .5f, {{0, 1, 0}}}, true}));
    CHECK_FALSE(editing.perform(TrimField{0, "flow", 1, 3}));
    REQUIRE(editing.perform(TrimField{0, "flow", 1, 1, false}));
    CHECK(editing.document->scene().surfaces[0].fields.empty());
    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.document->scene().surfaces[0].fields[0].strokes[0] == good);
}

}  // namespace field_tool
