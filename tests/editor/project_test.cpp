// Projects and autosaves: which is offered, what is refused, and that nothing is saved that couldn't be opened.

#include <chrono>
#include <filesystem>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"
#include "tools/document/run.hpp"
#include "tools/scene/scene_file.hpp"

using namespace espalier::document;
using espalier::scene::Scene;

namespace {

// Works in the folder where it did before, in the end.
struct Elsewhere {
    const std::filesystem::path before = std::filesystem::current_path();
    void leave() const { std::filesystem::current_path(before); }
    ~Elsewhere() { leave(); }
};

}  // namespace

TEST_CASE("an autosave is known by the project that it follows, of whatever time the copies of both are") {
    namespace fs = std::filesystem;
    const Folder folder;
    const std::string garden = folder.file("garden"), kept = garden + "/autosave.json";
    const auto age = [&](int project, int autosave) {
        const auto now = fs::file_time_type::clock::now();
        fs::last_write_time(garden + "/project.json", now + std::chrono::seconds(project));
        fs::last_write_time(kept, now + std::chrono::seconds(autosave));
    };
    Editing editing(smallScene(folder));
    REQUIRE_MESSAGE(saveProject(*editing.document, garden, editing.error), editing.error);
    REQUIRE(editing.perform(FillLayer{"mask", .25f}));
    REQUIRE_MESSAGE(autosave(*editing.document, garden, editing.error), editing.error);
    age(9, 1);
    CHECK(recoverable(garden) == kept);
    age(1, 9);
    CHECK(recoverable(garden) == kept);
    // Another project has come since.
    const std::string text = readAll(garden + "/project.json");
    folder.write("garden/project.json", text + "\n");
    age(1, 9);
    CHECK(recoverable(garden) == "");
    // An older program's says nothing of it.
    std::string old = readAll(kept);
    const size_t from = old.find("\"follows\"");
    REQUIRE(from != std::string::npos);
    folder.write("garden/autosave.json", old.erase(from, old.find('\n', from) + 1 - from));
    age(1, 9);
    CHECK(recoverable(garden) == kept);
    age(9, 1);
    CHECK(recoverable(garden) == "");
}

TEST_CASE("what was opened by a relative path is saved and recorded after the folder that it was named in has gone") {
    namespace fs = std::filesystem;
    const Folder folder;
    const Elsewhere back;
    const fs::path gone = folder.path / "gone/deep";
    (void)sceneOfItsOwn(folder);
    fs::create_directories(gone);
    fs::current_path(gone);
    Editing editing("../../own.json");
    fs::remove_all(gone);
    CHECK(saveProject(*editing.document, folder.file("garden"), editing.error));
    CHECK_MESSAGE(editing.error == "", editing.error);
    CHECK(!saveProject(*editing.document, "here", editing.error));
    CHECK_MESSAGE(contains(editing.error, "here"), editing.error);
    Recorder recorder;
    CHECK(recorder.begin(folder.file("run.jsonl"), {1, "own.json", 96, 54, .1f}, editing.error));
    CHECK(recorder.end(editing.error));
    CHECK(!recorder.begin("run.jsonl", {1, folder.file("own.json"), 96, 54, .1f}, editing.error));
    CHECK_MESSAGE(contains(editing.error, "run.jsonl"), editing.error);
    back.leave();
    CHECK(Editing(folder.file("garden")).document->scene().grammars[0].file == folder.file("own.grammar"));
}

TEST_CASE("what couldn't be opened again is never saved over what can") {
    const Folder folder;
    const std::string garden = folder.file("garden");
    Editing editing(smallScene(folder));
    REQUIRE_MESSAGE(saveProject(*editing.document, garden, editing.error), editing.error);
    const std::string before = readAll(garden + "/project.json");
    ProjectData data;
    REQUIRE(gather(*editing.document, data, editing.error));
    data.file.exposure = 25;
    Progress progress;
    CHECK(!writeProject(data, garden, progress, editing.error));
    CHECK_MESSAGE(contains(editing.error, "'exposure'"), editing.error);
    CHECK(readAll(garden + "/project.json") == before);
    CHECK(Editing(garden).hash() == editing.hash());
}

TEST_CASE("a bare model of another unit is shown at a living size, and so is the project that it is saved as") {
    const Folder folder;
    folder.write("huge.obj", "v -20000 0 0\nv 20000 0 0\nv 20000 25000 0\nv -20000 25000 0\nf 1 2 3 4\n");
    const std::string surface = folder.file("huge.surface.glb");
    const Ran baked =
        run(program("espalier-bake") + " -q --resolution 64 -o " + surface + " " + folder.file("huge.obj"));
    REQUIRE_MESSAGE(baked.code == 0, baked.output);
    Editing editing(surface);
    const float scale = editing.document->scene().surfaces[0].placing.scale;
    CHECK(scale < 1e-4f);
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("garden"), editing.error), editing.error);
    CHECK(Editing(folder.file("garden")).document->scene().surfaces[0].placing.scale == scale);
}

TEST_CASE("a project of a newer program is refused by name, a mangled one with its place") {
    const Folder folder;
    folder.write("mangled.json", "{\"project\": 1,\n \"surfaces\": {}}");
    folder.write("newer.json", "{\"project\": " + std::to_string(espalier::scene::SceneFile::kProjectVersion + 1) +
                                   ",\n \"unheard\": 1}");
    const std::string capture = program("espalier-capture") + " -o " + folder.file("out") + " ";
    const Ran newer = run(capture + folder.file("newer.json"));
    CHECK(newer.code > 0);
    CHECK(contains(newer.output, "newer.json:1:"));
    CHECK(contains(newer.output, "newer Espalier"));
    CHECK(!contains(newer.output, "unheard"));
    folder.write("elsewhere.json",
                 "{\"surfaces\": [], \"grammars\": [],\n \"layers\": {\n \"../../mask\": \"mask.exr\"}}");
    const Ran elsewhere = run(capture + folder.file("elsewhere.json"));
    CHECK(elsewhere.code > 0);
    CHECK(contains(elsewhere.output, "elsewhere.json:3:"));
    CHECK(contains(elsewhere.output, "no layer's name"));
    const Ran mangled = run(capture + folder.file("mangled.json"));
    CHECK(mangled.code > 0);
    CHECK(contains(mangled.output, "mangled.json:2:"));
}

TEST_CASE("an autosave is offered until the project is saved") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string garden = folder.file("garden");
    CHECK(recoverable(garden).empty());
    REQUIRE(saveProject(*editing.document, garden, editing.error));
    REQUIRE(editing.perform(SetParam{0, {"reach", {.5f}}}));
    REQUIRE(autosave(*editing.document, garden, editing.error));
    REQUIRE(!recoverable(garden).empty());
    Editing old(garden), recovered(recoverable(garden));
    CHECK(old.param(0, "reach") == 1);
    CHECK(recovered.param(0, "reach") == .5f);
    REQUIRE(saveProject(*editing.document, garden, editing.error));
    CHECK(recoverable(garden).empty());
}
