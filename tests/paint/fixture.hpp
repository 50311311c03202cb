#pragma once

// A baked shape in a context, and its layers as the public interface gives them back.

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "runtime/surface/surface.hpp"
#include "shaders/shared/exact.h"
#include "tests/bake/small_models.hpp"

namespace espalier::test {

inline const char* kMaskedIvy =
    "context mask = 1\n"
    "param reach = 2 [0 .. 9]\n"
    "Ivy -> Branch(2) {Stem(reach), Stem(reach * 0.7)}\n"
    "Stem(l) : arc >= l -> NULL\n"
    "Stem(l) -> Marching(0.05, rand(-0.3, 0.3), mask(texCoord)) {Stem(l), Wood}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n";

// On the cube's side, and the direction up along it.
inline const glm::vec3 kFoot(1, -.8f, 0), kUp(0, 1, 0);

struct Painting {
    EspContext* context = nullptr;
    EspSurface surface{};
    SurfaceData data;
    std::string path;

    // The cube [-1, 1]³, a chart a face, by default.
    explicit Painting(const Model& model = cube(2), uint32_t resolution = 128) {
        BakeOptions options;
        options.resolution = resolution;
        auto baked = bake(model, options);
        REQUIRE(baked);
        static int number = 0;
        path = (std::filesystem::temp_directory_path() /
                ("espalier_paint_" + std::to_string(getpid()) + "_" + std::to_string(number++) + ".glb"))
                   .string();
        REQUIRE(writeSurface(baked->surface, path));
        auto read = readSurface(path);
        REQUIRE(read);
        data = std::move(*read);
        EspContextDef def = esp::defaults<EspContextDef>();
        def.validation = 1;
        if (espCreate(ESP_VERSION, &def, &context) != ESP_OK) FAIL(std::string(espLastError(nullptr)));
        ok(espLoadSurface(context, path.c_str(), nullptr, &surface));
    }
    ~Painting() {
        EspStats stats{};
        CHECK(espReadStats(context, &stats) == ESP_OK);
        CHECK(stats.validationMessages == 0);
        espDestroy(context);
        std::filesystem::remove(path);
    }
    Painting(const Painting&) = delete;
    Painting& operator=(const Painting&) = delete;

    void ok(EspResult result) const {
        if (result != ESP_OK) FAIL(result << ": " << std::string(espLastError(context)));
    }
    uint32_t size() const { return data.levels[0].size; }
    const Texel& texel(uint32_t x, uint32_t y) const { return data.levels[0].texels[texelIndex(size(), x, y)]; }
    const TexelAux& aux(uint32_t x, uint32_t y) const { return data.levels[0].aux[texelIndex(size(), x, y)]; }

    std::vector<float> layer(const char* name) const { return layer(name, surface); }
    // of: a surface from the same file
    std::vector<float> layer(const char* name, EspSurface of) const {
        uint32_t side = 0;
        ok(espReadLayer(context, of, name, nullptr, &side));
        REQUIRE(side == size());
        std::vector<float> texels(size_t(side) * side, -1);
        ok(espReadLayer(context, of, name, texels.data(), &side));
        return texels;
    }
    // The same shape once more, elsewhere.
    EspSurface another(const EspTransform& place) const {
        EspSurface second{};
        ok(espLoadSurface(context, path.c_str(), &place, &second));
        return second;
    }
    EspStroke begin(const EspBrush& brush) const {
        EspStroke stroke{};
        ok(espBeginStroke(context, &brush, &stroke));
        return stroke;
    }
    EspStroke stroke(const EspBrush& brush, const std::vector<EspDab>& dabs) const {
        const EspStroke stroke = begin(brush);
        ok(espStrokeDabs(context, stroke, dabs.data(), uint32_t(dabs.size())));
        ok(espEndStroke(context, stroke));
        return stroke;
    }
    // Returns what it has set.
    EspGrowDef growBy(bool shadersOnly) const {
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.shadersOnly = shadersOnly;
        ok(espSetGrow(context, &grow));
        return grow;
    }
    EspGrammar grammar(const char* text) const {
        EspGrammarDef def = esp::grammarDef("paint test", text);
        EspGrammar grammar{};
        ok(espCompileGrammar(context, &def, &grammar));
        return grammar;
    }
    EspSeed plant(EspGrammar grammar, glm::vec3 at, glm::vec3 direction, uint32_t number = 1) const {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = grammar;
        for (int i = 0; i < 3; ++i) {
            def.position[i] = at[i];
            def.direction[i] = direction[i];
        }
        def.number = number;
        EspSeed seed{};
        ok(espPlant(context, &def, &seed));
        return seed;
    }
    EspStats grown() const {
        ok(espUpdate(context));
        EspStats stats{};
        ok(espReadStats(context, &stats));
        return stats;
    }
    // Of what stands, which is what growing all anew gives.
    uint64_t hash() const {
        const uint64_t stands = grown().hash;
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.maxDepth = 100 + timesAnew++;
        ok(espSetGrow(context, &grow));
        CHECK(grown().hash == stands);
        return stands;
    }
    mutable uint32_t timesAnew = 0;
};

// The branch that the ray from one point towards another meets first.
inline EspResult pick(const Painting& painting, glm::vec3 from, glm::vec3 towards, EspPlantHit* hit) {
    const glm::vec3 way = towards - from;
    return espPickPlant(painting.context, &from.x, &way.x, hit);
}

inline EspTransform movedBy(glm::vec3 by) {
    EspTransform place = espIdentity();
    for (int i = 0; i < 3; ++i) place.rows[i][3] = by[i];
    return place;
}

inline EspBrush brushOn(const char* layer, float radius, float strength = 1, float hardness = 0) {
    EspBrush brush = esp::defaults<EspBrush>();
    brush.layer = layer;
    brush.radius = radius;
    brush.strength = strength;
    brush.hardness = hardness;
    return brush;
}

inline EspDab dabAt(glm::vec3 p, glm::vec3 n = {0, 1, 0}, float pressure = 1) {
    return {{p.x, p.y, p.z}, {n.x, n.y, n.z}, pressure};
}

inline glm::vec3 randomOnCube(std::mt19937& random) {
    std::uniform_real_distribution<float> unit(0, 1);
    const int face = int(random() % 6);
    const float s = unit(random);
    return onCube(face, s, unit(random));
}

}  // namespace espalier::test
