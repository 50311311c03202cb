// One surface at many places: the same as if it had been loaded for each, for the memory of one.
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "tests/plugin/places_world.hpp"

namespace espalier::places {
namespace {

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

}  // namespace espalier::places
