// Values of parameters under names: the user's own files, and those that come with a grammar.
#include <algorithm>
#include <cstdlib>

#include "sample_game/panels.hpp"
#include "sample_game/settings.hpp"
#include "tests/editor/widgets.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::document;
using namespace sample;
using namespace std::string_literals;

namespace {

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a preset is kept, renamed, removed and brought back; a name that is taken is refused") {
    const Folder folder;
    const char* home = std::getenv("XDG_CONFIG_HOME");
    const std::string before = home ? home : "";
    setenv("XDG_CONFIG_HOME", folder.path.c_str(), 1);
    const std::vector<Param> long_{{"reach", {3}}, {"tint", {.1f, .2f, .3f}}}, short_{{"reach", {.5f}}};
    std::string error;
    error = "what failed before is none of its business";
    REQUIRE_MESSAGE(writePreset("ivy", "long", long_, error), error);
    REQUIRE_MESSAGE(writePreset("ivy", "short", short_, error), error);
    REQUIRE_MESSAGE(writePreset("moss", "../../out", short_, error), error);
    CHECK(presetNames("moss") == Names{"..-..-out"});  // a name leads nowhere else

    CHECK(!renamePreset("ivy", "short", "long", error));
    CHECK_MESSAGE(contains(error, "long.json"), error);
    std::vector<Param> read;
    REQUIRE(readPreset("ivy", "long", read, error));
    CHECK(read == long_);
    REQUIRE(renamePreset("ivy", "short", "brief", error));
    CHECK(renamePreset("ivy", "brief", "brief", error));
    CHECK(presetNames("ivy") == Names{"brief", "long"});

    CHECK(removedPreset("ivy").empty());
    REQUIRE_MESSAGE(removePreset("ivy", "long", error), error);
    REQUIRE_MESSAGE(removePreset("ivy", "brief", error), error);
    CHECK(presetNames("ivy").empty());
    CHECK(removedPreset("ivy") == "brief");  // the last one
    REQUIRE_MESSAGE(writePreset("ivy", "brief", long_, error), error);
    CHECK(!restorePreset("ivy", error));  // its name has been taken since
    REQUIRE(renamePreset("ivy", "brief", "other", error));
    REQUIRE_MESSAGE(restorePreset("ivy", error), error);
    CHECK(presetNames("ivy") == Names{"brief", "other"});
    REQUIRE(readPreset("ivy", "brief", read, error));
    CHECK(read == short_);
    CHECK(removedPreset("ivy").empty());
    error.clear();
    CHECK(!removePreset("ivy", "nothing", error));
    CHECK_MESSAGE(contains(error, "nothing.json"), error);

    folder.write("espalier/presets/ivy/broken.json", "{\"params\": [{\"name\": 3}]}");
    error.clear();
    CHECK(!readPreset("ivy", "broken", read, error));
    CHECK_MESSAGE(contains(error, "broken.json:1:"), error);
    home ? setenv("XDG_CONFIG_HOME", before.c_str(), 1) : unsetenv("XDG_CONFIG_HOME");
}

TEST_CASE("the presets that come with a grammar say values that it takes, and one taken is one step of undo") {
    const Folder folder;
    Editor editor(folder, content("village.json"), sample::Tool::look);
    editor.panels = [&] {
        ImGui::SetNextWindowSize({320, 700});
        ImGui::Begin("panel");
        sample::grammarsPanel(editor.work);
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) editor.frame({});
    const auto& grammars = editor.work.scene().grammars;
    for (const char* file : {"ivy_free", "ivy_guided", "town"}) {
        CAPTURE(file);
        const std::string path = content("grammars/") + file + ".grammar";
        CHECK(shippedPresets(path).size() >= 3);
        for (const std::string& name : shippedPresets(path)) {
            CAPTURE(name);
            std::vector<Param> params;
            std::string error;
            REQUIRE_MESSAGE(readShippedPreset(path, name, params, error), error);
            const auto own = std::ranges::find_if(grammars, [&](const auto& g) { return contains(g.file, file); });
            if (own == grammars.end()) continue;
            for (const Param& param : params) {
                CAPTURE(param.name);
                uint32_t i = 0;
                EspParamInfo info{};
                while (espParamInfo(editor.work.context.get(), own->id, i, &info) == ESP_OK && param.name != info.name)
                    ++i;
                REQUIRE(param.name == info.name);
                REQUIRE(param.value.size() == (info.kind == ESP_PARAM_COLOUR ? 3u : 1u));
                if (info.kind == ESP_PARAM_COLOUR) continue;
                CHECK(param.value[0] >= info.low);
                CHECK(param.value[0] <= info.high);
            }
        }
    }
    const auto value = [&](const char* wanted) {
        EspParamInfo info{};
        for (uint32_t i = 0; espParamInfo(editor.work.context.get(), grammars[0].id, i, &info) == ESP_OK; ++i)
            if (std::string(info.name) == wanted) return info.value[0];
        return -1.f;
    };
    const float leaf = value("leafSize"), twig = value("twigLength");
    pressWidget(editor, "panel", {0, "##presets"});
    pressWidget(editor, "##Combo_00", {"shipped", "Lush"});
    CHECK(value("leafSize") > leaf);
    CHECK(value("twigLength") > twig);
    CHECK(editor.work.document->undoSteps() == 1);
    CHECK(editor.work.document->undoName() == "Preset Lush of ivy_free"s);
    editor.undo();
    CHECK(value("leafSize") == leaf);
    CHECK(value("twigLength") == twig);
    CHECK(editor.work.message == "Undone: Preset Lush of ivy_free");
    editor.key(GLFW_KEY_Z, GLFW_MOD_CONTROL | GLFW_MOD_SHIFT);
    CHECK(editor.work.document->undoName() == "Preset Lush of ivy_free"s);

    // The same again changes nothing, and is no step.
    pressWidget(editor, "panel", {0, "##presets"});
    pressWidget(editor, "##Combo_00", {"shipped", "Lush"});
    CHECK(editor.work.document->undoSteps() == 1);
    CHECK_MESSAGE(contains(editor.work.message, "already"), editor.work.message);
    // What a slider does next is a step of its own, by its own name.
    REQUIRE(editor.work.perform(SetParam{0, {"leafSize", {.1f}}}, editor.work.newGesture()));
    CHECK(contains(editor.work.document->undoName(), "Leaf size"));
    pressWidget(editor, "panel", {0, "##presets"});
    pressWidget(editor, "##Combo_00", {"As the grammar says"});
    CHECK(editor.work.document->undoName() == "The text's own values of ivy_free"s);
    CHECK(value("leafSize") == leaf);
}

TEST_CASE("a name that is another's once it is a file's is told to replace that one") {
    const Folder folder;
    Editor editor(folder, smallScene(folder), Tool::look);
    editor.panels = [&] {
        ImGui::Begin("panel");
        presetsPanel(editor.work, 0);
        ImGui::End();
    };
    for (int i = 0; i < 3; ++i) editor.frame({});
    std::string error;
    REQUIRE_MESSAGE(writePreset("ivy_guided", "a-b", {}, error), error);
    pressWidget(editor, "panel", {"##presets"});
    for (const char letter : {'a', '/', 'b'}) {
        ImGui::GetIO().AddInputCharacter(unsigned(letter));
        editor.frame({});
    }
    pressWidget(editor, "##Combo_00", {"Replace"});
    CHECK(editor.work.message == "Replaced: a-b");
    CHECK(presetNames("ivy_guided") == Names{"a-b"});
    std::vector<Param> kept;
    REQUIRE(readPreset("ivy_guided", "a-b", kept, error));
    CHECK(!kept.empty());
}

TEST_CASE("a preset's picture goes where the preset goes, and is a picture of the view") {
    const Folder folder;
    setenv("XDG_CONFIG_HOME", folder.path.c_str(), 1);
    const std::vector<Param> params{{"reach", {3}}};
    std::string error;
    const auto there = [](const char* name) { return std::filesystem::exists(presetPicture("ivy", name)); };
    REQUIRE(writePreset("ivy", "long", params, error));
    CHECK(!there("long"));
    {
        Window window(folder, smallScene(folder));
        setenv("XDG_CONFIG_HOME", folder.path.c_str(), 1);
        window.work.lookFrom(window.work.scene().camera);
        REQUIRE(espUpdate(window.work.context.get()) == ESP_OK);
        REQUIRE_MESSAGE(window.work.writeView(presetPicture("ivy", "long"), 96, 64), window.work.error);
        CHECK(!window.work.writeView(folder.file("no/such/folder.png"), 96, 64));
    }
    espalier::scene::ColourPicture picture;
    REQUIRE_MESSAGE(readColour(presetPicture("ivy", "long"), picture, error), error);
    CHECK(picture.width == 96);
    CHECK(picture.height == 64);
    size_t differ = 0;
    for (size_t i = 4; i < picture.rgba.size(); i += 4) differ += picture.rgba[i] != picture.rgba[0];
    CHECK(differ > 1000);
    REQUIRE(renamePreset("ivy", "long", "far", error));
    CHECK((there("far") && !there("long")));
    REQUIRE(removePreset("ivy", "far", error));
    REQUIRE(restorePreset("ivy", error));
    CHECK(there("far"));
    // Other values under the name have another picture.
    REQUIRE(writePreset("ivy", "far", params, error));
    CHECK(!there("far"));
}
