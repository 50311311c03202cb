#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/tools/program.hpp"
#include "tools/document/document.hpp"

// A document on the sample scene in a context of its own, as a host without a window has it.
struct Editing {
    std::unique_ptr<EspContext, void (*)(EspContext*)> context{nullptr, espDestroy};
    std::unique_ptr<espalier::document::Document> document;
    std::string error;

    explicit Editing(const std::string& file, uint32_t maxNodes = 20000,
                     size_t maxHistoryBytes = espalier::document::Document::kMaxHistoryBytes) {
        EspContext* made = nullptr;
        const EspContextDef def = esp::defaults<EspContextDef>();
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &made) == ESP_OK, espLastError(nullptr));
        context.reset(made);
        espalier::scene::Request request;
        request.file = file;
        request.grow.maxNodes = maxNodes;
        document = std::make_unique<espalier::document::Document>(made, maxHistoryBytes);
        REQUIRE_MESSAGE(document->open(request, error), error);
    }
    bool perform(const espalier::document::Action& action, uint32_t gesture = 0) {
        error.clear();
        return document->perform(action, error, gesture);
    }
    // The growth's fingerprint.
    uint64_t hash() {
        REQUIRE_MESSAGE(espUpdate(context.get()) == ESP_OK, espLastError(context.get()));
        EspStats stats;
        REQUIRE(espReadStats(context.get(), &stats) == ESP_OK);
        return stats.hash;
    }
    float param(uint32_t grammar, const char* name) const {
        const EspGrammar id = document->scene().grammars[grammar].id;
        for (uint32_t i = 0; i < espParamCount(context.get(), id); ++i) {
            EspParamInfo info;
            if (espParamInfo(context.get(), id, i, &info) == ESP_OK && std::string(info.name) == name)
                return info.value[0];
        }
        return -1;
    }
};

// The sample's model with few texels: what it takes to open one many times.
inline std::string smallSurface() {
    return ESPALIER_SMALL_SURFACE;
}

// A scene of one small plant, for tests that grow often.
inline std::string smallScene(const Folder& folder) {
    return folder.write("small.json", R"({
  "surface": ")" + smallSurface() +
                                          R"(",
  "grammars": [{"file": ")" + content("grammars/ivy_guided.grammar") +
                                          R"(", "params": {"reach": 1, "twigs": 2},
    "seeds": [{"position": [-1.35, 0.12, 0.36], "seed": 1}, {"position": [1.95, 0.12, 0.36], "seed": 1}]}],
  "camera": {"eye": [2.3, 1.9, 8.0], "target": [-0.05, 1.55, 0.3], "fov": 38}
})");
}

// The same with a grammar of the test's own in the folder, which others may write: own.grammar.
inline std::string sceneOfItsOwn(const Folder& folder) {
    folder.write("own.grammar", readAll(content("grammars/ivy_guided.grammar")));
    std::string text = readAll(smallScene(folder));
    const std::string name = content("grammars/ivy_guided.grammar");
    text.replace(text.find(name), name.size(), "own.grammar");
    return folder.write("own.json", text);
}

// Plants of another kind than ivy, which read a layer of their own.
inline constexpr const char* kCreeper = R"(param reach = 0.8 [0.2 .. 2]  "m"   "Length"
param bend  = 0.1 [0 .. 0.5] "rad" "Bend"
context damp = 0.5 "Where it is damp"
Creep : arc >= reach * (0.5 + damp(texCoord)) -> NULL
Creep -> Marching(0.05, rand(-bend, bend), damp(texCoord) > 0.1) {Creep, Wood}
Wood -> S(0.01) Shape("bark", C1)
)";

// A wall with 128 texels a side to a layer, an ivy and a creeper at its foot, and beside it a town of two houses: what
// can be edited, small enough to be looked at whole after each edit.
inline std::string wallScene(const Folder& folder, bool town) {
    folder.write("wall.obj", R"(v -2 0 0
v 2 0 0
v 2 2.5 0
v -2 2.5 0
v -2 0 -0.5
v 2 0 -0.5
v 2 2.5 -0.5
v -2 2.5 -0.5
f 1 2 3 4
f 2 6 7 3
f 6 5 8 7
f 5 1 4 8
f 4 3 7 8
)");
    const Ran baked = run(program("espalier-bake") + " -q --resolution 128 -o " + folder.file("wall.surface.glb") +
                          " " + folder.file("wall.obj"));
    REQUIRE_MESSAGE(baked.code == 0, baked.output);
    folder.write("creeper.grammar", kCreeper);
    folder.write("houses.json", R"({"buildings": [{"id": "a", "outer": [[0,0],[12,0],[12,8],[0,8]]},
  {"id": "b", "outer": [[18,0],[27,0],[27,4],[22,4],[22,9],[18,9]]}]})");
    const std::string place = R"("town": {"file": "houses.json", "grammar": 2, "position": [10, 0, -30]},)";
    const std::string roofs = R"(, {"file": ")" + content("grammars/town.grammar") + R"("})";
    const std::string ivy = R"({"file": ")" + content("grammars/ivy_guided.grammar") + R"(", )";
    return folder.write("wall.json", R"({"surface": "wall.surface.glb", )" + (town ? place : "") + R"("grammars": [)" +
                                         ivy + R"("params": {"reach": 1, "twigs": 2},
      "seeds": [{"position": [-1, 0.1, 0], "seed": 1}]},
    {"file": "creeper.grammar", "seeds": [{"position": [1, 0.1, 0], "seed": 2}]})" +
                                         (town ? roofs : "") + R"(],
  "camera": {"eye": [0, 1.5, 6], "target": [0, 1, 0], "fov": 40}})");
}

// What editors have kept of what isn't saved, in a folder and all that are in it.
inline std::vector<std::string> autosavesIn(const std::filesystem::path& folder) {
    std::vector<std::string> found;
    if (!std::filesystem::exists(folder)) return found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().filename() == "autosave.json") found.push_back(entry.path().string());
    return found;
}
