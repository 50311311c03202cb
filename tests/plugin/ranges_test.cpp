// Ranges that espalier.h names, with both of their ends.
#include <doctest/doctest.h>

#include <vector>

#include "tests/plugin/life.hpp"

using namespace espalier;

namespace {

std::vector<uint8_t> picture(EspContext* context, float fov) {
    EspDrawDef def = espDefaultDrawDef();
    def.width = 64;
    def.height = 36;
    def.camera = espFrameAll(context);
    def.camera.fovY = fov;
    std::vector<uint8_t> pixels(size_t(4) * def.width * def.height);
    REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, espLastError(context));
    REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
    return pixels;
}

}  // namespace

TEST_CASE("each field of view that is allowed shows a picture of its own") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    std::vector<uint8_t> before;
    for (const float fov : {.001f, .9f, 3.0f, 3.1f}) {
        CAPTURE(fov);
        const std::vector<uint8_t> shown = picture(life.context, fov);
        CHECK(shown != before);
        before = shown;
    }
}

TEST_CASE("brushes and surfaces of the least and largest sizes are taken") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    for (const float size : {1e-6f, 1e6f}) {
        CAPTURE(size);
        EspBrush brush = espDefaultBrush();
        brush.layer = "mask";
        brush.radius = size;
        EspStroke stroke{};
        REQUIRE(espBeginStroke(life.context, &brush, &stroke) == ESP_OK);
        REQUIRE(espDestroyStroke(life.context, stroke) == ESP_OK);
        for (const float factor : {1.f, size < 1 ? .5f : 2.f}) {
            const float scale = size * factor;
            const EspTransform place = {{{scale, 0, 0, 5}, {0, scale, 0, 0}, {0, 0, scale, 0}}};
            EspSurface surface{};
            const EspResult result = espLoadSurface(life.context, ESPALIER_SQUARE, &place, &surface);
            CHECK(result == (factor == 1 ? ESP_OK : ESP_INVALID_ARGUMENT));
            if (result == ESP_OK) CHECK(espDestroySurface(life.context, surface) == ESP_OK);
        }
    }
}
