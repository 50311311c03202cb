// Ranges that the headers name, with both of their ends, and what lies far beyond.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"

using namespace espalier;

namespace {

std::vector<uint8_t> picture(EspContext* context, float fov) {
    esp::DrawDef def;
    def.width = 64;
    def.height = 36;
    def.camera = esp::frameAll(context);
    def.camera.fovY = fov;
    std::vector<uint8_t> pixels(size_t(4) * def.width * def.height);
    REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, espLastError(context));
    REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
    return pixels;
}

std::vector<float> mask(const Life& life) {
    uint32_t size = 0;
    if (espReadLayer(life.context, life.surface, "mask", nullptr, &size) != ESP_OK) return {};
    std::vector<float> texels(size_t(size) * size);
    REQUIRE(espReadLayer(life.context, life.surface, "mask", texels.data(), &size) == ESP_OK);
    return texels;
}

// A stroke of these dabs, ended.
EspStroke painted(const Life& life, const std::vector<EspDab>& dabs, bool together) {
    EspBrush brush = esp::defaults<EspBrush>();
    brush.layer = "mask";
    brush.radius = .05f;
    brush.strength = .4f;
    EspStroke stroke{};
    REQUIRE(espBeginStroke(life.context, &brush, &stroke) == ESP_OK);
    for (size_t i = 0; i < dabs.size(); i += together ? dabs.size() : 1)
        REQUIRE(espStrokeDabs(life.context, stroke, &dabs[i], together ? uint32_t(dabs.size()) : 1) == ESP_OK);
    REQUIRE(espEndStroke(life.context, stroke) == ESP_OK);
    return stroke;
}

}  // namespace

TEST_CASE("dabs that lie however far away paint nothing, and nothing is kept of them") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    const EspStroke near = painted(life, {{{.2f, .2f, 0}, {0, 0, 1}, 1}}, true);
    REQUIRE(espStrokeBytes(life.context, near) > 0);
    const std::vector<float> before = mask(life);
    for (const float far : {1e4f, 1e11f, 1e13f, 1.9e19f, 2.1e19f, 1e30f, 3.4e38f}) {
        CAPTURE(far);
        for (const EspDab& dab : {EspDab{{far, 0, 0}, {0, 0, 1}, 1}, EspDab{{far, -far, far}, {0, 0, 1}, 1}})
            CHECK(espStrokeBytes(life.context, painted(life, {dab}, true)) == 0);
        CHECK(mask(life) == before);
    }
    // A far one doesn't make more be kept of a near one that comes with it.
    const EspDab again{{-.2f, -.2f, 0}, {0, 0, 1}, 1};
    const uint64_t alone = espStrokeBytes(life.context, painted(life, {again}, true));
    const EspDab beside{{-.2f, .2f, 0}, {0, 0, 1}, 1};
    const EspStroke both = painted(life, {beside, {{1e11f, 0, 0}, {0, 0, 1}, 1}}, true);
    CHECK(espStrokeBytes(life.context, both) <= 2 * alone);
}

TEST_CASE("many dabs in one call paint what they do one by one") {
    FailingDevice device;
    Life one, all;
    REQUIRE((one.create(device) && one.load()));
    REQUIRE((all.create(device) && all.load()));
    std::vector<EspDab> dabs;
    for (uint32_t i = 0; i < 100; ++i)
        dabs.push_back({{.01f * float(i % 37), .9f - .008f * float(i), 0}, {0, 0, 1}, .01f * float(i % 100)});
    painted(one, dabs, false);
    const EspStroke together = painted(all, dabs, true);
    const std::vector<float> before = mask(all);
    CHECK(before == mask(one));
    REQUIRE(espSwapStroke(all.context, together) == ESP_OK);
    CHECK(mask(all) != before);
    REQUIRE(espSwapStroke(all.context, together) == ESP_OK);
    CHECK(mask(all) == before);
}

TEST_CASE("surfaces are moved by up to a billion metres, no further") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    for (const float far : {1e9f, 1.1e9f, 1e30f}) {
        CAPTURE(far);
        EspTransform place = espIdentity();
        place.rows[1][3] = -far;
        CHECK(espMoveSurface(life.context, life.surface, &place) == (far > 1e9f ? ESP_INVALID_ARGUMENT : ESP_OK));
    }
}

TEST_CASE("a ray's length doesn't matter to what it meets, and how far off") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load() && life.compile() && life.plant(1) && life.update()));
    const float origin[3] = {.1f, .02f, 2};
    EspPlantHit first{};
    for (const float length : {1.f, 1e-36f, 1e-20f, 1e20f, 3e38f}) {
        CAPTURE(length);
        const float direction[3] = {0, 0, -length};
        EspHit hit{};
        REQUIRE(espPick(life.context, origin, direction, &hit) == ESP_OK);
        CHECK(hit.distance == doctest::Approx(2).epsilon(1e-4));
        EspPlantHit plant{};
        REQUIRE(espPickPlant(life.context, origin, direction, &plant) == ESP_OK);
        if (length == 1) first = plant;
        CHECK(plant.branch == first.branch);
        CHECK(plant.distance == first.distance);
    }
}

TEST_CASE("plants are picked where their surface stands, at once") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load() && life.compile() && life.plant(1) && life.update()));
    const float origin[3] = {.1f, .02f, 2}, moved[3] = {5.1f, .02f, 2}, direction[3] = {0, 0, -1};
    EspPlantHit before{}, after{};
    REQUIRE(espPickPlant(life.context, origin, direction, &before) == ESP_OK);
    EspTransform place = espIdentity();
    place.rows[0][3] = 5;
    REQUIRE(espMoveSurface(life.context, life.surface, &place) == ESP_OK);
    CHECK(espPickPlant(life.context, origin, direction, &after) != ESP_OK);
    REQUIRE(espPickPlant(life.context, moved, direction, &after) == ESP_OK);
    CHECK(after.branch == before.branch);
    CHECK(after.distance == doctest::Approx(before.distance).epsilon(1e-4));
}

TEST_CASE("a call without a context says so, whatever the last one said") {
    EspContext* context = nullptr;
    CHECK(espCreate(ESP_VERSION, nullptr, nullptr) == ESP_INVALID_ARGUMENT);
    const std::string before = espLastError(nullptr);
    CHECK(espUpdate(context) == ESP_INVALID_ARGUMENT);
    CHECK(espLastError(nullptr) != before);
    CHECK(std::string(espLastError(nullptr)).find("context") != std::string::npos);
}

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
        EspBrush brush = esp::defaults<EspBrush>();
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
