// Two contexts in two threads, each with a device of its own: they share nothing, so what each makes is what it makes
// alone. Under ThreadSanitizer (tools/check threads) also: no two threads meet at one place unguarded.
#include <doctest/doctest.h>

#include <array>
#include <barrier>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "plugin_api/espalier.hpp"

namespace {

constexpr const char* kIvy =
    "param reach = 0.3 [0.1 .. 5] \"m\" \"Length of the stems\"\n"
    "context mask = 1 \"Where it grows\"\n"
    "Ivy -> Branch(3) {Stem(reach), Stem(reach * 0.8), Stem(reach * 0.6)}\n"
    "Stem(l) : arc >= l or mask(texCoord) < 0.1 -> NULL\n"
    "Stem(l) -> Marching(0.02, rand(-0.3, 0.3), true) {Stem(l), Wood Foliage}\n"
    "Wood -> S(0.01) Shape(\"bark\", C1)\n"
    "Foliage -> Repeat(2) {S(0.06) T(rand(), 0.02) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";

constexpr const char* kRoofs =
    "context decay = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Drop(decay) Shape(\"slate\")\n";

constexpr const char* kTown =
    R"({"buildings": [{"id": "a", "outer": [[10,0],[22,0],[22,8],[10,8]]}, {"id": "b", "outer": [[30,0],[42,0],[36,9]]}]})";

constexpr uint32_t kWidth = 64, kHeight = 36;

// What a life of a context has made.
struct Made {
    std::string failure;  // the first call that failed, and why
    uint64_t first = 0, painted = 0, roofs = 0;
    size_t frozen = 0, triangles = 0;
    uint32_t came = 0;
    bool operator==(const Made&) const = default;
};

class Life {
  public:
    ~Life() { espDestroy(context_); }

    Made live(bool shaders) {
        create();
        grow(shaders);
        made_.first = hash();
        draw();
        paint();
        made_.painted = hash();
        build();
        draw();
        keep();
        done("trim", espTrim(context_));
        stream();
        return made_;
    }

  private:
    bool done(const char* call, EspResult result) {
        if (result != ESP_OK && made_.failure.empty())
            made_.failure = std::string(call) + ": " + espLastError(context_);
        return result == ESP_OK;
    }
    void create() {
        EspContextDef def = esp::defaults<EspContextDef>();
        const std::string terminals = std::string(ESPALIER_CONTENT) + "/terminals.glb";
        def.terminals = terminals.c_str();
        done("create", espCreate(ESP_VERSION, &def, &context_));
    }
    EspGrammar compile(const char* text) {
        const EspGrammarDef def = esp::grammarDef("text", text);
        EspGrammar grammar{};
        done("compile", espCompileGrammar(context_, &def, &grammar));
        return grammar;
    }
    void grow(bool shaders) {
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.shadersOnly = shaders;
        done("set grow", espSetGrow(context_, &grow));
        done("load", espLoadSurface(context_, ESPALIER_SQUARE, nullptr, &surface_));
        ivy_ = compile(kIvy);
        for (uint32_t i = 0; i < 4; ++i) {
            EspSeedDef seed = esp::defaults<EspSeedDef>();
            seed.grammar = ivy_;
            seed.position[0] = .2f * float(i) - .3f;
            seed.direction[1] = 1;
            seed.number = i;
            done("plant", espPlant(context_, &seed, &seed_));
        }
    }
    uint64_t hash() {
        EspStats stats{};
        done("update", espUpdate(context_));
        done("stats", espReadStats(context_, &stats));
        return stats.hash;
    }
    void draw() {
        esp::DrawDef def;
        def.width = kWidth;
        def.height = kHeight;
        def.camera = esp::frameAll(context_);
        std::vector<uint8_t> pixels(size_t(kWidth) * kHeight * 4);
        done("draw", espDraw(context_, &def));
        done("read", espReadPixels(context_, pixels.data(), pixels.size()));
    }
    void paint() {
        EspBrush brush = esp::defaults<EspBrush>();
        brush.layer = "mask";
        brush.value = 0;
        brush.strength = 1;
        brush.radius = .2f;
        EspStroke stroke{};
        done("begin", espBeginStroke(context_, &brush, &stroke));
        const EspDab dab{{.1f, .2f, 0}, {0, 0, 1}, 1};
        done("dabs", espStrokeDabs(context_, stroke, &dab, 1));
        done("end", espEndStroke(context_, stroke));
    }
    void build() {
        EspTownDef town = esp::defaults<EspTownDef>();
        town.text = kTown;
        town.length = std::strlen(kTown);
        town.grammar = compile(kRoofs);
        done("town", espLoadTown(context_, &town));
        done("update", espUpdate(context_));
        EspRoofStats stats{};
        done("roof stats", espReadRoofStats(context_, &stats));
        made_.roofs = stats.hash;
    }
    void keep() {
        done("freeze", espFreezePlant(context_, seed_, 1));
        done("read frozen", espReadFrozen(context_, seed_, nullptr, &made_.frozen));
        EspTriangles triangles{};
        done("materialise", espMaterialise(context_, &triangles));
        made_.triangles = size_t(triangles.indexCount);
    }

    // Surfaces come and go beside the frames, loads are given up, and one is on its way when the context ends.
    void stream() {
        constexpr float kApart = 5;
        EspTransform place = espIdentity();
        EspSurfaceDef surface{};
        surface.structSize = sizeof surface;
        surface.name = ESPALIER_SQUARE;
        surface.place = &place;
        std::vector<EspSurface> squares(6);
        EspStreamedDef streamed{};
        streamed.structSize = sizeof streamed;
        streamed.surface = &surface;
        streamed.boundsMax[0] = streamed.boundsMax[1] = 1;
        for (size_t i = 0; i < squares.size(); ++i) {
            place.rows[0][3] = kApart * float(i + 2);
            done("add streamed", espAddStreamed(context_, &streamed, &squares[i]));
        }
        EspStreamingDef streaming = esp::defaults<EspStreamingDef>();
        streaming.leastSize = 0;
        EspStreamedInfo first{};
        first.structSize = sizeof first;
        for (int frame = 0; frame < 400; ++frame) {
            streaming.eye[0] = kApart * float(2 + frame / 8 % 6);
            if (first.bytes > 0) streaming.deviceBytes = first.bytes * 5 / 2;
            done("set streaming", espSetStreaming(context_, &streaming));
            EspLoad load{};
            if (frame % 40 == 0) done("begin", espBeginLoad(context_, &surface, &load));
            done("update", espUpdate(context_));
            if (load.id) done("end", espEndLoad(context_, load));
            done("streamed", espStreamedInfo(context_, squares.front(), &first));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        streaming.eye[0] = kApart * 2;
        done("set streaming", espSetStreaming(context_, &streaming));
        for (int frame = 0; frame < 10'000 && first.state != ESP_STREAMED_STANDS; ++frame) {
            done("update", espUpdate(context_));
            done("streamed", espStreamedInfo(context_, squares.front(), &first));
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        made_.came = first.state == ESP_STREAMED_STANDS;
        EspLoad last{};
        done("begin", espBeginLoad(context_, &surface, &last));
    }

    EspContext* context_ = nullptr;
    EspSurface surface_{};
    EspGrammar ivy_{};
    EspSeed seed_{};
    Made made_;
};

}  // namespace

TEST_CASE("two contexts in two threads make what each makes alone") {
    for (const bool shaders : {false, true}) {
        CAPTURE(shaders);
        const Made alone = Life().live(shaders);
        REQUIRE_MESSAGE(alone.failure.empty(), alone.failure);
        CHECK(alone.came == 1);
        CHECK(alone.first != alone.painted);
        CHECK(alone.roofs != 0);
        std::array<Made, 2> made;
        std::barrier start(2);
        const auto live = [&](size_t i) {
            start.arrive_and_wait();
            made[i] = Life().live(shaders);
        };
        std::thread other(live, 1);
        live(0);
        other.join();
        for (const Made& one : made) {
            CHECK_MESSAGE(one.failure.empty(), one.failure);
            CHECK(one == alone);
        }
    }
}
