// What is left of files that a crash or a full disk has cut short: runs without their last line, projects without a
// layer.
#include <filesystem>

#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"
#include "tools/document/run.hpp"
#include "tools/scene/text_file.hpp"

using namespace espalier::document;
namespace fs = std::filesystem;

TEST_CASE("a run whose last line is cut off is read up to it, and says so; one that is mangled before isn't") {
    const Folder folder;
    const std::string head = R"({"espalier_run":1,"scene":"small.json","width":64,"height":36,"step":0.04})"
                             "\n";
    const std::string fill = toJson(RunLine{1, 0, FillLayer{"mask", .5f}});
    const auto read = [&](const std::string& text) {
        Run run;
        std::string error;
        const bool good = readRun(folder.write("run.jsonl", text), run, error);
        CHECK(good == error.empty());
        return std::tuple(good ? int(run.lines.size()) : -1, run.note, error);
    };
    CHECK(read(head + fill + "\n" + fill + "\n") == std::tuple(2, "", ""));
    CHECK(read(head + fill + "\n" + fill) == std::tuple(2, "", ""));
    for (size_t cut = 1; cut < fill.size(); cut += 7) {
        const auto [lines, note, error] = read(head + fill + "\n" + fill.substr(0, cut));
        CAPTURE(cut);
        CHECK(lines == 1);
        CHECK(note.find("run.jsonl:3: the last line is cut off") != std::string::npos);
    }
    Run spaced;
    std::string error;
    REQUIRE(readRun(folder.write("run.jsonl", head + "\n" + fill + "\n\n\n" + fill + "\n"), spaced, error));
    REQUIRE(spaced.lines.size() == 2);
    CHECK(spaced.lines[0].number == 3);  // by which mistakes are told
    CHECK(spaced.lines[1].number == 6);
    CHECK(std::get<0>(read(head + fill.substr(0, 9) + "\n" + fill + "\n")) == -1);
    CHECK(std::get<0>(read(head + fill + "\n" + fill.substr(0, 9) + "\n")) == -1);  // whole, but no action
    CHECK(std::get<0>(read(head + fill + "\n{\"frame\": 9, \"fly\": {}}")) == -1);  // likewise
    CHECK(std::get<0>(read(head + fill.substr(0, 9))) == -1);                       // nothing would be left
}

TEST_CASE("a project whose layer is gone or damaged opens, tells which, and grows by what the rest says") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const uint64_t bare = editing.hash();
    REQUIRE(editing.perform(FillLayer{"size", .9f}));
    const uint64_t sized = editing.hash();
    REQUIRE(editing.perform(FillLayer{"mask", 0}));
    const std::string saved = folder.file("saved");
    REQUIRE_MESSAGE(saveProject(*editing.document, saved, editing.error), editing.error);
    CHECK(sized != bare);
    std::string mask;
    for (const auto& file : fs::directory_iterator(saved + "/layers"))
        if (file.path().filename().string().starts_with("mask")) mask = file.path().string();
    REQUIRE(!mask.empty());
    std::string project;
    std::string error;
    REQUIRE(espalier::scene::readText(saved + "/project.json", project, error));
    // Without what the whole layer was filled with, so that only the picture says it.
    const size_t filled = project.find("\"mask\": 0");
    REQUIRE(filled != std::string::npos);
    project.replace(filled, 9, "\"mask\": 1");
    folder.write("saved/project.json", project);

    fs::resize_file(mask, fs::file_size(mask) / 2);
    for (const char* cause : {"damaged", "can't be read"}) {
        Editing opened(saved);
        const auto& notes = opened.document->scene().notes;
        REQUIRE(notes.size() == 1);
        CHECK_MESSAGE(contains(notes[0], cause), notes[0]);
        CHECK(contains(notes[0], fs::path(mask).filename().string()));
        CHECK(contains(notes[0], "'mask' isn't painted"));
        CHECK(opened.hash() == sized);
        // The file isn't given up: what is saved still names it.
        if (fs::exists(mask)) {
            REQUIRE_MESSAGE(saveProject(*opened.document, saved, error), error);
            CHECK(fs::exists(mask));
        }
        REQUIRE(espalier::scene::readText(saved + "/project.json", project, error));
        CHECK(contains(project, fs::path(mask).filename().string()));
        fs::remove(mask);
    }
}
