// Growth that asks for far more than what stood: it can be given up, and its memory is given back.
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/editor/editing.hpp"

using namespace espalier::document;

namespace {

constexpr uint32_t kMost = 1'150'000;  // nodes

struct Place : Editing {
    Place() : Editing(content("sample.json"), kMost) {}
    EspStats stats() {
        EspStats s{};
        REQUIRE(espReadStats(context.get(), &s) == ESP_OK);
        return s;
    }
    std::vector<uint8_t> picture() {
        esp::DrawDef draw;
        draw.camera = document->scene().camera;
        draw.look = document->scene().look;
        draw.width = 320;
        draw.height = 180;
        std::vector<uint8_t> rgba(size_t(4) * draw.width * draw.height);
        REQUIRE_MESSAGE(espUpdate(context.get()) == ESP_OK, espLastError(context.get()));
        REQUIRE_MESSAGE(espDraw(context.get(), &draw) == ESP_OK, espLastError(context.get()));
        REQUIRE(espReadPixels(context.get(), rgba.data(), rgba.size()) == ESP_OK);
        return rgba;
    }
    void trim() { REQUIRE_MESSAGE(espTrim(context.get()) == ESP_OK, espLastError(context.get())); }
};

}  // namespace

TEST_CASE("growth that a slider has asked too much of is given up, and plants stand as they were") {
    Place place;
    const std::vector<uint8_t> before = place.picture();
    const EspStats small = place.stats();
    for (const auto& [name, value] : {std::pair("reach", 8.f), {"twigs", 20.f}, {"forks", 3.f}})
        REQUIRE(place.perform(SetParam{0, {name, {value}}}, 1));
    REQUIRE(place.perform(FillLayer{"mask", 1}));
    struct Watcher {
        int asked = 0;
        uint64_t nodes = 0;
    } watcher;
    const EspGrowingFn stops = [](void* user, uint64_t nodes) {
        Watcher& w = *static_cast<Watcher*>(user);
        w.asked += 1;
        w.nodes = nodes;
        return nodes == 0 ? 1 : 0;
    };
    REQUIRE(espWatchGrowth(place.context.get(), stops, &watcher) == ESP_OK);
    CHECK(espUpdate(place.context.get()) == ESP_STOPPED);
    CHECK(std::string(espLastError(place.context.get())).find("stopped") != std::string::npos);
    const int asked = watcher.asked;
    CHECK(asked > 0);
    CHECK(watcher.nodes > 0);
    CHECK(espUpdate(place.context.get()) == ESP_STOPPED);  // and doesn't try again
    CHECK(watcher.asked == asked);
    CHECK(place.stats().hash == small.hash);
    CHECK(place.stats().nodes == small.nodes);
    REQUIRE(place.perform(Undo{}));
    REQUIRE(place.perform(Undo{}));
    REQUIRE(espWatchGrowth(place.context.get(), nullptr, nullptr) == ESP_OK);
    CHECK(place.picture() == before);
    CHECK(place.stats().hash == small.hash);
}

TEST_CASE("what a slider that went too far has taken is given back once that is undone and the window rests") {
    Place place;
    const std::vector<uint8_t> before = place.picture();
    const EspStats small = place.stats();
    place.trim();
    CHECK(place.picture() == before);
    const uint64_t held = place.stats().totalBytes;
    for (const auto& [name, value] : {std::pair("reach", 8.f), {"twigs", 20.f}, {"forks", 3.f}})
        REQUIRE(place.perform(SetParam{0, {name, {value}}}, 1));
    REQUIRE(place.perform(FillLayer{"mask", 1}));
    (void)place.picture();
    const EspStats large = place.stats();
    REQUIRE(large.nodes > 8 * small.nodes);
    REQUIRE(large.totalBytes > 2 * held);
    REQUIRE(place.perform(Undo{}));
    REQUIRE(place.perform(Undo{}));
    CHECK(place.picture() == before);
    place.trim();
    CHECK(place.picture() == before);
    const uint64_t left = place.stats().totalBytes;
    CHECK(left < held + held / 4);
    // The next rest takes nothing that the next picture needs: what is bound stays bound.
    place.trim();
    const uint64_t resting = place.stats().totalBytes;
    CHECK(place.picture() == before);
    CHECK(place.stats().totalBytes < resting + (1 << 20));
    CHECK(place.stats().hash == small.hash);
    // What stands can be edited where it lies now.
    REQUIRE(place.perform(FillLayer{"autumn", 1}));
    CHECK(place.picture() != before);
    REQUIRE(place.perform(Undo{}));
    CHECK(place.picture() == before);
    CHECK(place.stats().hash == small.hash);
}

TEST_CASE("what a text that runs away has taken is given back once it is undone and the window rests") {
    Place place;
    const std::vector<uint8_t> before = place.picture();
    const EspStats small = place.stats();
    place.trim();
    (void)place.picture();
    const uint64_t held = place.stats().totalBytes;
    SetText text{0,
                 R"(
context mask = 1
Vine -> Marching(0.01, rand(-1, 1), true) {Fork, Wood}
Fork -> Branch(2) {Vine, Vine}
Wood -> S(0.01) Shape("bark", C1)
)",
                 {}};
    REQUIRE_MESSAGE(place.perform(text, 1), place.error);
    (void)place.picture();
    REQUIRE(place.stats().overflow > 0);
    REQUIRE(place.stats().totalBytes > held + held / 2);
    REQUIRE(place.perform(Undo{}));
    CHECK(place.picture() == before);
    place.trim();
    const uint64_t left = place.stats().totalBytes;
    MESSAGE("held " << (held >> 20) << " MiB, with the text " << (place.stats().reservedBytes >> 20) << ", left "
                    << (left >> 20));
    CHECK(left < held + held / 4);
    CHECK(place.picture() == before);
    CHECK(place.stats().hash == small.hash);
}
