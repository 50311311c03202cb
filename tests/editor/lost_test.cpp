// Projects whose town or grammars have become others since they were saved.
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <regex>

#include "plugin_api/espalier.hpp"
#include "sample_game/grammar_files.hpp"
#include "sample_game/settings.hpp"
#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/text_file.hpp"

using namespace espalier::document;
using espalier::scene::House;

namespace {

const char* const kA = R"({"id": "a", "outer": [[0,0],[12,0],[12,8],[0,8]]})";
const char* const kB = R"({"id": "b", "outer": [[18,0],[27,0],[27,4],[22,4],[22,9],[18,9]]})";
const char* const kNew = R"({"id": "new", "outer": [[-20,0],[-12,0],[-12,6],[-20,6]]})";

std::string plan(const std::string& houses) {
    return "{\"buildings\": [" + houses + "]}";
}

// The house "b" has another roof and outline.
House changed(Editing& editing) {
    House house = espalier::scene::houseNow(editing.context.get(), 1);
    house.shape = "gable";
    house.corners[0][0] -= 1;
    REQUIRE_MESSAGE(editing.perform(SetHouse{house}), editing.error);
    return house;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a project finds a house by its id, wherever the plan has it, and tells of one that is gone") {
    const Folder folder;
    const std::string scene = wallScene(folder, true), project = folder.file("project");
    House house;
    {
        Editing editing(scene);
        house = changed(editing);
        REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
    }
    const auto shapeOf = [](Editing& opened, uint32_t index) {
        return espalier::scene::houseNow(opened.context.get(), index).shape;
    };
    folder.write("houses.json", plan(std::string(kNew) + "," + kA + "," + kB));
    {
        Editing opened(project);
        CHECK(opened.document->scene().notes.empty());
        REQUIRE(opened.document->scene().town->houses.size() == 1);
        CHECK(opened.document->scene().town->houses[0].index == 2);
        CHECK(opened.document->scene().town->houses[0].corners == house.corners);
        CHECK(shapeOf(opened, 1) == "hip");
        CHECK(shapeOf(opened, 2) == "gable");
        REQUIRE(saveProject(*opened.document, folder.file("again"), opened.error));
    }
    folder.write("houses.json", plan(std::string(kB) + "," + kNew));
    CHECK(Editing(folder.file("again")).document->scene().town->houses[0].index == 0);
    folder.write("houses.json", plan(kA));
    {
        Editing opened(project);
        REQUIRE(opened.document->scene().notes.size() == 1);
        CHECK_MESSAGE(contains(opened.document->scene().notes[0], "'b'"), opened.document->scene().notes[0]);
        CHECK(opened.document->scene().town->houses.empty());
        CHECK(shapeOf(opened, 0) == "hip");
    }
    // One that an older program has saved: by its place.
    folder.write("houses.json", plan(std::string(kA) + "," + kB));
    folder.write("project/project.json", replaced(readAll(project + "/project.json"), "\"id\": \"b\",", ""));
    Editing old(project);
    CHECK(shapeOf(old, 1) == "gable");
    folder.write("houses.json", plan(kA));
    Editing lost(project);
    REQUIRE(lost.document->scene().notes.size() == 1);
    CHECK_MESSAGE(contains(lost.document->scene().notes[0], "house 1"), lost.document->scene().notes[0]);
}

TEST_CASE("what was painted over a town stays at its place when the plan gets another house, and loses it again") {
    using espalier::scene::GreyPicture;
    const Folder folder;
    const std::string scene = wallScene(folder, true), project = folder.file("project");
    const auto read = [](Editing& of) {
        GreyPicture moss;
        REQUIRE_MESSAGE(of.document->readTownLayer("moss", moss, of.error), of.error);
        return moss;
    };
    // The layer at a place of the world; -1: it isn't over that.
    const auto at = [&](Editing& of, float x, float z) {
        const auto square = espalier::scene::squareOf(of.context.get());
        REQUIRE(square);
        const GreyPicture moss = read(of);
        const float u = (x - square->low[0]) / square->side, v = (z - square->low[1]) / square->side;
        if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return -1.f;
        return moss.texels[size_t(v * float(moss.height)) * moss.width + size_t(u * float(moss.width))];
    };
    std::vector<std::array<float, 3>> before;  // x, z and value
    GreyPicture painted;
    espalier::scene::TownSquare over;
    {
        Editing editing(scene);
        over = *espalier::scene::squareOf(editing.context.get());
        REQUIRE(editing.perform(FillLayer{"moss", .25f}));
        StrokeBegin stroke;
        stroke.layer = "moss";
        stroke.radius = 4;
        stroke.value = 1;
        REQUIRE_MESSAGE(editing.perform(stroke), editing.error);
        REQUIRE(editing.perform(StrokeDabs{{{16, 3, -34, 0, 1, 0, 1}}}));
        REQUIRE(editing.perform(StrokeEnd{}));
        for (float x = 8; x < 40; x += 1.3f)
            for (float z = -40; z < -28; z += 1.3f) before.push_back({x, z, at(editing, x, z)});
        CHECK(at(editing, 16, -34) > .6f);
        painted = read(editing);
        REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
    }
    CHECK(read(*std::make_unique<Editing>(project)).texels == painted.texels);
    folder.write("houses.json", plan(std::string(kA) + "," + kB + "," + kNew));
    {
        Editing wider(project);
        CHECK(wider.document->scene().notes.empty());
        REQUIRE(read(wider).texels != painted.texels);
        for (const auto& [x, z, value] : before) {
            CAPTURE(x);
            CAPTURE(z);
            CHECK(std::abs(at(wider, x, z) - value) < .15f);  // of the stroke's slope in a texel
        }
        CHECK(at(wider, -5, -34) == .25f);  // at the new house, as all was filled
        REQUIRE_MESSAGE(saveProject(*wider.document, folder.file("again"), wider.error), wider.error);
    }
    folder.write("houses.json", plan(std::string(kA) + "," + kB));
    Editing again(folder.file("again"));
    for (const auto& [x, z, value] : before) CHECK(std::abs(at(again, x, z) - value) < .2f);
    // An older program's says nothing of it: its picture lies over all.
    const std::regex square(R"(,\s*"low": \[[^\]]*\],\s*"side": [-+.e0-9]+)");
    const std::string json = readAll(project + "/project.json"), old = std::regex_replace(json, square, "");
    REQUIRE(old.size() < json.size());
    folder.write("project/project.json", old);
    CHECK(read(*std::make_unique<Editing>(project)).texels == painted.texels);
    folder.write("houses.json", plan(std::string(kA) + "," + kB + "," + kNew));
    Editing stretched(project);
    CHECK(stretched.document->scene().notes.empty());
    const auto now = espalier::scene::squareOf(stretched.context.get());
    const float x = now->low[0] + (16 - over.low[0]) / over.side * now->side;
    const float z = now->low[1] + (-34 - over.low[1]) / over.side * now->side;
    CHECK(at(stretched, x, z) > .6f);
}

TEST_CASE("a project whose grammar has lost a parameter opens and tells of it; a scene is refused") {
    const Folder folder;
    const std::string scene = smallScene(folder), project = folder.file("project");
    uint64_t before = 0;
    {
        Editing editing(scene);
        before = editing.hash();
        REQUIRE(saveProject(*editing.document, project, editing.error));
    }
    const std::string json = project + "/project.json";
    folder.write("project/project.json", replaced(readAll(json), "\"params\": {", "\"params\": {\"lost\": 3,"));
    Editing opened(project);
    REQUIRE(opened.document->scene().notes.size() == 1);
    CHECK_MESSAGE(contains(opened.document->scene().notes[0], "'lost'"), opened.document->scene().notes[0]);
    CHECK(opened.hash() == before);

    folder.write("lost.json", replaced(readAll(scene), "\"params\": {", "\"params\": {\"lost\": 3,"));
    EspContext* context = nullptr;
    const EspContextDef def = esp::defaults<EspContextDef>();
    REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
    {
        Document refused(context);
        std::string error;
        espalier::scene::Request request;
        request.file = folder.file("lost.json");
        CHECK(!refused.open(request, error));
        CHECK_MESSAGE(contains(error, "lost.json:"), error);
    }
    espDestroy(context);
}

TEST_CASE("a project that has lost a frozen plant's file and its site opens, and has both when they are there again") {
    const Folder folder;
    const std::string project = folder.file("project"), json = project + "/project.json";
    const std::string site = R"({"models": ")" + content("props.glb") + R"(", "props": {}})";
    const std::string scene = folder.write(
        "sited.json", replaced(readAll(smallScene(folder)), "\"grammars\"", "\"site\": \"site.json\", \"grammars\""));
    folder.write("site.json", site);
    uint32_t key = 0;
    {
        Editing editing(scene);
        editing.hash();
        key = editing.document->scene().seeds[0].key;
        REQUIRE_MESSAGE(editing.perform(FreezeSeeds{{key}, true}), editing.error);
        REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
    }
    const std::string whole = readAll(json);
    std::filesystem::rename(project + "/plants", folder.path / "aside");
    std::filesystem::create_directory(project + "/plants");
    const std::string plant =
        project + "/plants/" + std::filesystem::directory_iterator(folder.path / "aside")->path().filename().string();
    std::ofstream(plant) << "damaged";
    std::filesystem::remove(folder.path / "site.json");
    {
        Editing opened(project);
        const auto& notes = opened.document->scene().notes;
        REQUIRE(notes.size() == 2);
        CHECK_MESSAGE(contains(notes[0], "site.json"), notes[0]);
        CHECK_MESSAGE(contains(notes[1], plant), notes[1]);
        REQUIRE(opened.document->scene().seeds.size() == 2);
        CHECK(!opened.document->scene().seeds[0].frozen);
        CHECK(opened.hash() != 0);
        // What is done to the seed and undone changes nothing of it.
        REQUIRE(opened.perform(RemoveSeeds{{key}}));
        REQUIRE(opened.perform(Undo{}));
        REQUIRE_MESSAGE(saveProject(*opened.document, project, opened.error), opened.error);
        CHECK(readAll(json) == whole);
        REQUIRE(opened.perform(RemoveSeeds{{key}}));
        REQUIRE_MESSAGE(saveProject(*opened.document, project, opened.error), opened.error);
        REQUIRE(opened.perform(Undo{}));
        CHECK(std::filesystem::exists(plant));
        opened.hash();
        for (const bool frozen : {true, false}) REQUIRE(opened.perform(FreezeSeeds{{key}, frozen}));
        REQUIRE_MESSAGE(saveProject(*opened.document, project, opened.error), opened.error);
        for (int i = 0; i < 2; ++i) REQUIRE(opened.perform(Undo{}));
        REQUIRE_MESSAGE(saveProject(*opened.document, project, opened.error), opened.error);
        CHECK(readAll(json) == whole);
        CHECK(std::filesystem::exists(plant));
        // One that is frozen anew stands as it is now, and is thawed.
        REQUIRE(opened.perform(FreezeSeeds{{key}, true}));
        REQUIRE(opened.perform(FreezeSeeds{{key}, false}));
        REQUIRE_MESSAGE(saveProject(*opened.document, folder.file("thawed"), opened.error), opened.error);
        CHECK(!contains(readAll(folder.file("thawed/project.json")), ".plant"));
    }
    std::filesystem::remove_all(project + "/plants");
    std::filesystem::rename(folder.path / "aside", project + "/plants");
    folder.write("site.json", site);
    Editing again(project);
    CHECK(again.document->scene().notes.empty());
    CHECK(again.document->scene().seeds[0].frozen);
}

TEST_CASE("a project whose text has lost what it includes opens with its mistake, and grows when that is there again") {
    const Folder folder;
    const std::string scene = wallScene(folder, false), project = folder.file("project");
    folder.write("creeper.grammar", std::string("include \"bend.grammar\"\n") + kCreeper);
    folder.write("bend.grammar", "param spare = 1 [0 .. 2] \"m\" \"Spare\"\n");
    uint64_t before = 0;
    {
        Editing editing(scene);
        REQUIRE(editing.perform(SetParam{1, {"reach", {1.4f}}}));
        before = editing.hash();
        REQUIRE(saveProject(*editing.document, project, editing.error));
    }
    std::filesystem::remove(folder.path / "bend.grammar");
    {
        Editing opened(project);
        const auto& grammar = opened.document->scene().grammars[1];
        CHECK(grammar.error != "");
        CHECK(contains(grammar.text, "include \"bend.grammar\""));
        REQUIRE(!opened.document->scene().notes.empty());
        CHECK(opened.hash() != before);
        REQUIRE_MESSAGE(opened.perform(opened.document->withText(1, kCreeper)), opened.error);
        CHECK(opened.document->scene().grammars[1].error == "");
        CHECK(opened.hash() == before);
        REQUIRE_MESSAGE(opened.perform(Undo{}), opened.error);
        REQUIRE_MESSAGE(opened.perform(Redo{}), opened.error);
        CHECK(opened.hash() == before);
    }
    // Who saves it meanwhile, twice, keeps what the sliders said.
    for (int i = 0; i < 2; ++i) {
        Editing opened(project);
        CHECK(opened.param(1, "reach") == -1);  // until the text can be read
        REQUIRE(saveProject(*opened.document, project, opened.error));
    }
    folder.write("bend.grammar", "param spare = 1 [0 .. 2] \"m\" \"Spare\"\n");
    Editing again(project);
    CHECK(again.param(1, "reach") == 1.4f);
    CHECK(again.hash() == before);
}

TEST_CASE("a town whose grammar has lost what it includes gets its roofs, as they were, when that is there again") {
    const Folder folder;
    std::filesystem::copy(content("grammars"), folder.path / "grammars", std::filesystem::copy_options::recursive);
    const std::string own =
        replaced(readAll(wallScene(folder, true)), content("grammars/town.grammar"), "grammars/town.grammar");
    const std::string scene = folder.write("own.json", own), project = folder.file("project");
    const auto roofs = [](Editing& editing) {
        EspRoofStats stats{};
        REQUIRE_MESSAGE(espUpdate(editing.context.get()) == ESP_OK, espLastError(editing.context.get()));
        REQUIRE(espReadRoofStats(editing.context.get(), &stats) == ESP_OK);
        return stats;
    };
    uint64_t before = 0;
    {
        Editing editing(scene);
        REQUIRE_MESSAGE(editing.perform(SetParam{2, {"overhang", {.75f}}}), editing.error);
        before = roofs(editing).hash;
        REQUIRE(roofs(editing).tiles > 0);
        REQUIRE(saveProject(*editing.document, project, editing.error));
    }
    const std::filesystem::path part = folder.path / "grammars/roof_house.grammar";
    std::filesystem::rename(part, folder.path / "aside");
    Editing opened(project);
    CHECK(roofs(opened).tiles == 0);
    const auto& notes = opened.document->scene().notes;
    CHECK(std::ranges::any_of(notes, [](const std::string& note) { return contains(note, "have no roofs"); }));
    std::filesystem::rename(folder.path / "aside", part);
    const std::string text = opened.document->scene().grammars[2].text;
    REQUIRE_MESSAGE(opened.perform(opened.document->withText(2, text)), opened.error);
    CHECK(opened.document->scene().grammars[2].error == "");
    CHECK(roofs(opened).hash == before);
}

TEST_CASE("a text that is typed here is written into its file, behind a link too, and is no news then") {
    const Folder folder;
    const std::string scene = wallScene(folder, false);
    std::filesystem::rename(folder.path / "creeper.grammar", folder.path / "real.grammar");
    std::filesystem::create_symlink("real.grammar", folder.path / "creeper.grammar");
    Editing editing(scene);
    sample::GrammarFiles files;
    files.begin(editing.document->scene());
    sample::FileText text;
    const std::string file = folder.file("creeper.grammar");
    REQUIRE(text.of(file));
    CHECK(sample::sameText(*text.of(file), editing.document->scene().grammars[1].text));
    REQUIRE(editing.perform(editing.document->withText(1, std::string(kCreeper) + "// mine\n")));
    CHECK(!sample::sameText(*text.of(file), editing.document->scene().grammars[1].text));
    REQUIRE(sample::writeGrammar(file, editing.document->scene().grammars[1].text, editing.error));
    CHECK(sample::sameText(*text.of(file), editing.document->scene().grammars[1].text));
    CHECK(std::filesystem::is_symlink(file));
    CHECK(contains(readAll(folder.path / "real.grammar"), "// mine"));
    CHECK(files.look(editing.document->scene()).empty());
    std::filesystem::remove(file);
    CHECK(!text.of(file));
    CHECK(!sample::sameText("a\nb", "a\nc"));
    CHECK(sample::sameText("a\nb\n\n", "a\nb"));
    CHECK(!sample::sameText("a", "ab"));
}

TEST_CASE("grammars of one file share their presets") {
    CHECK(sample::presetsOf("a/ivy.grammar") == "ivy");
    CHECK(sample::presetsOf("b/ivy.grammar") == sample::presetsOf("ivy.grammar"));
}

TEST_CASE("a seed of a project that can't be planted is told by its place, and the others grow") {
    const Folder folder;
    const std::string project = folder.file("project");
    uint64_t whole = 0;
    {
        Editing editing(smallScene(folder));
        whole = editing.hash();
        REQUIRE_MESSAGE(saveProject(*editing.document, project, editing.error), editing.error);
    }
    const std::string file = project + "/project.json", text = readAll(file);
    const size_t at = text.find("\"position\"");
    REQUIRE(at != std::string::npos);
    const size_t bracket = text.find('[', at), comma = text.find(',', bracket);
    std::ofstream(file) << text.substr(0, bracket + 1) << "2e19" << text.substr(comma);
    Editing editing(project);
    const auto& seeds = editing.document->scene().seeds;
    REQUIRE(seeds.size() == 2);
    CHECK(seeds[0].planted.id == 0);
    CHECK(seeds[1].planted.id != 0);
    const uint64_t others = editing.hash();
    CHECK(others != 0);
    CHECK(others != whole);
    const auto& notes = editing.document->scene().notes;
    CHECK(std::ranges::any_of(notes, [](const std::string& note) { return contains(note, "seed 1 at 2e+19"); }));
}
