// Layers as pictures, out and in: what comes back, what is told of it, and what a full disk leaves.
#include <signal.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/editor/editing.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::document;
using espalier::scene::ColourPicture;
using espalier::scene::GreyPicture;

namespace {

constexpr const char* kLayer = "mask";

std::vector<float> layerOf(Editing& editing) {
    GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(0, kLayer, picture, editing.error), editing.error);
    return picture.texels;
}

// Values of all kinds, also such as 16 bits don't hold.
void paint(Editing& editing) {
    REQUIRE(editing.perform(FillLayer{kLayer, 1 / 3.f}));
    for (const float strength : {.9f, .37f, .11f}) {
        StrokeBegin stroke;
        stroke.layer = kLayer;
        stroke.mode = "paint";
        stroke.radius = .8f;
        stroke.value = 1;
        stroke.strength = strength;
        REQUIRE_MESSAGE(editing.perform(stroke), editing.error);
        REQUIRE(editing.perform(StrokeDabs{{{strength, 1, .36f, 0, 0, 1, 1}}}));
        REQUIRE(editing.perform(StrokeEnd{}));
    }
}

bool import(Editing& editing, const std::string& file, std::string& note) {
    editing.error.clear();
    Work work(importing(*editing.document, kLayer, file, 7));
    const bool good = work.finish(editing.error);
    note = work.note();
    return good;
}

float farthest(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    float most = 0;
    for (size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

// No file of this process may become larger, as on a disk that is full.
struct FullDisk {
    rlimit before{};
    FullDisk() {
        signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before);
        const rlimit few{2000, before.rlim_max};
        setrlimit(RLIMIT_FSIZE, &few);
    }
    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &before);
        signal(SIGXFSZ, SIG_DFL);
    }
};

}  // namespace

TEST_CASE("an exported layer comes back to the bit as EXR, within a step of 16 bits as PNG, and is undone") {
    const Folder folder;
    Editing editing(smallScene(folder));
    paint(editing);
    const std::vector<float> painted = layerOf(editing);
    for (const char* name : {"mask.exr", "mask.png"}) {
        const std::string file = folder.file(name);
        REQUIRE_MESSAGE(exportLayer(*editing.document, kLayer, file, editing.error), editing.error);
        REQUIRE(editing.perform(FillLayer{kLayer, 0}));
        const std::vector<float> filled = layerOf(editing);
        std::string note;
        REQUIRE_MESSAGE(import(editing, file, note), editing.error);
        CHECK(note == "");
        const float off = farthest(layerOf(editing), painted);
        CHECK(off <= (std::string(name) == "mask.exr" ? 0.f : .5f / 65535 + 1e-7f));
        REQUIRE(editing.perform(Undo{}));
        CHECK(layerOf(editing) == filled);
        REQUIRE(editing.perform(Undo{}));
        CHECK(layerOf(editing) == painted);
    }
}

TEST_CASE("a picture of another size or kind is taken in, and the user is told what became of it") {
    const Folder folder;
    Editing editing(smallScene(folder));
    std::string note, error;
    // Red is what counts, and what is none of 0 to 1 is limited.
    std::vector<uint8_t> rgba(64 * 32 * 4);
    for (size_t i = 0; i < rgba.size(); i += 4) rgba[i] = 204, rgba[i + 1] = 20;
    REQUIRE(espalier::scene::writePng(folder.file("colour.png"), rgba.data(), 64, 32, error));
    REQUIRE_MESSAGE(import(editing, folder.file("colour.png"), note), editing.error);
    CHECK_MESSAGE(contains(note, "64 x 32, resampled to 512 x 512"), note);
    CHECK_MESSAGE(contains(note, "the red"), note);
    const std::vector<float> red = layerOf(editing);  // 0 where the atlas holds nothing
    CHECK(std::ranges::all_of(red, [](float value) { return value == 0 || std::abs(value - .8f) < 1e-6f; }));
    CHECK(std::ranges::count(red, 0.f) < int64_t(red.size() / 2));

    const GreyPicture odd{2, 2, {0, -3, 7, 1e30f}};
    REQUIRE_MESSAGE(espalier::scene::writeGrey(folder.file("odd.exr"), odd, error), error);
    REQUIRE_MESSAGE(import(editing, folder.file("odd.exr"), note), editing.error);
    CHECK_MESSAGE(contains(note, "3 values limited to 0 to 1"), note);
    for (const float value : layerOf(editing)) REQUIRE((value >= 0 && value <= 1));
}

TEST_CASE("what isn't a whole picture is refused with its name and changes nothing") {
    const Folder folder;
    Editing editing(smallScene(folder));
    paint(editing);
    const std::vector<float> painted = layerOf(editing);
    const size_t steps = editing.document->undoSteps();
    for (const char* name : {"whole.png", "whole.exr"})
        REQUIRE(exportLayer(*editing.document, kLayer, folder.file(name), editing.error));
    const auto refused = [&](const std::string& file, const char* why) {
        std::string note;
        CHECK_FALSE(import(editing, file, note));
        CHECK_MESSAGE(contains(editing.error, file), editing.error);
        CHECK_MESSAGE(contains(editing.error, why), editing.error);
        CHECK_MESSAGE(editing.error.find('\n') == std::string::npos, editing.error);
        CHECK(layerOf(editing) == painted);
        CHECK(editing.document->undoSteps() == steps);
    };
    refused(folder.file("missing.png"), "No such file");
    refused(folder.path.string(), "is a folder");
    refused(folder.write("text.png", "no picture"), "isn't a picture");
    refused(folder.write("text.exr", "no picture"), "isn't a picture");
    using Limits = std::numeric_limits<float>;
    for (const float none : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
        REQUIRE(espalier::scene::writeGrey(folder.file("odd.exr"), {2, 1, {1, none}}, editing.error));
        refused(folder.file("odd.exr"), "no finite number");
    }
    for (const char* name : {"whole.png", "whole.exr"}) {
        const std::string bytes = readAll(folder.file(name));
        refused(folder.write((std::string("half-") + name).c_str(), bytes.substr(0, bytes.size() / 2)), "");
    }
    std::string error;
    for (const char* name : {"mask.jpg", "mask", "mask.tif"}) {
        CHECK_FALSE(exportLayer(*editing.document, kLayer, folder.file(name), error));
        CHECK_MESSAGE(contains(error, ".png or .exr"), error);
        CHECK_FALSE(std::filesystem::exists(folder.path / name));
    }
}

TEST_CASE("on a full disk neither an export nor a save harms what was there") {
    const Folder folder;
    Editing editing(smallScene(folder));
    paint(editing);
    const std::string project = folder.file("project");
    REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
    const std::string before = readAll(project + "/project.json");
    for (const char* name : {"mask.exr", "mask.png"})
        REQUIRE(exportLayer(*editing.document, kLayer, folder.file(name), editing.error));
    const std::string exr = readAll(folder.file("mask.exr")), png = readAll(folder.file("mask.png"));
    const std::vector<float> saved = layerOf(editing);
    const size_t files = folder.count();
    REQUIRE(editing.perform(LoadLayer{kLayer, folder.file("mask.png"), 0}));  // of slightly other values
    {
        const FullDisk full;
        for (const char* name : {"mask.exr", "mask.png"}) {
            editing.error.clear();
            CHECK_FALSE(exportLayer(*editing.document, kLayer, folder.file(name), editing.error));
            CHECK_MESSAGE(contains(editing.error, folder.file(name) + ": can't be written"), editing.error);
        }
        editing.error.clear();
        CHECK_FALSE(saveProject(*editing.document, project, editing.error));
        CHECK_MESSAGE(contains(editing.error, "can't be written"), editing.error);
        CHECK_FALSE(saveProject(*editing.document, folder.file("other/inner"), editing.error));
        CHECK_MESSAGE(!std::filesystem::exists(folder.file("other")), "nor do empty folders stay");
    }
    CHECK_MESSAGE(folder.count() == files, "what was begun takes no room");
    CHECK(readAll(folder.file("mask.exr")) == exr);
    CHECK(readAll(folder.file("mask.png")) == png);
    CHECK(readAll(project + "/project.json") == before);
    Editing again(project);
    CHECK(layerOf(again) == saved);
}

TEST_CASE("where there is no surface no layer is said to be written or read") {
    const Folder folder;
    Editing town(content("town.json"));
    REQUIRE(town.document->scene().surfaces.empty());
    const std::string file = folder.file("mask.png");
    std::string note;
    CHECK(!exportLayer(*town.document, "mask", file, town.error));
    CHECK_MESSAGE(contains(town.error, file + ": there is no surface"), town.error);
    CHECK(!std::filesystem::exists(file));
    CHECK(!import(town, file, note));
    CHECK_MESSAGE(contains(town.error, "there is no surface"), town.error);
}
