#pragma once

// A designer's work on a device that may be lost: a call that fails for want of the device is made again, once
// Work::lost has seen to another one.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"
#include "tests/plugin/town_host.hpp"

namespace recreated {

using namespace espalier;
using Fault = FailingDevice::Failure;

inline constexpr const char* kIvy =
    "param reach = 0.5 [0.1 .. 5] \"m\"\n"
    "context mask = 1\n"
    "Ivy -> Branch(3) {Stem(reach), Stem(reach * 0.7), Stem(reach * 0.5)}\n"
    "Stem(l) : arc >= l || mask(texCoord) < 0.3 -> NULL\n"
    "Stem(l) -> Marching(0.03, rand(-0.4, 0.4), true) {Stem(l), Wood Foliage}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n"
    "Foliage -> Repeat(2) {S(0.06) T(rand(), 0.02) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";
inline constexpr const char* kRings =
    "angles degrees\n"
    "field flow : tensor \"Direction\"\n"
    "Start -> A\n"
    "A -> [S(0.15) IC(\"torus\")] [T(0.15, 0, 0) A] [Rz(120) T(0.15, 0, 0) A] [Rz(-120) T(0.15, 0, 0) A]\n";
inline constexpr const char* kTown =
    "{\"buildings\": [{\"id\": \"h\", \"outer\": [[10,0],[20,0],[20,8],[10,8]]}, "
    "{\"id\": \"g\", \"outer\": [[30,0],[40,0],[40,8],[30,8]]}]}";
inline constexpr const char* kGraph =
    "graph 1\n"
    "ring = Circle(samples: 16, radius: 0.1)\n"
    "path = Curve(to: (0, 2, 0))\n"
    "tube = Loft(path, ring)\n"
    "show tube\n";

inline std::vector<char> fileOf(const char* path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline EspTransform at(float x, float y) {
    EspTransform place = espIdentity();
    place.rows[0][3] = x, place.rows[1][3] = y;
    return place;
}

// What a designer has made, and what has grown of it.
struct Print {
    uint64_t plants = 0, roofs = 0, pattern = 0, nodes = 0;
    uint32_t seeds = 0, pruned = 0, standing = 0, graphTriangles = 0;
    float reach = 0, fill = 0;
    int filled = 0;
    std::vector<std::vector<float>> layers;
    bool operator==(const Print&) const = default;
};

struct Work : Life {
    FailingDevice& device;
    std::function<void()> lost = [] { FAIL("the device was lost"); };
    EspSurface other{}, hidden{}, far{};
    EspGrammar rings{}, roofs{};
    EspSeed second{};
    EspGraph graph{};
    std::vector<EspStroke> strokes;

    explicit Work(FailingDevice& on, const EspFiles* files = nullptr) : device(on) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.files = files;
        const EspHostDevice host = device.host();
        def.host = &host;
        def.log = silent;
        def.skipSelfCheck = 1;
        REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
    }

    EspResult recreate() {
        const EspHostDevice host = device.host();
        return espRecreate(context, &host);
    }
    void renew() {
        device.renew();
        REQUIRE_MESSAGE(recreate() == ESP_OK, espLastError(context));
        device.dropOld();
    }
    void lose() {
        device.failAt(0, Fault::Lost);
        EspResult gave = ESP_OK;
        for (float reach = 1; gave == ESP_OK; reach += .01f) {
            REQUIRE(espSetParam(context, grammar, "reach", &reach, 1) == ESP_OK);
            gave = espUpdate(context);
        }
        REQUIRE(gave == ESP_DEVICE_LOST);
    }

    // Makes a call until it isn't for want of a device that it fails.
    template <class Call>
    void take(Call call) {
        EspResult gave = call();
        for (int tries = 0; gave == ESP_DEVICE_LOST && tries < 100; ++tries) {
            CHECK(std::string(espLastError(context)).find("lost") != std::string::npos);
            lost();
            gave = call();
        }
        REQUIRE_MESSAGE(gave == ESP_OK, espLastError(context));
    }

    EspStroke open(const char* layer, EspBrushMode mode, float radius) {
        EspBrush brush = brushOn(layer, radius);
        brush.mode = mode;
        brush.strength = .7f;
        EspStroke stroke{};
        take([&] { return espBeginStroke(context, &brush, &stroke); });
        return stroke;
    }
    void dab(EspStroke stroke, float x, float y) {
        const EspDab at = {{x, y, 0}, {0, 0, 1}, 1};
        take([&] { return espStrokeDabs(context, stroke, &at, 1); });
    }
    void end(EspStroke stroke) {
        take([&] { return espEndStroke(context, stroke); });
        strokes.push_back(stroke);
    }
    void grow() {
        take([&] { return espUpdate(context); });
    }

    void loadAll() {
        const std::vector<char> bytes = fileOf(ESPALIER_SQUARE);
        EspSurfaceDef def{};
        def.structSize = sizeof def;
        def.name = "square";
        def.bytes = bytes.data();
        def.size = bytes.size();
        const EspTransform beside = at(1, 0), above = at(0, 2), away = at(4, 0);
        def.place = &beside;
        take([&] { return espLoadSurface(context, ESPALIER_SQUARE, nullptr, &surface); });
        take([&] { return espAddSurface(context, &def, &other); });
        take([&] { return espLoadSurface(context, ESPALIER_SQUARE, &above, &hidden); });
        take([&] { return espHideSurface(context, hidden, 1); });
        EspSurfaceDef streamed{};
        streamed.structSize = sizeof streamed;
        streamed.name = ESPALIER_SQUARE;
        streamed.place = &away;
        EspStreamedDef stream{};
        stream.structSize = sizeof stream;
        stream.surface = &streamed;
        stream.boundsMax[0] = stream.boundsMax[1] = 1;
        take([&] { return espAddStreamed(context, &stream, &far); });
        EspStreamingDef eye = esp::defaults<EspStreamingDef>();
        eye.eye[0] = 4;
        take([&] { return espSetStreaming(context, &eye); });
        EspStreamedInfo info{};
        for (info.structSize = sizeof info; info.state != ESP_STREAMED_STANDS;) {
            grow();
            take([&] { return espStreamedInfo(context, far, &info); });
        }
    }
    EspSeed plantAt(EspGrammar of, float x, float y, uint32_t number) {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = of;
        def.position[0] = x, def.position[1] = y;
        def.direction[1] = 1;
        def.number = number;
        EspSeed planted{};
        take([&] { return espPlant(context, &def, &planted); });
        return planted;
    }
    void plantAll() {
        const auto compile = [&](const char* name, const char* text, EspGrammar& out) {
            const EspGrammarDef def = esp::grammarDef(name, text);
            take([&] { return espCompileGrammar(context, &def, &out); });
        };
        compile("ivy", kIvy, grammar);
        compile("rings", kRings, rings);
        compile("roofs", kDecaying, roofs);
        seed = plantAt(grammar, .9f, .1f, 1);
        second = plantAt(grammar, .3f, .1f, 2);
        plantAt(grammar, 4.5f, .1f, 3);
        plantAt(grammar, 1.5f, .2f, 4);
        plantAt(rings, .5f, 2.5f, 5);
        const float longer = .8f, own = .6f;
        take([&] { return espSetParam(context, grammar, "reach", &longer, 1); });
        take([&] { return espSetSeedParam(context, second, "reach", &own, 1); });
        EspTownDef town = esp::defaults<EspTownDef>();
        town.text = kTown;
        town.length = std::strlen(kTown);
        town.grammar = roofs;
        take([&] { return espLoadTown(context, &town); });
        take([&] { return espHideHouse(context, 1, 1); });
        const EspFieldElement element{ESP_ELEMENT_REGULAR, {.5f, 2.5f, 0}, {.6f, .7f, .3f}, .3f};
        EspFieldDef field = esp::defaults<EspFieldDef>();
        field.elements = &element;
        field.elementCount = 1;
        const float way[] = {.4f, .4f, 0, .6f, .6f, 0}, corners[] = {0, 0, 0, 1, 1, 0}, wind[] = {1, 0, 0, 0, 1, 0};
        const EspFieldStroke stroke{ESP_FIELD_COMB, .3f, .8f, 2, way};
        field.strokes = &stroke;
        field.strokeCount = 1;
        field.points = corners;
        field.vectors = wind;
        field.pointCount = 2;
        take([&] { return espSetField(context, hidden, "flow", &field); });
        EspGraphDef boxes{};
        boxes.structSize = sizeof boxes;
        boxes.text = kGraph;
        boxes.length = std::strlen(kGraph);
        take([&] { return espCompileGraph(context, &boxes, &graph); });
        grow();
    }
    void paintAll() {
        EspStroke stroke = open("mask", ESP_BRUSH_PAINT, .2f);
        for (float x : {.2f, .5f, .8f, 1.1f}) dab(stroke, x, .6f);
        end(stroke);
        grow();
        take([&] { return espFillLayer(context, "damp", .25f, &stroke); });
        strokes.push_back(stroke);
        stroke = open("mask", ESP_BRUSH_SMOOTH, .25f);
        dab(stroke, .4f, .5f);
        dab(stroke, .95f, .5f);  // over the border of two surfaces
        end(stroke);
        stroke = open("mask", ESP_BRUSH_ERASE, .3f);
        dab(stroke, .3f, .4f);
        dab(stroke, 4.3f, .5f);  // of the streamed surface
        end(stroke);
        take([&] { return espSwapStroke(context, strokes[2]); });
        take([&] { return espSwapStroke(context, strokes[2]); });
        take([&] { return espSwapStroke(context, strokes.back()); });
        stroke = open("decay", ESP_BRUSH_PAINT, 2);
        const EspDab roof = {{12, 5, -4}, {0, 1, 0}, 1};
        take([&] { return espStrokeDabs(context, stroke, &roof, 1); });
        end(stroke);
        const std::vector<float> picture = {0, .2f, .4f, .6f};
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = other;
        def.name = "rust";
        def.texels = picture.data();
        def.space = ESP_LAYER_WALK_UV;
        def.width = def.height = 2;
        take([&] { return espSetLayer(context, &def); });
        take([&] { return espImportLayer(context, &def, &stroke); });
        strokes.push_back(stroke);
        grow();
    }
    void finish() {
        take([&] { return espFreezePlant(context, second, 1); });
        const float from[3] = {.9f, .12f, 1}, ahead[3] = {0, 0, -1};
        EspPlantHit hit{};
        take([&] { return espPickPlant(context, from, ahead, &hit); });
        take([&] { return espPruneBranch(context, hit.branch, 1); });
        const EspStroke wet = open("wet", ESP_BRUSH_PAINT, .2f), soft = open("mask", ESP_BRUSH_SMOOTH, .3f);
        dab(wet, .3f, .3f);
        dab(soft, .6f, .5f);
        grow();
        dab(wet, .4f, .3f);
        dab(soft, .7f, .55f);
        take([&] {
            esp::DrawDef def;
            def.width = 64, def.height = 36;
            def.camera = esp::frameAll(context);
            return espDraw(context, &def);
        });
        dab(wet, .5f, .3f);
        end(wet);
        end(soft);
        grow();
    }
    void all() {
        loadAll();
        plantAll();
        paintAll();
        finish();
    }

    std::vector<std::vector<float>> layers() {
        std::vector<std::vector<float>> all;
        for (const EspSurface of : {surface, other, hidden, far})
            for (const char* name : {"mask", "damp", "rust", "wet", "decay"}) {
                uint32_t side = 0;
                take([&] { return espReadLayer(context, of, name, nullptr, &side); });
                std::vector<float> texels(size_t(side) * side);
                take([&] { return espReadLayer(context, of, name, texels.data(), &side); });
                all.push_back(std::move(texels));
            }
        uint32_t side = 0;
        take([&] { return espReadTownLayer(context, "decay", nullptr, &side); });
        std::vector<float> texels(size_t(side) * side);
        take([&] { return espReadTownLayer(context, "decay", texels.data(), &side); });
        all.push_back(std::move(texels));
        return all;
    }
    Print print() {
        Print p;
        EspStats stats{};
        EspRoofStats town{};
        EspPatternStats pattern{};
        EspGraphStats boxes{};
        EspStreamingInfo streaming{};
        EspSeedDef at{};
        take([&] { return espReadStats(context, &stats); });
        take([&] { return espReadRoofStats(context, &town); });
        take([&] { return espPatternStats(context, &pattern); });
        take([&] { return espGraphStats(context, graph, &boxes); });
        take([&] { return espStreamingInfo(context, &streaming); });
        take([&] { return espSeedDef(context, second, &at); });
        p.plants = stats.hash, p.nodes = stats.nodes, p.roofs = town.hash, p.pattern = pattern.hash;
        p.seeds = espSeedCount(context);
        p.pruned = espPrunedCount(context);
        p.standing = streaming.standing;
        p.graphTriangles = uint32_t(boxes.triangles);
        EspParamInfo param{};
        take([&] { return espParamInfo(context, grammar, 0, &param); });
        p.reach = param.value[0];
        p.filled = espLayerFilled(context, "damp", &p.fill);
        p.layers = layers();
        return p;
    }
    // The last first, as far as they reach.
    void undoAll() {
        for (size_t i = strokes.size(); i-- > 0;) take([&] { return espSwapStroke(context, strokes[i]); });
        grow();
    }
};

}  // namespace recreated
