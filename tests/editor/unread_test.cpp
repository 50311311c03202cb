// Pictures of layers that a project's reader couldn't read: they wait until something is painted in their places.
#include <algorithm>
#include <filesystem>

#include "tests/editor/editing.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/document/project.hpp"

using namespace espalier::document;
using espalier::scene::GreyPicture;
namespace fs = std::filesystem;

namespace {

// Two walls of one model, ten metres apart, and a creeper that reads `damp`.
std::string twoWalls(const Folder& folder) {
    wallScene(folder, false);
    return folder.write("walls.json", R"({
  "surfaces": [{"file": "wall.surface.glb"}, {"file": "wall.surface.glb", "position": [10, 0, 0]}],
  "grammars": [{"file": "creeper.grammar", "seeds": [{"position": [1, 0.1, 0], "seed": 2}]}],
  "camera": {"eye": [0, 1.5, 6], "target": [0, 1, 0], "fov": 40}})");
}

std::vector<float> texelsOf(Editing& editing, size_t surface) {
    GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(surface, "damp", picture, editing.error), editing.error);
    return picture.texels;
}

void paint(Editing& editing, size_t surface, float x = 0, float value = 1) {
    StrokeBegin stroke;
    stroke.layer = "damp";
    stroke.radius = .3f;
    stroke.value = value;
    for (const Action& action :
         {Action(stroke), Action(StrokeDabs{{{x + 10 * float(surface), 1, 0, 0, 0, 1, 1}}}), Action(StrokeEnd{})})
        REQUIRE_MESSAGE(editing.perform(action), editing.error);
}

// Two walls that are painted, each otherwise, saved as a project whose second picture is then no picture.
struct Damaged {
    Folder folder;
    std::string project = folder.file("saved"), picture, whole;
    std::vector<float> painted[2];

    explicit Damaged(bool filled) {
        Editing editing(twoWalls(folder));
        if (filled) REQUIRE(editing.perform(FillLayer{"damp", 0}));
        for (const size_t surface : {0u, 1u}) {
            paint(editing, surface, float(surface));
            painted[surface] = texelsOf(editing, surface);
        }
        save(editing);
        const std::vector<std::string> files = pictures(1);
        REQUIRE(files.size() == 1);
        picture = files[0];
        whole = readAll(picture);
        damage();
    }
    void save(Editing& editing) const {
        REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
    }
    // Files of a surface's layer.
    std::vector<std::string> pictures(int surface) const {
        std::vector<std::string> found;
        for (const auto& file : fs::directory_iterator(project + "/layers"))
            if (file.path().filename().string().starts_with("damp-" + std::to_string(surface)))
                found.push_back(file.path().string());
        return found;
    }
    void write(const std::string& bytes) const { std::ofstream(picture, std::ios::binary) << bytes; }
    void damage() const { write("nothing"); }
    // What is read once the disk gives the picture again.
    void mendedHolds(const std::vector<float>& second) {
        write(whole);
        Editing opened(project);
        CHECK(opened.document->scene().notes.empty());
        CHECK(texelsOf(opened, 1) == second);
        damage();
    }
};

}  // namespace

TEST_CASE("a picture that couldn't be read stays through saves, though another wall is painted and all was filled") {
    for (const bool filled : {false, true}) {
        CAPTURE(filled);
        Damaged damaged(filled);
        for (int i = 0; i < 2; ++i) {
            Editing opened(damaged.project);
            REQUIRE(opened.document->scene().notes.size() == 1);
            CHECK(texelsOf(opened, 0) == damaged.painted[0]);
            const std::vector<float> seen = texelsOf(opened, 1);
            CHECK(seen == std::vector<float>(seen.size(), filled ? 0.f : .5f));
            damaged.save(opened);
            CHECK(fs::exists(damaged.picture));
            damaged.mendedHolds(damaged.painted[1]);
        }
        Editing opened(damaged.project);
        paint(opened, 0, -1);
        damaged.painted[0] = texelsOf(opened, 0);
        damaged.save(opened);
        damaged.mendedHolds(damaged.painted[1]);
        CHECK(texelsOf(opened, 0) == damaged.painted[0]);
    }
}

TEST_CASE("a picture that couldn't be read gives way to what is painted in its place, and waits again once undone") {
    Damaged damaged(true);
    Editing opened(damaged.project);
    std::string given;
    SUBCASE("by a stroke") {
        paint(opened, 1);
    }
    SUBCASE("by a fill") {
        REQUIRE(opened.perform(FillLayer{"damp", .25f}));
    }
    SUBCASE("by an import") {
        Editing other(twoWalls(damaged.folder));
        paint(other, 1, -1);
        given = damaged.folder.file("given.exr");
        REQUIRE(exportLayer(*other.document, "damp", given, other.error));
        REQUIRE_MESSAGE(opened.perform(LoadLayer{"damp", given, 1}), opened.error);
    }
    const std::vector<float> painted = texelsOf(opened, 1);
    REQUIRE(opened.perform(Undo{}));
    damaged.save(opened);
    damaged.mendedHolds(damaged.painted[1]);

    // What undo may bring back no save removes.
    for (int i = 0; i < 2; ++i) {
        REQUIRE(opened.perform(Redo{}));
        damaged.save(opened);
        CHECK(damaged.pictures(1).size() == 2);
        Editing again(damaged.project);
        CHECK(again.document->scene().notes.empty());
        CHECK(texelsOf(again, 1) == painted);
        REQUIRE(opened.perform(Undo{}));
        damaged.save(opened);
        damaged.mendedHolds(damaged.painted[1]);
    }
    REQUIRE(opened.perform(Redo{}));
    damaged.save(opened);
    Editing later(damaged.project);
    damaged.save(later);
    CHECK(!fs::exists(damaged.picture));
    CHECK(damaged.pictures(1).size() == 1);
    CHECK(texelsOf(later, 1) == painted);
}

TEST_CASE("a wall that nobody painted goes on with what the grammar says, though the project is saved and opened") {
    for (const bool filled : {false, true}) {
        CAPTURE(filled);
        const Folder folder;
        const std::string project = folder.file("saved");
        Editing editing(twoWalls(folder));
        if (filled) REQUIRE(editing.perform(FillLayer{"damp", .5f}));  // as it comes: nothing is painted
        paint(editing, 0);
        REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
        const auto files = fs::directory_iterator(project + "/layers");
        CHECK(std::distance(begin(files), end(files)) == 1);
        Editing opened(project);
        CHECK(texelsOf(opened, 0) == texelsOf(editing, 0));
        for (Editing* each : {&editing, &opened}) {
            std::string text = each->document->scene().grammars[0].text;
            text.replace(text.find("damp = 0.5"), 10, "damp = 0.9");
            REQUIRE_MESSAGE(each->perform(each->document->withText(0, text)), each->error);
            const std::vector<float> bare = texelsOf(*each, 1);
            CHECK(bare == std::vector<float>(bare.size(), .9f));
        }
        float value = 0;
        CHECK(espLayerFilled(opened.context.get(), "damp", &value) == (filled ? 1 : 0));
        CHECK(opened.hash() == editing.hash());
    }
}
