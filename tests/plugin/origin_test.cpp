// The world's origin moves: pictures, picks and growth are what they were, and nothing grows anew.
#include <doctest/doctest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace origins {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 200;
constexpr const char* kIvy =
    "context mask = 1\n"
    "Ivy -> Branch(6) {Stem(1.4), Stem(1.3), Stem(1.2), Stem(1.1), Stem(1), Stem(.9)}\n"
    "Stem(l) : arc >= l || mask(texCoord) < 0.3 -> NULL\n"
    "Stem(l) -> Marching(0.04, rand(-0.35, 0.35), true) {Stem(l), Wood Foliage}\n"
    "Wood -> S(0.02) Shape(\"bark\", C1)\n"
    "Foliage -> Repeat(3) {S(0.11) T(rand(), 0.04) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";
constexpr const char* kRings =
    "angles degrees\n"
    "field flow : tensor \"Direction\"\n"
    "Start -> A\n"
    "A -> [S(0.15) IC(\"torus\")] [T(0.15, 0, 0) A] [Rz(120) T(0.15, 0, 0) A] [Rz(-120) T(0.15, 0, 0) A]\n";

using Pixels = std::vector<uint8_t>;

// As espalier-compare: at most 5/255 apart on 99.9 % of the pixels.
bool alike(const Pixels& a, const Pixels& b) {
    size_t apart = 0;
    for (size_t i = 0; i < a.size(); i += 4) {
        int most = 0;
        for (size_t c = 0; c < 3; ++c) most = std::max(most, std::abs(int(a[i + c]) - int(b[i + c])));
        apart += most > 5;
    }
    CAPTURE(apart);
    CHECK(apart * 1000 <= a.size() / 4);
    return apart * 1000 <= a.size() / 4;
}

// Two squares that touch, with ivy over both, a pattern on a third, and a square that is streamed.
struct World {
    EspContext* context = nullptr;
    EspSurface left{}, right{}, third{}, far{};
    EspGrammar ivy{}, rings{};
    EspSeed seed{};
    int shadows = 1;
    double at[3] = {0, 0, 0};  // where the scene stands, seen from the origin

    World() {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = silent;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
    }
    ~World() { espDestroy(context); }
    World(const World&) = delete;

    EspSurface load(double x, double y, double z) {
        EspTransform place = espIdentity();
        place.rows[0][3] = float(at[0] + x), place.rows[1][3] = float(at[1] + y), place.rows[2][3] = float(at[2] + z);
        EspSurface surface{};
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &place, &surface) == ESP_OK);
        return surface;
    }
    EspSeed plant(EspGrammar grammar, double x, double y, uint32_t number) {
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = grammar;
        def.position[0] = float(at[0] + x), def.position[1] = float(at[1] + y), def.position[2] = float(at[2]);
        def.direction[1] = 1;
        def.number = number;
        EspSeed planted{};
        REQUIRE(espPlant(context, &def, &planted) == ESP_OK);
        return planted;
    }
    void make() {
        left = load(0, 0, 0);
        right = load(1, 0, 0);
        third = load(0, 1.5, 0);
        ivy = compiled(context, "ivy", kIvy);
        rings = compiled(context, "rings", kRings);
        seed = plant(ivy, .7, .1, 1);
        plant(ivy, .2, .1, 2);
        plant(ivy, 1.6, .1, 3);
        plant(rings, .5, 2, 4);
        paint(.3f, .7f);
        update();
    }
    void paint(float x, float y) {
        EspBrush brush = brushOn("mask", .15f);
        brush.strength = 1;
        brush.value = 0;
        stroke(context, brush, {{float(at[0]) + x, float(at[1]) + y, float(at[2])}, {0, 0, 1}, 1});
    }
    void update() { REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context)); }
    void shift(double x, double y, double z) {
        const double by[3] = {x, y, z};
        REQUIRE_MESSAGE(espShiftOrigin(context, by) == ESP_OK, espLastError(context));
        for (int k = 0; k < 3; ++k) at[k] -= by[k];
    }
    Pixels picture() {
        esp::DrawDef def;
        def.width = kWidth, def.height = kHeight;
        def.look.shadows = shadows;
        const double eye[3] = {1.2, 1.4, 4}, target[3] = {1, 1.2, 0};
        for (int k = 0; k < 3; ++k) {
            def.camera.eye[k] = float(at[k] + eye[k]);
            def.camera.target[k] = float(at[k] + target[k]);
        }
        REQUIRE_MESSAGE(espDraw(context, &def) == ESP_OK, espLastError(context));
        Pixels pixels(size_t(kWidth) * kHeight * 4);
        REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    }
    EspStats stats() {
        EspStats stats{};
        REQUIRE(espReadStats(context, &stats) == ESP_OK);
        return stats;
    }
    uint64_t patternHash(uint32_t* waves = nullptr) {
        EspPatternStats stats{};
        REQUIRE(espPatternStats(context, &stats) == ESP_OK);
        if (waves) *waves = stats.waves;
        return stats.hash;
    }
};

}  // namespace
}  // namespace origins

using origins::alike;
using origins::Pixels;
using origins::World;

TEST_CASE("a shift of the origin changes nothing but positions, and grows nothing") {
    World world;
    world.shadows = 0;  // whose map's texels lie otherwise then
    world.make();
    const Pixels before = world.picture();
    const EspStats grown = world.stats();
    REQUIRE(grown.leaves > 100);
    const uint64_t pattern = world.patternHash();
    EspSurfaceInfo info{}, moved{};
    EspSeedDef seed{}, seen{};
    REQUIRE(espSurfaceInfo(world.context, world.right, &info) == ESP_OK);
    REQUIRE(espSeedDef(world.context, world.seed, &seed) == ESP_OK);

    world.shift(16, -2.5, 8.25);
    world.update();
    CHECK(world.stats().expansions == grown.expansions);
    CHECK(world.stats().contactMs == grown.contactMs);  // they weren't looked for
    CHECK(alike(before, world.picture()));
    REQUIRE(espSurfaceInfo(world.context, world.right, &moved) == ESP_OK);
    REQUIRE(espSeedDef(world.context, world.seed, &seen) == ESP_OK);
    CHECK(moved.boundsMin[0] == doctest::Approx(info.boundsMin[0] - 16));
    CHECK(seen.position[1] == doctest::Approx(seed.position[1] + 2.5));
    const float from[3] = {float(world.at[0] + .7), float(world.at[1] + .12), float(world.at[2] + 1)},
                ahead[3] = {0, 0, -1};
    EspHit hit{};
    REQUIRE(espPick(world.context, from, ahead, &hit) == ESP_OK);
    CHECK(hit.surface.id == world.left.id);

    // What is painted and moved from here on lands where it would have.
    World twin;
    twin.shadows = 0;
    twin.make();
    for (World* one : {&world, &twin}) {
        one->paint(.8f, .4f);
        one->update();
    }
    CHECK(world.stats().hash == twin.stats().hash);
    CHECK(world.stats().derivedNodes < world.stats().nodes);
    CHECK(world.patternHash() == pattern);
    CHECK(alike(twin.picture(), world.picture()));
}

TEST_CASE("an origin that goes a thousand kilometres away and comes back finds all as it was") {
    World world;
    world.make();
    const Pixels before = world.picture();
    const EspStats grown = world.stats();
    world.shift(1e6 + .1, -333.3, 7e5);
    world.update();
    (void)world.picture();
    world.shift(-1e6 - .1, 333.3, -7e5);
    world.update();
    CHECK(alike(before, world.picture()));
    CHECK(world.stats().expansions == grown.expansions);
    CHECK(world.stats().hash == grown.hash);
    // Growth that reads nothing of the world is the same from both.
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = 4000;
    REQUIRE(espSetGrow(world.context, &grow) == ESP_OK);
    world.update();
    CHECK(world.stats().hash == grown.hash);
}

TEST_CASE("a scene a thousand kilometres away looks as at the origin, if the origin comes along") {
    // Tones of leaves depend on places of the world: there they are the same as at the first origin.
    const double period = 20 * 3.14159265358979323846 / 2.3, away = std::round(1e6 / period) * period;
    World here, there;
    here.make();
    // A streamed square stands there from the beginning, told from afar.
    EspTransform place = espIdentity();
    place.rows[0][3] = 1e6f, place.rows[1][3] = 7;
    EspSurfaceDef surface{};
    surface.structSize = sizeof surface;
    surface.name = ESPALIER_SQUARE;
    surface.place = &place;
    EspStreamedDef def{};
    def.structSize = sizeof def;
    def.surface = &surface;
    def.boundsMax[0] = def.boundsMax[1] = 1;
    REQUIRE(espAddStreamed(there.context, &def, &there.far) == ESP_OK);
    const auto standing = [&] {
        EspStreamingDef eye = esp::defaults<EspStreamingDef>();
        REQUIRE(espSetStreaming(there.context, &eye) == ESP_OK);
        EspStreamingInfo info{};
        for (int frame = 0; frame < 2000 && (frame < 3 || info.coming > 0); ++frame) {
            there.update();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            REQUIRE(espStreamingInfo(there.context, &info) == ESP_OK);
        }
        return info.standing;
    };
    REQUIRE(standing() == 0);
    for (int step = 0; step < 499; ++step) {  // a flight
        there.shift(2000, 0, 0);
        if (step % 100 == 0) there.update();
    }
    there.shift(away - 499 * 2000., 0, 0);
    REQUIRE(standing() == 1);
    EspSurfaceInfo info{};
    REQUIRE(espSurfaceInfo(there.context, there.far, &info) == ESP_OK);
    CHECK(info.boundsMin[0] == float(1e6 - away));
    REQUIRE(espDestroySurface(there.context, there.far) == ESP_OK);
    there.at[0] = 0;  // the scene is made where the origin is now
    there.make();
    CHECK(here.stats().hash == there.stats().hash);
    CHECK(alike(here.picture(), there.picture()));
}

TEST_CASE("an origin that can't move says why, and nothing has moved") {
    World world;
    world.make();
    const double by[3] = {10, 0, 0}, tooFar[3] = {0, 2e9, 0}, none[3] = {0, 0, NAN};
    CHECK(espShiftOrigin(world.context, nullptr) == ESP_INVALID_ARGUMENT);
    CHECK(espShiftOrigin(world.context, tooFar) == ESP_INVALID_ARGUMENT);
    CHECK(espShiftOrigin(world.context, none) == ESP_INVALID_ARGUMENT);
    load(world.context, compiled(world.context, "roofs", kDecaying),
         "{\"buildings\": [{\"id\": \"h\", \"outer\": [[10,0],[20,0],[20,8],[10,8]]}]}");
    EspSurfaceInfo before{}, after{};
    REQUIRE(espSurfaceInfo(world.context, world.left, &before) == ESP_OK);
    CHECK(espShiftOrigin(world.context, by) == ESP_INVALID_ARGUMENT);
    CHECK(std::strstr(espLastError(world.context), "town"));
    REQUIRE(espSurfaceInfo(world.context, world.left, &after) == ESP_OK);
    CHECK(before.boundsMin[0] == after.boundsMin[0]);
    REQUIRE(espRemoveTown(world.context) == ESP_OK);
    CHECK(espShiftOrigin(world.context, by) == ESP_OK);
}
