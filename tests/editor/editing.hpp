#pragma once

#include <doctest/doctest.h>

#include <memory>
#include <random>
#include <string>

#include "tests/tools/program.hpp"
#include "tools/document/document.hpp"

// A document on the sample scene in a context of its own, as a host without a window has it.
struct Editing {
    std::unique_ptr<EspContext, void (*)(EspContext*)> context{nullptr, espDestroy};
    std::unique_ptr<espalier::document::Document> document;
    std::string error;

    explicit Editing(const std::string& file, uint32_t maxNodes = 20000) {
        EspContext* made = nullptr;
        const EspContextDef def = espDefaultContextDef();
        REQUIRE_MESSAGE(espCreate(&def, &made) == ESP_OK, espLastError(nullptr));
        context.reset(made);
        EspGrowDef grow = espDefaultGrowDef();
        grow.maxNodes = maxNodes;
        REQUIRE(espSetGrow(made, &grow) == ESP_OK);
        document = std::make_unique<espalier::document::Document>(made);
        REQUIRE_MESSAGE(document->open({file, {}, {}, {}}, error), error);
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

// A scene of one small plant, for tests that grow often.
inline std::string smallScene(const Folder& folder) {
    return folder.write("small.json", R"({
  "surface": ")" + content("ruin.surface.glb") +
                                          R"(",
  "grammars": [{"file": ")" + content("grammars/ivy_guided.grammar") +
                                          R"(", "params": {"reach": 1, "twigs": 2},
    "seeds": [{"position": [-1.35, 0.12, 0.36], "seed": 1}, {"position": [1.95, 0.12, 0.36], "seed": 1}]}],
  "camera": {"eye": [2.3, 1.9, 8.0], "target": [-0.05, 1.55, 0.3], "fov": 38}
})");
}
