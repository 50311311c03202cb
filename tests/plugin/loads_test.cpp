// Surfaces that are loaded beside the frames.
#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/grown_square.hpp"

using namespace espalier;

namespace loads {
namespace {

std::vector<char> bytesOf(const char* path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

struct Host {
    EspContext* context = nullptr;

    explicit Host(const EspFiles* files = nullptr) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        def.files = files;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
    }
    ~Host() { espDestroy(context); }
    Host(const Host&) = delete;

    EspLoad begin(const char* path, const EspTransform* place = nullptr) {
        EspSurfaceDef def{};
        def.structSize = sizeof def;
        def.name = path;
        def.place = place;
        EspLoad load{};
        REQUIRE_MESSAGE(espBeginLoad(context, &def, &load) == ESP_OK, espLastError(context));
        return load;
    }
    EspLoadInfo info(EspLoad load) {
        EspLoadInfo info{};
        info.structSize = sizeof info;
        REQUIRE(espLoadInfo(context, load, &info) == ESP_OK);
        return info;
    }
    // A frame of a game: it updates, and does something else for a while.
    void frame() {
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    EspLoadInfo finish(EspLoad load) {
        for (int frames = 0; frames < 20'000 && info(load).state < ESP_LOAD_STANDS; ++frames) frame();
        return info(load);
    }
    uint64_t grow() {
        const EspGrammarDef text = esp::grammarDef("ivy", kSquaresIvy);
        EspSeedDef seed = esp::defaults<EspSeedDef>();
        REQUIRE(espCompileGrammar(context, &text, &seed.grammar) == ESP_OK);
        seed.position[0] = .5f;
        seed.direction[1] = 1;
        EspSeed planted{};
        REQUIRE(espPlant(context, &seed, &planted) == ESP_OK);
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
        EspStats stats{};
        stats.structSize = sizeof stats;
        REQUIRE(espReadStats(context, &stats) == ESP_OK);
        CHECK(stats.leaves > 20);
        return stats.hash;
    }
    std::vector<uint8_t> picture() {
        EspDrawDef draw = esp::defaults<EspDrawDef>();
        draw.width = 160, draw.height = 120;
        REQUIRE(espDraw(context, &draw) == ESP_OK);
        std::vector<uint8_t> pixels(size_t(draw.width) * draw.height * 4);
        REQUIRE(espReadPixels(context, pixels.data(), pixels.size()) == ESP_OK);
        return pixels;
    }
};

EspTransform at(float x) {
    EspTransform place = espIdentity();
    place.rows[0][3] = x;
    return place;
}

// A host's archive: the square, and the library's own content.
struct Archive {
    std::vector<char> square = bytesOf(ESPALIER_SQUARE), last;
    std::thread::id thread = std::this_thread::get_id();
    int squares = 0, elsewhere = 0;
};
EspResult readArchived(void* user, const char* path, const void** bytes, size_t* size) {
    Archive& archive = *static_cast<Archive*>(user);
    archive.elsewhere += std::this_thread::get_id() != archive.thread;
    const bool square = std::strstr(path, "square") != nullptr;
    archive.squares += square;
    archive.last =
        square ? archive.square
               : bytesOf((std::filesystem::path(ESPALIER_CONTENT) / std::filesystem::path(path).filename()).c_str());
    *bytes = archive.last.data();
    *size = archive.last.size();
    return archive.last.empty() ? ESP_IO_FAILED : ESP_OK;
}
void release(void*, const void*, size_t) {}

}  // namespace

TEST_CASE("a surface that loads beside the frames is the one that loads at once") {
    Host atOnce, beside;
    EspSurface wall{};
    REQUIRE(espLoadSurface(atOnce.context, ESPALIER_SQUARE, nullptr, &wall) == ESP_OK);

    const EspLoad load = beside.begin(ESPALIER_SQUARE);
    CHECK(beside.info(load).state == ESP_LOAD_READING);
    CHECK(beside.info(load).surface.id == 0);
    const EspLoadInfo done = beside.finish(load);
    REQUIRE_MESSAGE(done.state == ESP_LOAD_STANDS, done.message);
    CHECK(done.bytes > 64 * 64 * 8);
    EspSurfaceInfo a{}, b{};
    a.structSize = b.structSize = sizeof a;
    REQUIRE(espSurfaceInfo(atOnce.context, wall, &a) == ESP_OK);
    REQUIRE(espSurfaceInfo(beside.context, done.surface, &b) == ESP_OK);
    CHECK(std::memcmp(&a, &b, sizeof a) == 0);
    CHECK(atOnce.grow() == beside.grow());
    CHECK(atOnce.picture() == beside.picture());

    // The ticket is one thing, the surface another.
    CHECK(espEndLoad(beside.context, load) == ESP_OK);
    CHECK(espEndLoad(beside.context, load) == ESP_INVALID_ARGUMENT);
    CHECK(espSurfaceInfo(beside.context, done.surface, &b) == ESP_OK);
}

TEST_CASE("a broken file costs its own surface only") {
    Host host;
    const std::string broken = std::string(ESPALIER_SQUARE) + ".broken.glb";
    std::vector<char> bytes = bytesOf(ESPALIER_SQUARE);
    bytes.resize(bytes.size() / 2);
    std::ofstream(broken, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
    const EspTransform aside = at(3);
    const EspLoad first = host.begin(broken.c_str()), missing = host.begin("no/such.surface.glb"),
                  last = host.begin(ESPALIER_SQUARE, &aside);
    CHECK(host.finish(last).state == ESP_LOAD_STANDS);
    const EspLoadInfo half = host.info(first), none = host.info(missing);
    CHECK(half.state == ESP_LOAD_FAILED);
    CHECK(half.result == ESP_INVALID_CONTENT);
    CHECK_MESSAGE(std::strstr(half.message, "broken.glb"), half.message);
    CHECK(none.state == ESP_LOAD_FAILED);
    CHECK(none.result == ESP_IO_FAILED);
    CHECK_MESSAGE(std::strstr(none.message, "no/such.surface.glb"), none.message);
    std::filesystem::remove(broken);
}

TEST_CASE("surfaces from memory and from a host's files load beside the frames") {
    Archive archive;
    SUBCASE("callbacks are called on the context's thread only") {
        EspFiles files{};
        files.structSize = sizeof files;
        files.user = &archive;
        files.read = readArchived;
        files.release = release;
        Host host(&files);
        CHECK(host.finish(host.begin("square")).state == ESP_LOAD_STANDS);
        CHECK(archive.squares == 1);
        CHECK(archive.elsewhere == 0);
    }
    SUBCASE("bytes are copied") {
        Host host;
        EspSurfaceDef def{};
        def.structSize = sizeof def;
        def.bytes = archive.square.data();
        def.size = archive.square.size();
        EspLoad load{};
        REQUIRE(espBeginLoad(host.context, &def, &load) == ESP_OK);
        std::fill(archive.square.begin(), archive.square.end(), 0);
        CHECK(host.finish(load).state == ESP_LOAD_STANDS);
    }
}

TEST_CASE("loads that are ended never stand") {
    Host host;
    std::vector<EspLoad> all;
    for (int i = 0; i < 12; ++i) {
        const EspTransform place = at(2.0f * float(i));
        all.push_back(host.begin(ESPALIER_SQUARE, &place));
    }
    for (size_t i = 0; i < all.size(); i += 2) {
        CHECK(espEndLoad(host.context, all[i]) == ESP_OK);
        if (i % 4 == 0) host.frame();
    }
    for (size_t i = 1; i < all.size(); i += 2) CHECK(host.finish(all[i]).state == ESP_LOAD_STANDS);
    for (int i = 0; i < 10; ++i) host.frame();
    size_t standing = 0;
    for (int i = 0; i < 12; ++i) {
        const float above[3] = {2.0f * float(i) + .5f, .5f, 1}, down[3] = {0, 0, -1};
        EspHit hit{};
        hit.structSize = sizeof hit;
        standing += espPick(host.context, above, down, &hit) == ESP_OK;
    }
    CHECK(standing == 6);
    // One ends with the context.
    host.begin(ESPALIER_SQUARE);
}

TEST_CASE("an update takes no more than it may") {
    Host host;
    EspLoadingDef def = esp::defaults<EspLoadingDef>();
    def.bytesPerUpdate = 1;
    REQUIRE(espSetLoading(host.context, &def) == ESP_OK);
    std::vector<EspLoad> all;
    for (int i = 0; i < 8; ++i) {
        const EspTransform place = at(2.0f * float(i));
        all.push_back(host.begin(ESPALIER_SQUARE, &place));
    }
    const auto begun = [&] {
        size_t count = 0;
        for (EspLoad load : all) count += host.info(load).state != ESP_LOAD_READING;
        return count;
    };
    size_t before = 0, most = 0;
    for (int frames = 0; frames < 20'000 && host.info(all.back()).state != ESP_LOAD_STANDS; ++frames) {
        host.frame();
        most = std::max(most, begun() - before);
        before = begun();
    }
    CHECK(before == all.size());
    CHECK(most == 1);
}

}  // namespace loads
