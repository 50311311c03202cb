#pragma once

// A context on a device that fails on order, from its creation to a picture of ivy on a square.

#include <string>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/failing_device.hpp"

namespace espalier {

inline constexpr const char* kLifeIvy =
    "param reach = 0.3 [0.1 .. 5] \"m\" \"Length of the stems\"\n"
    "Ivy -> Branch(2) {Stem(reach), Stem(reach * 0.7)}\n"
    "Stem(l) : arc >= l -> NULL\n"
    "Stem(l) -> Marching(0.05, rand(-0.3, 0.3), true) {Stem(l), Wood Foliage}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n"
    "Foliage -> Repeat(2) {S(0.06) T(rand(), 0.02) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";

inline void silent(void*, EspLogLevel, const char*) {}

// A context whose steps can be told one by one; the first that fails ends the life.
struct Life {
    EspContext* context = nullptr;
    EspSurface surface{};
    EspGrammar grammar{};
    EspSeed seed{};
    std::string failedStep;
    EspResult result = ESP_OK;

    ~Life() { espDestroy(context); }

    bool step(const char* name, EspResult gave) {
        result = gave;
        if (gave != ESP_OK) failedStep = name;
        return gave == ESP_OK;
    }
    bool create(const FailingDevice& device) {
        const EspHostDevice host = device.host();
        EspContextDef def = esp::defaults<EspContextDef>();
        def.host = &host;
        def.log = silent;
        def.skipSelfCheck = 1;  // lives count what fails within themselves
        return step("create", espCreate(ESP_VERSION, &def, &context));
    }
    bool load() { return step("load", espLoadSurface(context, ESPALIER_SQUARE, nullptr, &surface)); }
    bool compile() {
        EspGrammarDef def = esp::grammarDef("ivy", kLifeIvy);
        return step("compile", espCompileGrammar(context, &def, &grammar));
    }
    bool plant(uint32_t number) {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = grammar;
        def.position[0] = .1f * float(number);
        def.direction[1] = 1;
        def.number = number;
        return step("plant", espPlant(context, &def, &seed));
    }
    bool update() { return step("update", espUpdate(context)); }
    bool draw() {
        esp::DrawDef def;
        def.width = 64;
        def.height = 36;
        def.camera = esp::frameAll(context);
        return step("draw", espDraw(context, &def));
    }
    bool read() {
        uint8_t pixels[64 * 36 * 4];
        return step("read", espReadPixels(context, pixels, sizeof pixels));
    }
    bool trim() { return step("trim", espTrim(context)); }
    EspStats stats() {
        EspStats s{};
        step("stats", espReadStats(context, &s));
        return s;
    }
    bool all(const FailingDevice& device) {
        return create(device) && load() && compile() && plant(1) && update() && draw() && read() && trim();
    }
};

}  // namespace espalier
