// One surface at many places: the same as if it had been loaded for each, for the memory of one.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/glm.hpp>
#include <iterator>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/grown_square.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace places {
namespace {

constexpr uint32_t kWidth = 320, kHeight = 200;

EspTransform placeAt(float x, float y, float z, float turn = 0, float scale = 1) {
    EspTransform place = espIdentity();
    place.rows[0][0] = place.rows[2][2] = scale * std::cos(turn);
    place.rows[0][2] = scale * std::sin(turn);
    place.rows[2][0] = -place.rows[0][2];
    place.rows[1][1] = scale;
    place.rows[0][3] = x, place.rows[1][3] = y, place.rows[2][3] = z;
    return place;
}

// Squares that touch, cross, and stand alone, with ivy on all of them.
const std::vector<EspTransform> kPlaces{placeAt(0, 0, 0), placeAt(1, 0, 0), placeAt(.5f, 0, -.4f, 1.5707964f),
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

void same(World& shared, World& apart) {
    const EspStats a = shared.stats(), b = apart.stats();
    CHECK(a.leaves > 0);
    CHECK(a.hash == b.hash);
    CHECK(a.nodes == b.nodes);
    CHECK(a.contacts == b.contacts);
    CHECK(shared.picture() == apart.picture());
}

}  // namespace

TEST_CASE("a surface at many places grows as if it had been loaded for each") {
    World shared(true), apart(false);
    CHECK(shared.stats().contacts > 0);
    same(shared, apart);
    CHECK(shared.picture(ESP_VIEW_CHARTS) == apart.picture(ESP_VIEW_CHARTS));  // shows what others bury
    for (size_t i = 0; i < kPlaces.size(); ++i) {
        uint32_t size = 64;
        std::vector<uint32_t> charts[2] = {std::vector<uint32_t>(4096), std::vector<uint32_t>(4096)};
        REQUIRE(espReadAtlas(shared.context, shared.squares[i], 0, charts[0].data(), &size) == ESP_OK);
        REQUIRE(espReadAtlas(apart.context, apart.squares[i], 0, charts[1].data(), &size) == ESP_OK);
        CHECK(charts[0] == charts[1]);
    }
    // What touches changes, comes and goes.
    for (World* world : {&shared, &apart}) world->move(2, placeAt(1.5f, 0, -.3f, 1.5707964f));
    same(shared, apart);
    for (World* world : {&shared, &apart}) world->move(2, placeAt(8, 0, 0));
    same(shared, apart);
    for (World* world : {&shared, &apart}) world->move(3, placeAt(1.4f, .1f, -.4f, 1.2f));
    same(shared, apart);
    // The first one goes, and the others stay.
    for (World* world : {&shared, &apart}) {
        REQUIRE(espDestroySurface(world->context, world->squares[0]) == ESP_OK);
        world->update();
    }
    same(shared, apart);
}

TEST_CASE("places have layers of their own") {
    World shared(true), apart(false);
    for (World* world : {&shared, &apart}) {
        world->paint(0, ESP_BRUSH_PAINT);
        world->paint(1, ESP_BRUSH_PAINT);
        world->paint(1, ESP_BRUSH_SMOOTH);
        world->paint(2, ESP_BRUSH_PAINT);
        world->paint(2, ESP_BRUSH_SMOOTH);
        world->update();
    }
    CHECK(shared.layer(0) != shared.layer(1));
    for (size_t i = 0; i < 3; ++i) CHECK(shared.layer(i) == apart.layer(i));
    same(shared, apart);
}

TEST_CASE("places cost what touches them, and no more") {
    World world(true);
    const EspTransform far = placeAt(100, 0, 0);
    const uint64_t before = world.stats().surfaceBytes, whole = world.stats().totalBytes;
    EspSurface surface{};
    for (int i = 0; i < 500; ++i) {
        const EspTransform place = placeAt(100 + 3 * float(i % 25), 0, 3 * float(i / 25), .1f * float(i));
        REQUIRE_MESSAGE(espPlaceAgain(world.context, world.squares[0], &place, &surface) == ESP_OK,
                        espLastError(world.context));
    }
    world.update();
    CHECK(world.stats().surfaceBytes == before);
    World alone(false);
    REQUIRE(espLoadSurface(alone.context, ESPALIER_SQUARE, &far, &surface) == ESP_OK);
    alone.update();
    const uint64_t loaded = alone.stats().surfaceBytes;
    REQUIRE(espDestroySurface(alone.context, surface) == ESP_OK);
    alone.update();
    const uint64_t each = loaded - alone.stats().surfaceBytes;
    CHECK(each > 100'000);
    // A record of each in the tables of surfaces and of layers, and no mesh.
    CHECK(world.stats().totalBytes - whole < 500 * each / 20);
    for (World* some : {&world, &alone}) (void)some->picture();
}

TEST_CASE("places whose boxes meet cost nothing where they don't touch") {
    World world(true);
    const uint64_t before = world.stats().surfaceBytes;
    // Aslant, so that their boxes meet.
    EspSurface surface{};
    for (int i = 0; i < 2; ++i) {
        const EspTransform place = placeAt(50 + .3f * float(i), 0, .3f * float(i), .7f);
        REQUIRE(espPlaceAgain(world.context, world.squares[0], &place, &surface) == ESP_OK);
    }
    const uint32_t contacts = world.stats().contacts;
    world.update();
    CHECK(world.stats().contacts == contacts);
    CHECK(world.stats().surfaceBytes == before);
}

TEST_CASE("a lost device gives back what places share") {
    World shared(true);
    shared.paint(1, ESP_BRUSH_PAINT);
    shared.update();
    REQUIRE(espHideSurface(shared.context, shared.squares[3], 1) == ESP_OK);
    const EspStats before = shared.stats();
    const std::vector<uint8_t> picture = shared.picture();
    REQUIRE_MESSAGE(espRecreate(shared.context, nullptr) == ESP_OK, espLastError(shared.context));
    shared.update();
    CHECK(shared.stats().hash == before.hash);
    CHECK(shared.stats().surfaceBytes == before.surfaceBytes);
    CHECK(shared.picture() == picture);
}

TEST_CASE("places that can't be are refused") {
    World world(true);
    EspSurface none{}, out{};
    const EspTransform fine = placeAt(9, 0, 0);
    CHECK(espPlaceAgain(world.context, none, &fine, &out) == ESP_INVALID_ARGUMENT);
    CHECK(espPlaceAgain(world.context, world.squares[0], nullptr, &out) == ESP_INVALID_ARGUMENT);
    CHECK(espPlaceAgain(world.context, world.squares[0], &fine, nullptr) == ESP_INVALID_ARGUMENT);
    EspTransform bad = fine;
    bad.rows[1][1] = 2;
    CHECK(espPlaceAgain(world.context, world.squares[0], &bad, &out) == ESP_INVALID_ARGUMENT);
    CHECK(std::strstr(espLastError(world.context), "espPlaceAgain: the transform"));
    bad.rows[1][1] = NAN;
    CHECK(espPlaceAgain(world.context, world.squares[0], &bad, &out) == ESP_INVALID_ARGUMENT);
    REQUIRE(espDestroySurface(world.context, world.squares[0]) == ESP_OK);
    CHECK(espPlaceAgain(world.context, world.squares[0], &fine, &out) == ESP_INVALID_ARGUMENT);
}

namespace {

struct Corner {
    glm::vec3 position, normal;
};
glm::vec3 octahedral(float x, float y) {
    glm::vec3 n(x, y, 1 - std::abs(x) - std::abs(y));
    if (n.z < 0) {
        n.x = (1 - std::abs(y)) * (x < 0 ? -1.f : 1.f);
        n.y = (1 - std::abs(x)) * (y < 0 ? -1.f : 1.f);
    }
    return glm::normalize(n);
}

// Two squares that meet at an edge, bent by an angle, with a plant that climbs over it from the first one.
struct Bent {
    EspContext* context = nullptr;
    EspSeed seed{};

    // other: the second square is a mirrored one, which fills the same place.
    Bent(float angle, bool other, const char* rules) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
        EspTransform first = espIdentity(), second = espIdentity();
        second.rows[0][0] = second.rows[2][2] = std::cos(angle);
        second.rows[0][2] = std::sin(angle);
        second.rows[2][0] = -second.rows[0][2];
        second.rows[0][3] = 1;
        if (other) {
            // From its far edge back.
            for (auto& row : second.rows) row[3] += row[0], row[0] = -row[0];
        }
        EspSurface surface{};
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &first, &surface) == ESP_OK);
        REQUIRE_MESSAGE(espPlaceAgain(context, surface, &second, &surface) == ESP_OK, espLastError(context));
        const EspGrammarDef text = esp::grammarDef("ivy", rules);
        EspSeedDef plant = esp::defaults<EspSeedDef>();
        REQUIRE_MESSAGE(espCompileGrammar(context, &text, &plant.grammar) == ESP_OK, espLastError(context));
        plant.position[0] = .5f, plant.position[1] = .3f;
        plant.direction[0] = 1, plant.direction[1] = .2f;
        plant.number = 3;
        REQUIRE_MESSAGE(espPlant(context, &plant, &seed) == ESP_OK, espLastError(context));
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    }
    ~Bent() { espDestroy(context); }
    Bent(const Bent&) = delete;

    // Vertices of all that has grown, by their places in the list.
    std::vector<Corner> corners() {
        EspTriangles triangles{};
        triangles.structSize = sizeof triangles;
        REQUIRE_MESSAGE(espMaterialise(context, &triangles) == ESP_OK, espLastError(context));
        std::vector<Corner> out(triangles.vertexCount);
        for (size_t i = 0; i < out.size(); ++i) {
            const std::byte* from = static_cast<const std::byte*>(triangles.vertices) + 16 * i;
            int16_t packed[2];
            std::memcpy(&out[i].position, from, 12);
            std::memcpy(packed, from + 12, 4);
            out[i].normal = octahedral(float(packed[0]) / 32767, float(packed[1]) / 32767);
        }
        return out;
    }
};

// Stems that go straight on, without leaves: turns and leaves to the left are those that the surface itself sees.
constexpr const char* kStems =
    "Ivy -> Stem(.9)\n"
    "Stem(l) : arc >= l -> NULL\n"
    "Stem(l) -> Marching(0.04, 0, true) {Stem(l), Wood}\n"
    "Wood -> S(0.02) Shape(\"bark\", C1)\n";

}  // namespace

TEST_CASE("a plant climbs over to a mirrored surface as over to any other") {
    for (const float angle : {0.f, .7f, 1.4f, -.9f, -2.f}) {
        CAPTURE(angle);
        Bent straight(angle, false, kStems), mirror(angle, true, kStems);
        const std::vector<Corner> a = straight.corners(), b = mirror.corners();
        REQUIRE(a.size() == b.size());
        REQUIRE(a.size() > 500);
        bool beyond = false;
        float apart = 0, turned = 0;
        // They come in any order.
        for (const Corner& from : a) {
            const auto unlike = [&](const Corner& to) {
                return glm::distance(from.position, to.position) + .01f * glm::distance(from.normal, to.normal);
            };
            const Corner& to = *std::ranges::min_element(b, {}, unlike);
            apart = std::max(apart, glm::distance(from.position, to.position));
            turned = std::max(turned, glm::distance(from.normal, to.normal));
            beyond = beyond || from.position.x > 1.1f || std::abs(from.position.z) > .1f;
        }
        CHECK(beyond);
        CHECK(apart < 1e-3f);  // a contact lies a fiftieth of a texel within each border
        CHECK(turned < .05f);
    }
}

TEST_CASE("a mirrored surface touches what is near it as any other does") {
    // Squares beside another one: turned into it from a hair before it on, or straight up from there.
    for (const float angle : {.02f, .37f, 1.1f, -1.5707964f}) {
        CAPTURE(angle);
        uint32_t contacts[2];
        for (const bool other : {false, true}) {
            EspContextDef def = esp::defaults<EspContextDef>();
            def.log = quiet;
            EspContext* context = nullptr;
            REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
            EspTransform floor = espIdentity(), wall = placeAt(.23f, .17f, .0005f, angle);
            // About its diagonal, so that its two triangles fill the same places.
            if (other)
                for (auto& row : wall.rows) std::swap(row[0], row[1]);
            EspSurface surface{};
            REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &floor, &surface) == ESP_OK);
            REQUIRE(espPlaceAgain(context, surface, &wall, &surface) == ESP_OK);
            REQUIRE(espUpdate(context) == ESP_OK);
            EspStats stats{};
            stats.structSize = sizeof stats;
            REQUIRE(espReadStats(context, &stats) == ESP_OK);
            contacts[other] = stats.contacts;
            espDestroy(context);
        }
        CHECK(contacts[0] > 0);
        CHECK(contacts[0] == contacts[1]);
    }
}

TEST_CASE("bark goes straight on where a stem climbs over to another surface") {
    // The plant's line, less half of the bark, which is buried.
    const glm::vec3 origin(.5f, .3f, .0045f), along = glm::normalize(glm::vec3(1, .2f, 0));
    for (const bool mirror : {false, true}) {
        Bent flat(0, mirror, kStems);
        float farthest = 0;
        for (const Corner& corner : flat.corners()) {
            const glm::vec3 off = corner.position - origin;
            farthest = std::max(farthest, glm::length(off - along * glm::dot(off, along)));
        }
        CHECK(farthest > .0099f);
        CHECK(farthest < .0103f);  // its radius, and what a contact's place differs by
    }
}

TEST_CASE("what is mirrored as a whole grows as it did, mirrored") {
    World straight(false);
    const EspStats before = straight.stats();
    std::vector<uint8_t> picture = straight.picture();
    // Each square, each seed.
    for (size_t i = 0; i < kPlaces.size(); ++i) {
        EspTransform place = kPlaces[i];
        for (float& x : place.rows[0]) x = -x;
        REQUIRE_MESSAGE(espMoveSurface(straight.context, straight.squares[i], &place) == ESP_OK,
                        espLastError(straight.context));
    }
    straight.update();
    CHECK(straight.stats().hash == before.hash);
    CHECK(straight.stats().contacts == before.contacts);
    // Back again.
    for (size_t i = 0; i < kPlaces.size(); ++i)
        REQUIRE(espMoveSurface(straight.context, straight.squares[i], &kPlaces[i]) == ESP_OK);
    straight.update();
    CHECK(straight.stats().hash == before.hash);
    CHECK(straight.picture() == picture);
}

TEST_CASE("a mirrored surface is lit as what fills the same place") {
    EspContextDef def = esp::defaults<EspContextDef>();
    def.log = quiet;
    std::vector<uint8_t> pictures[2];
    for (int other = 0; other < 2; ++other) {
        EspContext* context = nullptr;
        REQUIRE(espCreate(ESP_VERSION, &def, &context) == ESP_OK);
        EspTransform place = placeAt(0, 0, 0, .4f);
        if (other)
            for (auto& row : place.rows) row[3] += row[0], row[0] = -row[0];
        EspSurface surface{};
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, &place, &surface) == ESP_OK);
        REQUIRE(espUpdate(context) == ESP_OK);
        for (const float side : {1.f, -1.f}) {  // its back, too
            esp::DrawDef draw;
            draw.width = kWidth, draw.height = kHeight;
            draw.camera.eye[0] = .5f, draw.camera.eye[1] = .9f, draw.camera.eye[2] = 2 * side;
            draw.camera.target[0] = .5f, draw.camera.target[1] = .5f;
            REQUIRE_MESSAGE(espDraw(context, &draw) == ESP_OK, espLastError(context));
            std::vector<uint8_t> pixels(size_t(kWidth) * kHeight * 4);
            REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
            pictures[other].insert(pictures[other].end(), pixels.begin(), pixels.end());
        }
        espDestroy(context);
    }
    size_t apart = 0;
    for (size_t i = 0; i < pictures[0].size(); ++i) apart += std::abs(int(pictures[0][i]) - int(pictures[1][i])) > 3;
    CHECK(apart * 1000 < pictures[0].size());
}

namespace {

// Tells how often the square is read.
struct Reads {
    int count = 0;
    std::vector<char> last;
    static EspResult read(void* user, const char* path, const void** bytes, size_t* size) {
        Reads& reads = *static_cast<Reads*>(user);
        const bool square = std::strcmp(path, ESPALIER_SQUARE) == 0;
        reads.count += square;
        const std::filesystem::path name = std::filesystem::path(path).filename();
        std::ifstream file(square ? std::filesystem::path(path) : ESPALIER_CONTENT / name, std::ios::binary);
        reads.last.assign(std::istreambuf_iterator<char>(file), {});
        *bytes = reads.last.data();
        *size = reads.last.size();
        return reads.last.empty() ? ESP_IO_FAILED : ESP_OK;
    }
    static void release(void*, const void*, size_t) {}
};

}  // namespace

TEST_CASE("streamed places of one file are read once and take the budget of one") {
    Reads reads;
    EspContextDef def = esp::defaults<EspContextDef>();
    def.log = quiet;
    EspFiles files{};
    files.structSize = sizeof files;
    files.read = Reads::read;
    files.release = Reads::release;
    files.user = &reads;
    def.files = &files;
    EspContext* context = nullptr;
    REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, std::string(espLastError(nullptr)));
    constexpr int kMany = 300;
    std::vector<EspSurface> squares(kMany);
    for (int i = 0; i < kMany; ++i) {
        const EspTransform place = placeAt(2 * float(i % 20), 0, 2 * float(i / 20));
        EspSurfaceDef surface{};
        surface.structSize = sizeof surface;
        surface.name = ESPALIER_SQUARE;
        surface.place = &place;
        EspStreamedDef streamed{};
        streamed.structSize = sizeof streamed;
        streamed.surface = &surface;
        streamed.boundsMax[0] = streamed.boundsMax[1] = 1;
        REQUIRE(espAddStreamed(context, &streamed, &squares[size_t(i)]) == ESP_OK);
    }
    EspStreamingDef streaming = esp::defaults<EspStreamingDef>();
    streaming.eye[1] = 2;
    streaming.leastSize = 1e-3f;
    const auto info = [&] {
        EspStreamingInfo all{};
        all.structSize = sizeof all;
        REQUIRE(espStreamingInfo(context, &all) == ESP_OK);
        return all;
    };
    const auto settle = [&](uint64_t budget) {
        streaming.deviceBytes = budget;
        REQUIRE(espSetStreaming(context, &streaming) == ESP_OK);
        // What shares a file comes in the update after the one in which this stands.
        for (int i = 0, quietFrames = 0; i < 20'000 && quietFrames < 3; ++i) {
            quietFrames = info().coming > 0 ? 0 : quietFrames + 1;
            REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
            CHECK(info().deviceBytes <= budget);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    };
    settle(1ull << 30);
    CHECK(info().standing == kMany);
    const uint64_t one = info().deviceBytes;
    CHECK(one > 0);
    CHECK(reads.count == 1);
    settle(one);
    CHECK(info().standing == kMany);
    settle(one - 1);
    CHECK(info().standing == 0);
    settle(one);
    CHECK(info().standing == kMany);
    CHECK(reads.count == 2);
    // One of them goes for good, even that which was read.
    REQUIRE(espDestroySurface(context, squares[0]) == ESP_OK);
    settle(one);
    CHECK(info().standing == kMany - 1);
    espDestroy(context);
}

}  // namespace places
