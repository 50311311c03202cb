// Fields in projects, runs and the history, and those that other programs have computed.
#include "tests/editor/field_tool.hpp"

namespace field_tool {

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
