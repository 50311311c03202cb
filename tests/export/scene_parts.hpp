#pragma once

// A scene of the sample's content that has grown, and its parts.

#include <doctest/doctest.h>

#include <string>

#include "plugin_api/espalier.hpp"
#include "tools/document/document.hpp"

struct GrownScene {
    EspContext* context = nullptr;

    explicit GrownScene(const char* name) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = [](void*, EspLogLevel, const char*) {};
        def.skipSelfCheck = 1;
        REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
        espalier::document::Document document(context);
        espalier::scene::Request request;
        request.file = std::string(ESPALIER_CONTENT) + "/" + name;
        std::string error;
        REQUIRE_MESSAGE(document.open(request, error), error);
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    }
    ~GrownScene() { espDestroy(context); }
    GrownScene(const GrownScene&) = delete;

    EspPartsInfo parts(float stemError = .2f, uint32_t stemLevels = 3) {
        EspPartsDef def = esp::defaults<EspPartsDef>();
        def.stemError = stemError;
        def.stemLevels = stemLevels;
        EspPartsInfo info;
        REQUIRE_MESSAGE(espReadParts(context, &def, &info) == ESP_OK, espLastError(context));
        return info;
    }
    EspPartInfo part(uint32_t index) {
        EspPartInfo info;
        REQUIRE(espPartInfo(context, index, &info) == ESP_OK);
        return info;
    }
    EspPartLevel level(uint32_t index, uint32_t number) {
        EspPartLevel level;
        REQUIRE(espPartLevel(context, index, number, &level) == ESP_OK);
        return level;
    }
};
