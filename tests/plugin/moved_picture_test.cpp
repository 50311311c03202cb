// Pictures after surfaces have moved, come and gone: those that binding everything anew gives, to the bit, while only
// what stands on the moved ones is bound.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "runtime/plugin/context.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace {

EspTransform placedAt(float x, float y, float turn = 0, float z = 0) {
    EspTransform place = espIdentity();
    place.rows[0][0] = place.rows[2][2] = std::cos(turn);
    place.rows[0][2] = std::sin(turn);
    place.rows[2][0] = -std::sin(turn);
    place.rows[0][3] = x;
    place.rows[1][3] = y;
    place.rows[2][3] = z;
    return place;
}

// Ivy on a square, much of it, beside it ivy on another one, and some on two that lie around what moves.
struct Squares : Bare {
    EspSurface stays{}, moves{};
    EspGrammar grammar{};
    bool shadows = true;

    Squares() {
        stays = loaded(0, 0);
        moves = loaded(1.6f, 0);
        grammar = compiled(context, "ivy", kLifeIvy);
        for (int i = 0; i < 12; ++i) plant(.05f + .075f * float(i));
        plant(1.9f);
        plant(2.1f);
        loaded(4, 2, -1);
        plant(4.5f, 2.3f, -1);
        loaded(4, -2, 1);
        plant(4.5f, -1.7f, 1);
        update();
    }
    EspSurface loaded(float x, float y, float z = 0) {
        EspSurface surface{};
        const EspTransform place = placedAt(x, y, 0, z);
        REQUIRE_MESSAGE(espLoadSurface(context, ESPALIER_SQUARE, &place, &surface) == ESP_OK, espLastError(context));
        return surface;
    }
    EspSeed plant(float x, float y = .3f, float z = 0) {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = grammar;
        def.position[0] = x;
        def.position[1] = y;
        def.position[2] = z;
        def.direction[1] = 1;
        EspSeed seed{};
        REQUIRE_MESSAGE(espPlant(context, &def, &seed) == ESP_OK, espLastError(context));
        return seed;
    }
    void update() { REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context)); }
    void move(const EspTransform& to) { REQUIRE(espMoveSurface(context, moves, &to) == ESP_OK); }

    std::vector<uint8_t> draw() {
        EspLook look = esp::defaults<EspLook>();
        look.shadows = shadows;
        EspCamera camera = esp::defaults<EspCamera>();
        EspDrawDef def = esp::defaults<EspDrawDef>();
        def.width = 240;
        def.height = 120;
        def.look = &look;
        def.camera = &camera;
        const float eye[3] = {1.3f, .5f, 3}, target[3] = {1.3f, .5f, 0};
        std::copy_n(eye, 3, camera.eye);
        std::copy_n(target, 3, camera.target);
        REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, espLastError(context));
        std::vector<uint8_t> pixels(size_t(def.width) * def.height * 4);
        REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    }
    uint32_t items() const {
        const GrowthView view = context->growth->view();
        return view.nodeCount + view.leafCount;
    }
    uint32_t bound() const {
        context->device->collect();
        return context->renderer->stats().emit.bound;
    }
    // The picture now, which is that for which all is bound anew.
    std::vector<uint8_t> compared(uint32_t& boundFor) {
        std::vector<uint8_t> picture = draw();
        boundFor = bound();
        REQUIRE(espDropFrame(context) == ESP_OK);
        CHECK(draw() == picture);
        CHECK(bound() == items());
        return picture;
    }
};

}  // namespace

TEST_CASE("after a move a picture is what it would be if all were bound anew, and only what moved is") {
    Squares scene;
    REQUIRE(scene.items() > 500);
    uint32_t bound = 0;
    std::vector<uint8_t> before = scene.draw();
    for (int step = 1; step < 6; ++step) {
        CAPTURE(step);
        scene.move(placedAt(1.6f + .04f * float(step), .02f * float(step), step > 3 ? .1f * float(step) : 0));
        if (step != 2) scene.update();  // a picture before the update shows the move, too
        const std::vector<uint8_t> picture = scene.compared(bound);
        CHECK(bound > 0);
        CHECK(bound < scene.items() / 2);
        CHECK(picture != before);
        before = picture;
    }
}

TEST_CASE("surfaces that come and go elsewhere bind nothing anew") {
    Squares scene;
    scene.shadows = false;  // which are coarser in a larger scene
    uint32_t bound = 0;
    scene.draw();
    scene.move(placedAt(1.7f, 0));
    scene.update();
    const std::vector<uint8_t> before = scene.draw();
    const uint32_t few = scene.bound();  // and so it stays as long as nothing is bound
    REQUIRE(few < scene.items() / 2);
    for (int round = 0; round < 3; ++round) {
        CAPTURE(round);
        const EspSurface far = scene.loaded(300 + 20.0f * float(round), -100);
        if (round > 0) scene.update();
        CHECK(scene.draw() == before);
        CHECK(scene.bound() == few);
        REQUIRE(espDestroySurface(scene.context, far) == ESP_OK);
        if (round > 1) scene.update();
        CHECK(scene.draw() == before);
        CHECK(scene.bound() == few);
    }
    CHECK(scene.compared(bound) == before);
}

TEST_CASE("plants that come to a surface that had none, and frozen ones, go with it") {
    Squares scene;
    uint32_t bound = 0;
    const EspSurface third = scene.loaded(.8f, -1.3f);
    scene.update();
    scene.draw();
    const EspSeed frozen = scene.plant(2);
    scene.update();
    REQUIRE(espFreezePlant(scene.context, frozen, 1) == ESP_OK);
    scene.plant(1.2f, -1);
    scene.update();
    scene.compared(bound);
    for (int step = 0; step < 3; ++step) {
        CAPTURE(step);
        const EspTransform to = placedAt(.85f + .05f * float(step), -1.2f);
        REQUIRE(espMoveSurface(scene.context, third, &to) == ESP_OK);
        if (step == 1) scene.move(placedAt(1.65f, .1f));
        scene.update();
        scene.compared(bound);
        CHECK(bound > 0);
        CHECK(bound < scene.items() / 2);
    }
    // What is gone is drawn where it grew until the next update.
    REQUIRE(espDestroySurface(scene.context, third) == ESP_OK);
    scene.compared(bound);
    scene.update();
    scene.compared(bound);
}
