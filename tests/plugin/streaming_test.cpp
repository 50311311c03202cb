// A world that is larger than its budget.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/grown_square.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;

namespace streaming {
namespace {

constexpr int kSquares = 20;
constexpr float kApart = 4;

// Squares in a row along x, each a metre wide and of a file of its own, of which the budget holds five.
struct World {
    test::ScratchFolder folder;
    EspContext* context = nullptr;
    std::vector<EspSurface> squares;
    uint64_t budget = 0, each = 0;

    World() {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
        for (int i = 0; i < kSquares; ++i) {
            const std::string file = folder.file("square " + std::to_string(i) + ".glb");
            std::filesystem::copy_file(ESPALIER_SQUARE, file);
            squares.push_back(add(file.c_str(), kApart * float(i)));
        }
        look(0, 1ull << 30);
        settle();
        each = info(squares[0]).bytes;
        REQUIRE(each > 0);
        budget = 5 * each + each / 2;
    }
    ~World() { espDestroy(context); }
    World(const World&) = delete;

    EspSurface add(const char* file, float x) {
        EspTransform place = espIdentity();
        place.rows[0][3] = x;
        EspSurfaceDef surface{};
        surface.structSize = sizeof surface;
        surface.name = file;
        surface.place = &place;
        EspStreamedDef def{};
        def.structSize = sizeof def;
        def.surface = &surface;
        def.boundsMax[0] = def.boundsMax[1] = 1;
        EspSurface out{};
        REQUIRE_MESSAGE(espAddStreamed(context, &def, &out) == ESP_OK, espLastError(context));
        return out;
    }
    void look(float x, uint64_t bytes) {
        EspStreamingDef def = esp::defaults<EspStreamingDef>();
        def.eye[0] = x + .5f, def.eye[1] = .5f, def.eye[2] = 1;
        def.leastSize = 1e-3f;
        def.deviceBytes = bytes;
        REQUIRE(espSetStreaming(context, &def) == ESP_OK);
    }
    EspStreamedInfo info(EspSurface surface) const {
        EspStreamedInfo info{};
        info.structSize = sizeof info;
        REQUIRE(espStreamedInfo(context, surface, &info) == ESP_OK);
        return info;
    }
    EspStreamingInfo all() const {
        EspStreamingInfo info{};
        info.structSize = sizeof info;
        REQUIRE(espStreamingInfo(context, &info) == ESP_OK);
        return info;
    }
    EspStats stats() const {
        EspStats stats{};
        stats.structSize = sizeof stats;
        REQUIRE(espReadStats(context, &stats) == ESP_OK);
        return stats;
    }
    void frame() {
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    // Until nothing comes any more.
    void settle() {
        for (int quietFrames = 0, frames = 0; quietFrames < 3 && frames < 20'000; ++frames) {
            frame();
            quietFrames = all().coming == 0 ? quietFrames + 1 : 0;
        }
    }
    bool stands(int i) const { return info(squares[size_t(i)]).state == ESP_STREAMED_STANDS; }
    int standing() const {
        int count = 0;
        for (int i = 0; i < kSquares; ++i) count += stands(i);
        return count;
    }
    EspSeed plant(const EspGrammar& grammar, int i) {
        EspSeedDef seed = esp::defaults<EspSeedDef>();
        seed.grammar = grammar;
        seed.position[0] = kApart * float(i) + .5f;
        seed.direction[1] = 1;
        seed.number = uint32_t(i);
        EspSeed planted{};
        REQUIRE_MESSAGE(espPlant(context, &seed, &planted) == ESP_OK, espLastError(context));
        return planted;
    }
    EspGrammar ivy() {
        const EspGrammarDef text = esp::grammarDef("ivy", kSquaresIvy);
        EspGrammar grammar{};
        REQUIRE(espCompileGrammar(context, &text, &grammar) == ESP_OK);
        return grammar;
    }
};

}  // namespace

TEST_CASE("surfaces come by need and stay within the budget") {
    World world;
    CHECK(world.standing() == kSquares);  // there was room for all
    std::vector<int> before;
    for (int flight = 0; flight < 2; ++flight) {
        for (float x = 0; x <= kApart * (kSquares - 1); x += .5f) {
            world.look(x, world.budget);
            world.frame();
            CHECK(world.all().deviceBytes <= world.budget);
        }
        world.settle();
        CHECK(world.standing() == 5);
        for (int i = kSquares - 5; i < kSquares; ++i) CHECK(world.stands(i));
        std::vector<int> now;
        for (int i = 0; i < kSquares; ++i) now.push_back(world.stands(i));
        if (flight > 0) CHECK(now == before);
        before = now;
        world.look(0, world.budget);
        world.settle();
        for (int i = 0; i < 5; ++i) CHECK(world.stands(i));
    }
    // Nothing is large enough.
    EspStreamingDef far = esp::defaults<EspStreamingDef>();
    far.eye[1] = 1e5f;
    far.deviceBytes = 0;
    REQUIRE(espSetStreaming(world.context, &far) == ESP_OK);
    world.settle();
    CHECK(world.standing() == 0);
    CHECK(world.all().deviceBytes == 0);
}

TEST_CASE("seeds and layers wait for their ground") {
    World world;
    const EspGrammar ivy = world.ivy();
    const EspSeed first = world.plant(ivy, 0), last = world.plant(ivy, kSquares - 1);
    std::vector<float> painted(64 * 64, .25f), read(64 * 64);
    painted[100] = .75f;
    EspLayerDef layer = esp::defaults<EspLayerDef>();
    layer.surface = world.squares[0];
    layer.name = "mask";
    layer.texels = painted.data();
    layer.width = layer.height = 64;
    layer.space = ESP_LAYER_TEXELS;
    REQUIRE_MESSAGE(espSetLayer(world.context, &layer) == ESP_OK, espLastError(world.context));
    world.frame();
    const EspStats whole = world.stats();

    world.look(kApart * (kSquares - 1), world.budget);
    world.settle();
    REQUIRE_FALSE(world.stands(0));
    const EspStats without = world.stats();
    CHECK(without.leaves > 0);
    CHECK(without.leaves < whole.leaves);
    uint32_t size = 64;
    CHECK(espReadLayer(world.context, world.squares[0], "mask", read.data(), &size) == ESP_INVALID_ARGUMENT);
    EspPlantInfo plant{};
    plant.structSize = sizeof plant;
    CHECK(espPlantInfo(world.context, first, &plant) == ESP_OK);
    CHECK(plant.nodes == 0);
    CHECK(espPlantInfo(world.context, last, &plant) == ESP_OK);
    CHECK(plant.nodes > 0);

    world.look(0, 1ull << 30);
    world.settle();
    REQUIRE(world.stands(0));
    world.frame();
    CHECK(world.stats().hash == whole.hash);
    CHECK(world.stats().leaves == whole.leaves);
    size = 64;
    REQUIRE(espReadLayer(world.context, world.squares[0], "mask", read.data(), &size) == ESP_OK);
    CHECK(read == painted);
}

TEST_CASE("what is away can be destroyed, and what can't be read is told") {
    World world;
    const EspSurface missing = world.add("no/such.surface.glb", -1);
    world.look(0, 1ull << 30);
    world.settle();
    CHECK(world.info(missing).state == ESP_STREAMED_FAILED);
    CHECK(world.info(missing).result == ESP_IO_FAILED);
    CHECK_MESSAGE(std::strstr(world.info(missing).message, "no/such"), world.info(missing).message);
    CHECK(world.standing() == kSquares);

    world.plant(world.ivy(), kSquares - 1);
    world.frame();
    world.look(0, world.budget);
    world.settle();
    REQUIRE_FALSE(world.stands(kSquares - 1));
    CHECK(espDestroySurface(world.context, world.squares.back()) == ESP_OK);
    CHECK(espDestroySurface(world.context, world.squares.back()) == ESP_INVALID_ARGUMENT);
    CHECK(espDestroySurface(world.context, missing) == ESP_OK);
    world.frame();
    CHECK(world.stats().seeds == 0);
    CHECK(world.all().streamed == kSquares - 1);
}

TEST_CASE("a corrupt file costs its own surface only") {
    const std::string copy = std::string(ESPALIER_SQUARE) + ".corrupt.glb";
    const auto size = std::filesystem::file_size(ESPALIER_SQUARE);
    World world;
    world.plant(world.ivy(), 1);
    world.settle();
    const uint64_t hash = world.stats().hash;
    // Cut off at many places, and torn at one.
    for (int part = 0; part <= 8; ++part) {
        CAPTURE(part);
        std::filesystem::copy_file(ESPALIER_SQUARE, copy, std::filesystem::copy_options::overwrite_existing);
        if (part < 8) {
            std::filesystem::resize_file(copy, size * unsigned(part) / 8);
        } else {
            std::fstream file(copy, std::ios::in | std::ios::out | std::ios::binary);
            file.seekp(std::streamoff(size / 2));
            file.write("torn out here, in the midst of the texels", 41);
        }
        const EspSurface corrupt = world.add(copy.c_str(), -2);
        world.look(0, 1ull << 30);
        world.settle();
        CHECK(world.info(corrupt).state == ESP_STREAMED_FAILED);
        CHECK(world.info(corrupt).result == ESP_INVALID_CONTENT);
        CHECK_MESSAGE(std::strstr(world.info(corrupt).message, copy.c_str()), world.info(corrupt).message);
        CHECK(world.standing() == kSquares);
        CHECK(world.stats().hash == hash);
        // Others come and go as before.
        world.look(kApart * kSquares, world.budget);
        world.settle();
        CHECK(world.stands(kSquares - 1));
        CHECK_FALSE(world.stands(0));
        CHECK(espDestroySurface(world.context, corrupt) == ESP_OK);
        world.look(0, 1ull << 30);
        world.settle();
    }
    std::filesystem::remove(copy);
}

TEST_CASE("a file that changes while its surface is away is refused") {
    const std::string copy = std::string(ESPALIER_SQUARE) + ".changes.glb";
    std::filesystem::copy_file(ESPALIER_SQUARE, copy, std::filesystem::copy_options::overwrite_existing);
    World world;
    const EspSurface changing = world.add(copy.c_str(), -2);
    world.look(-2, 1ull << 30);
    world.settle();
    REQUIRE(world.info(changing).state == ESP_STREAMED_STANDS);
    world.look(kApart * kSquares, world.budget);
    world.settle();
    REQUIRE(world.info(changing).state == ESP_STREAMED_AWAY);
    std::filesystem::copy_file(std::string(ESPALIER_CONTENT) + "/vase.surface.glb", copy,
                               std::filesystem::copy_options::overwrite_existing);
    world.look(-2, 1ull << 30);
    world.settle();
    CHECK(world.info(changing).state == ESP_STREAMED_FAILED);
    CHECK_MESSAGE(std::strstr(world.info(changing).message, "isn't the file any more"), world.info(changing).message);
    std::filesystem::remove(copy);
}

}  // namespace streaming
