// The editor in a real window, driven by mouse and keys; judged by the run that it records, which is then replayed.
#include <algorithm>
#include <utility>

#include "tests/editor/editing.hpp"
#include "tools/document/run.hpp"

using namespace espalier::document;

namespace {

bool hasDisplay() {
    const bool has = run("command -v xvfb-run && command -v xdotool").code == 0;
    if (!has) MESSAGE("xvfb-run or xdotool isn't installed; skipped");
    return has;
}

Ran drive(const std::string& script, const std::string& scene, const Folder& folder, const std::string& way = "") {
    return runOnDisplay("900x560", "tests/editor/" + script + " " + program("espalier-sample") + " " + scene + " " +
                                       folder.path.string() + " " + way);
}

// What grows in a scene, or at the end of a run, and its last picture.
struct Shown {
    std::string hash, picture;
};
Shown shown(const Folder& folder, const std::string& what) {
    const std::string frames = folder.file("frames"), stats = folder.file("stats.json");
    std::filesystem::remove_all(frames);
    const Ran ran =
        run(program("espalier-capture") + " " + what + " --size 320x180 -o " + frames + " --stats " + stats);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    std::filesystem::path last;
    for (const auto& entry : std::filesystem::directory_iterator(frames)) last = std::max(last, entry.path());
    const std::string told = readAll(stats), key = R"("hash":")";
    REQUIRE(contains(told, key));
    REQUIRE(!last.empty());
    return {told.substr(told.find(key) + key.size(), 16), readAll(last)};
}

// The small scene with a model of its own, and beside it `other` and `first`: that model with another byte, and as it
// was. Both scene and model.
std::pair<std::string, std::string> sceneOfOwnModel(const Folder& folder) {
    std::string scene = readAll(smallScene(folder)), model = readAll(smallSurface());
    const std::string name = smallSurface(), own = folder.write("own.surface.glb", model);
    scene.replace(scene.find(name), name.size(), own);
    folder.write("first", model);
    const std::string generator = R"("generator":")";
    const size_t at = model.find(generator);
    REQUIRE(at != std::string::npos);
    model[at + generator.size()] = 'E';
    folder.write("other", model);
    return {folder.write("own.json", scene), own};
}

}  // namespace

TEST_CASE("a drag of the atlas's level shows another, is nothing to undo, and is taken back by Esc") {
    if (!hasDisplay()) return;
    const Folder folder;
    const Ran ran = drive("drive_atlas", smallScene(folder), folder);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    const auto alike = [&](const char* a, const char* b) {
        return run(program("espalier-compare") + " " + folder.file(a) + " " + folder.file(b)).code == 0;
    };
    CHECK(!alike("espalier-1.png", "espalier-2.png"));
    CHECK(alike("espalier-2.png", "espalier-3.png"));
    Run recorded;
    std::string error;
    REQUIRE_MESSAGE(readRun(folder.file("run.jsonl"), recorded, error), error);
    for (const RunLine& line : recorded.lines) CHECK(std::holds_alternative<SetCamera>(line.action));
}

#ifdef ESPALIER_DROP
TEST_CASE("somebody with a model has ivy on it after a drop, a click and a drag, and no key") {
    if (!hasDisplay()) return;
    const Folder folder;
    std::filesystem::copy_file(content("vase.glb"), folder.path / "vase.glb");
    const Ran ran =
        runOnDisplay("900x560", "tests/editor/drive_drop " + program("espalier-sample") + " " + ESPALIER_DROP + " " +
                                    folder.file("vase.glb") + " " + folder.path.string());
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    CHECK(autosavesIn(folder.path).size() == 1);
    const Ran shown =
        run(program("espalier-capture") + " --replay " + folder.file("run.jsonl") +
            " --every 1000000 --size 64x40 -o " + folder.file("out") + " --stats " + folder.file("s.json"));
    REQUIRE_MESSAGE(shown.code == 0, shown.output);
    const std::string stats = readAll(folder.path / "s.json");
    CHECK(contains(stats, "\"seeds\":1,"));
    CHECK(!contains(stats, "\"leaves\":0,"));
}
#endif

TEST_CASE("a picture that can't be written is told of, and the editor goes on") {
    if (!hasDisplay()) return;
    const Folder folder;
    const Ran ran = drive("drive_faults", smallScene(folder), folder, "picture");
    CHECK_MESSAGE(ran.code == 1, ran.output);
    CHECK_MESSAGE(contains(ran.output, "espalier-1.png"), ran.output);
}

TEST_CASE("a model that changes while there is no place for what is read again is told of, and the editor goes on") {
    if (!hasDisplay()) return;
    const Folder folder;
    const auto [scene, model] = sceneOfOwnModel(folder);
    const Ran ran = drive("drive_faults", scene, folder, "reload " + model);
    CHECK_MESSAGE(ran.code == 1, ran.output);
    CHECK_MESSAGE(contains(ran.output, "Not reloaded: TMPDIR is no folder"), ran.output);
}

TEST_CASE("an editor that can't keep what isn't saved says so at its end, and by its exit code") {
    if (!hasDisplay()) return;
    const Folder folder;
    const Ran ran = drive("drive_end", smallScene(folder), folder, "full");
    CHECK_MESSAGE(ran.code == 1, ran.output);
    CHECK_MESSAGE(contains(ran.output, "couldn't be kept: " + folder.file("taken")), ran.output);
}

TEST_CASE("a run isn't recorded over a file that is there") {
    const Folder folder;
    const std::string there = folder.write("run.jsonl", "mine");
    const Ran ran = run(program("espalier-sample") + " --frames 1 --record " + there);
    CHECK(ran.code == 2);
    CHECK_MESSAGE(contains(ran.output, there), ran.output);
    CHECK(readAll(there) == "mine");
}

TEST_CASE("an editor that is told to end keeps what isn't saved") {
    if (!hasDisplay()) return;
    const Folder folder;
    const Ran ran = drive("drive_end", smallScene(folder), folder, "term");
    CHECK_MESSAGE(ran.code == 0, ran.output);
    CHECK(autosavesIn(folder.path / "config").size() == 1);
}

// Each picture comes after a single change of growth, behind which shadows may lag while there are more to come.
TEST_CASE("a window that rests shows what was undone with its own shadows") {
    if (!hasDisplay()) return;
    const Folder folder;
    const Ran ran = drive("drive_undo", smallScene(folder), folder);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    const Ran alike =
        run(program("espalier-compare") + " " + folder.file("espalier-1.png") + " " + folder.file("espalier-2.png"));
    CHECK_MESSAGE(alike.code == 0, alike.output);
}

TEST_CASE("Esc stops growth that takes long, and the next change grows") {
    if (!hasDisplay()) return;
#ifdef __SANITIZE_ADDRESS__
    MESSAGE("skipped: a sanitizer takes no library that is loaded before it");
    return;
#endif
    const Folder folder;
    std::string seeds;
    for (int i = 0; i < 200; ++i)
        seeds += (i > 0 ? "," : "") + std::string(R"({"position": [)") + std::to_string(-1.6 + 0.015 * i) +
                 R"(, 0.12, 0.36], "seed": )" + std::to_string(i) + "}";
    const std::string dense =
        folder.write("dense.json", R"({"surface": ")" + smallSurface() + R"(", "grammars": [{"file": ")" +
                                       content("grammars/ivy_guided.grammar") +
                                       R"(", "params": {"reach": 20, "twigs": 20, "twigLength": 1.5, "scale": 0.2},
    "seeds": [)" + seeds + R"(]}], "camera": {"eye": [2.3, 1.9, 8.0], "target": [-0.05, 1.55, 0.3], "fov": 38}})");
    const Ran ran = drive("drive_stop", dense, folder, ESPALIER_NOTE_UPDATE);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    CHECK(readAll(folder.file("updates")) == std::to_string(ESP_STOPPED) + "\n" + std::to_string(ESP_OK) + "\n");
}

TEST_CASE("a model that changes on disk waits for an open dialogue, and what is typed there isn't the tools'") {
    if (!hasDisplay()) return;
    const Folder folder;
    const auto [scene, model] = sceneOfOwnModel(folder);
    const Ran ran = drive("drive_reload", scene, folder, model);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    const std::string saved = readAll(folder.file("kept/project.json"));
    size_t seeds = 0;
    for (size_t i = 0; (i = saved.find(R"("position")", i)) != std::string::npos; ++i) ++seeds;
    CHECK(seeds == 2);
}

TEST_CASE("in a window, drags paint, panels and the camera don't, seeds are planted, undone and done again") {
    if (!hasDisplay()) return;
    const Folder folder;
    const Ran ran = drive("drive", smallScene(folder), folder);
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    CHECK_MESSAGE(!contains(ran.output, "alidation"), ran.output);

    Run recorded;
    std::string error;
    REQUIRE_MESSAGE(readRun(folder.file("run.jsonl"), recorded, error), error);
    const auto count = [&](auto which) {
        return std::count_if(recorded.lines.begin(), recorded.lines.end(),
                             [&](const RunLine& line) { return std::holds_alternative<decltype(which)>(line.action); });
    };
    CHECK(count(StrokeBegin{}) == 2);
    CHECK(count(StrokeEnd{}) == 2);
    CHECK(count(StrokeDabs{}) >= 2);
    CHECK(count(AddSeeds{}) == 1);
    CHECK(count(RemoveSeeds{}) == 1);
    CHECK(count(Undo{}) == 2);
    CHECK(count(Redo{}) == 1);
    // Only the last drag is one of a grammar's slider: it ends where the mouse was let go. Then its number is typed
    // twice.
    size_t redone = 0, slid = recorded.lines.size();
    std::vector<std::pair<uint32_t, float>> scales;  // gestures, and what each ends with
    for (size_t i = 0; i < recorded.lines.size(); ++i) {
        if (std::holds_alternative<Redo>(recorded.lines[i].action)) redone = i;
        if (const auto* set = std::get_if<SetParam>(&recorded.lines[i].action)) {
            slid = std::min(slid, i);
            CHECK(set->param.name == "scale");
            if (scales.empty() || scales.back().first != recorded.lines[i].gesture)
                scales.emplace_back(recorded.lines[i].gesture, 0);
            scales.back().second = set->param.value.at(0);
        }
    }
    CHECK(slid > redone);
    // The drag, a click, and each number that was typed: the clicks that led there moved nothing.
    REQUIRE(scales.size() == 4);
    CHECK(scales[1].second < .5f);
    CHECK(scales.front().second == doctest::Approx(3.3).epsilon(0.3));
    CHECK(scales[scales.size() - 2].second == 1.25f);  // after a double click
    CHECK(scales.back().second == 2.5f);               // after Ctrl and a click
    std::vector<std::string> modes;
    for (const RunLine& line : recorded.lines)
        if (const auto* stroke = std::get_if<StrokeBegin>(&line.action)) modes.push_back(stroke->mode);
    CHECK(modes == std::vector<std::string>{"paint", "erase"});

    // A path that was typed as soon as its dialogue was asked for, and Return.
    CHECK(std::filesystem::exists(folder.path / "saved/project.json"));

    // What was done and not saved was kept until it was saved.
    CHECK(autosavesIn(folder.path).empty());

    // Replayed in a window it is the same run.
    Run again;
    REQUIRE_MESSAGE(readRun(folder.file("again.jsonl"), again, error), error);
    const auto actions = [](const Run& run) {
        std::vector<std::string> all;
        for (const RunLine& line : run.lines)
            if (!std::holds_alternative<SetCamera>(line.action)) all.push_back(toJson({0, 0, line.action}));
        return all;
    };
    CHECK(actions(again) == actions(recorded));
    // What came of it is the same wherever it was done: in the window, in the one that replayed it, and without any.
    const std::string grown = shown(folder, folder.file("saved/project.json")).hash;
    CHECK(shown(folder, folder.file("outcome/project.json")).hash == grown);
    for (const char* name : {"run.jsonl", "again.jsonl"}) {
        CAPTURE(name);
        CHECK(shown(folder, "--replay " + folder.file(name) + " --every 100000").hash == grown);
    }
    CHECK(shown(folder, smallScene(folder)).hash != grown);
    for (const char* view : {" --view shaded", " --view layer:mask"}) {
        CAPTURE(view);
        const std::string from = " --camera 2.3,1.9,8,-0.05,1.55,0.3,38" + std::string(view);
        const std::string saved = shown(folder, folder.file("saved/project.json") + from).picture;
        CHECK(shown(folder, folder.file("outcome/project.json") + from).picture == saved);
        CHECK(shown(folder, smallScene(folder) + from).picture != saved);
    }
}
