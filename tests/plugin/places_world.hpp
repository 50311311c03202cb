#pragma once

// Squares that touch, cross and stand alone, with ivy on all of them: loaded one by one, or places of one.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/grown_square.hpp"
#include "tests/plugin/town_host.hpp"

namespace espalier::places {

inline constexpr uint32_t kWidth = 320, kHeight = 200;

inline EspTransform placeAt(float x, float y, float z, float turn = 0, float scale = 1) {
    EspTransform place = espIdentity();
    place.rows[0][0] = place.rows[2][2] = scale * std::cos(turn);
    place.rows[0][2] = scale * std::sin(turn);
    place.rows[2][0] = -place.rows[0][2];
    place.rows[1][1] = scale;
    place.rows[0][3] = x, place.rows[1][3] = y, place.rows[2][3] = z;
    return place;
}

inline const std::vector<EspTransform> kPlaces{placeAt(0, 0, 0), placeAt(1, 0, 0), placeAt(.5f, 0, -.4f, 1.5707964f),
                                               placeAt(2.6f, 0, 0, .3f), placeAt(4, .2f, 0, -.4f, 1.5f)};

struct World {
    EspContext* context = nullptr;
    std::vector<EspSurface> squares;
    EspGrammar ivy{};

    explicit World(bool shares) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
        const EspGrammarDef text = esp::grammarDef("ivy", kSquaresIvy);
        REQUIRE(espCompileGrammar(context, &text, &ivy) == ESP_OK);
        for (const EspTransform& place : kPlaces) {
            EspSurface square{};
            const EspResult stands = shares && !squares.empty()
                                         ? espPlaceAgain(context, squares[squares.size() / 2], &place, &square)
                                         : espLoadSurface(context, ESPALIER_SQUARE, &place, &square);
            REQUIRE_MESSAGE(stands == ESP_OK, espLastError(context));
            squares.push_back(square);
            plant(place, uint32_t(squares.size()));
        }
        update();
    }
    ~World() { espDestroy(context); }
    World(const World&) = delete;

    void plant(const EspTransform& place, uint32_t number) {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = ivy;
        for (int k = 0; k < 3; ++k)
            def.position[k] = place.rows[k][0] * .7f + place.rows[k][1] * .1f + place.rows[k][3];
        def.direction[1] = 1;
        def.number = number;
        EspSeed planted{};
        REQUIRE_MESSAGE(espPlant(context, &def, &planted) == ESP_OK, espLastError(context));
    }
    void update() { REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context)); }
    EspStats stats() {
        EspStats stats{};
        stats.structSize = sizeof stats;
        REQUIRE(espReadStats(context, &stats) == ESP_OK);
        return stats;
    }
    std::vector<uint8_t> picture(EspView view = ESP_VIEW_SHADED) {
        esp::DrawDef def;
        def.width = kWidth, def.height = kHeight;
        def.look.view = view;
        const float eye[3] = {2.4f, 1.8f, 5}, target[3] = {2.4f, .5f, 0};
        for (int k = 0; k < 3; ++k) def.camera.eye[k] = eye[k], def.camera.target[k] = target[k];
        REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, espLastError(context));
        std::vector<uint8_t> pixels(size_t(kWidth) * kHeight * 4);
        REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    }
    void move(size_t which, const EspTransform& place) {
        REQUIRE_MESSAGE(espMoveSurface(context, squares[which], &place) == ESP_OK, espLastError(context));
        update();
    }
    void paint(size_t which, EspBrushMode mode) {
        EspBrush brush = brushOn("mask", .3f);
        brush.mode = mode;
        const EspTransform& at = kPlaces[which];
        EspDab dab{};
        for (int k = 0; k < 3; ++k) {
            dab.position[k] = .5f * (at.rows[k][0] + at.rows[k][1]) + at.rows[k][3];
            dab.normal[k] = at.rows[k][2];
        }
        dab.pressure = 1;
        stroke(context, brush, dab);
    }
    std::vector<float> layer(size_t which) {
        uint32_t size = 64;
        std::vector<float> texels(size_t(size) * size);
        REQUIRE(espReadLayer(context, squares[which], "mask", texels.data(), &size) == ESP_OK);
        return texels;
    }
};

}  // namespace espalier::places
