// Leaves in the wind: by the clock alone, and nothing is derived for it.
#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <vector>

#include "tests/plugin/life.hpp"

using namespace espalier;

namespace {

using Pixels = std::vector<uint8_t>;

Pixels pictureAt(Life& life, float speed, double clock, bool quick = false) {
    EspLook look = esp::defaults<EspLook>();
    look.wind[0] = speed;
    look.wind[2] = -speed;
    look.clock = clock;
    look.quick = quick;
    EspDrawDef def = esp::defaults<EspDrawDef>();
    def.width = 320;
    def.height = 240;
    def.look = &look;
    // The first picture after a change of quality may fade levels of detail.
    for (int i = 0; i < 2; ++i) REQUIRE_MESSAGE(espDraw(life.context, &def) == ESP_OK, espLastError(life.context));
    Pixels pixels(size_t(def.width) * def.height * 4);
    REQUIRE(espReadPixels(life.context, pixels.data(), pixels.size()) == ESP_OK);
    return pixels;
}
size_t unlike(const Pixels& a, const Pixels& b) {
    size_t n = 0;
    for (size_t i = 0; i < a.size(); i += 4) n += std::memcmp(&a[i], &b[i], 4) != 0;
    return n;
}

}  // namespace

TEST_CASE("leaves move with the clock of the wind, and nothing else does") {
    Life life;
    EspContextDef def = esp::defaults<EspContextDef>();
    def.log = silent;
    REQUIRE(espCreate(ESP_VERSION, &def, &life.context) == ESP_OK);
    REQUIRE((life.load() && life.compile() && life.plant(4) && life.plant(6) && life.update()));
    const EspStats before = life.stats();
    REQUIRE(before.leaves > 0);
    for (const bool quick : {false, true}) {
        CAPTURE(quick);
        const Pixels still = pictureAt(life, 0, 0, quick), early = pictureAt(life, 4, 0, quick),
                     late = pictureAt(life, 4, 1, quick);
        CHECK(unlike(still, pictureAt(life, 0, 1, quick)) == 0);
        CHECK(unlike(still, early) > 100);
        CHECK(unlike(early, late) > 100);
        CHECK(unlike(late, pictureAt(life, 4, 1, quick)) == 0);
        CHECK(unlike(early, pictureAt(life, 4, 0, quick)) == 0);
    }
    REQUIRE(life.update());
    const EspStats after = life.stats();
    CHECK(after.expansions == before.expansions);
    CHECK(after.hash == before.hash);
    EspLook look = esp::defaults<EspLook>();
    look.clock = std::numeric_limits<double>::infinity();
    EspDrawDef wrong = esp::defaults<EspDrawDef>();
    wrong.look = &look;
    CHECK(espDraw(life.context, &wrong) == ESP_INVALID_ARGUMENT);
}
