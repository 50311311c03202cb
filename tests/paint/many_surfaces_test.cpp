// More surfaces than a byte counts.
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

constexpr uint32_t kSurfaces = 300;

// Cubes in a row, each with a corner of its own to plant on.
struct Row {
    Painting painting{cube(2), 64};
    std::vector<EspSurface> surfaces{painting.surface};

    Row() {
        while (surfaces.size() < kSurfaces) surfaces.push_back(painting.another(movedBy(place(surfaces.size()))));
    }
    static glm::vec3 place(size_t surface) { return {5 * float(surface), 0, 0}; }
    // How many nodes there are then.
    uint32_t plantOn(EspGrammar grammar, size_t surface) const {
        painting.plant(grammar, kFoot + place(surface), kUp);
        return painting.grown().nodes;
    }
    void fill(const char* layer, size_t surface, float value) const {
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = surfaces[surface];
        def.name = layer;
        def.space = ESP_LAYER_WALK_UV;
        def.width = def.height = 1;
        def.texels = &value;
        painting.ok(espSetLayer(painting.context, &def));
    }
};

}  // namespace

TEST_CASE("an edit on one of 300 surfaces regrows what reads it there, and nothing else") {
    const Row row;
    const EspGrammar grammar = row.painting.grammar(kMaskedIvy);
    // The numbers of these two are one number in eight bits.
    const size_t last = kSurfaces - 1, alike = last - 256;
    const uint32_t one = row.plantOn(grammar, alike), both = row.plantOn(grammar, last);
    REQUIRE(one > 20);
    REQUIRE(both > one);
    for (const bool shadersOnly : {false, true}) {
        CAPTURE(shadersOnly);
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.shadersOnly = shadersOnly;
        row.painting.ok(espSetGrow(row.painting.context, &grow));
        const uint64_t before = row.painting.grown().hash;
        row.fill("mask", last, 0.9f);  // as true as before
        CHECK(row.painting.grown().derivedNodes == both - one);
        CHECK(row.painting.grown().hash == before);
        row.fill("mask", alike, 0.9f);
        CHECK(row.painting.grown().derivedNodes == one);
        CHECK(row.painting.grown().hash == before);
        row.fill("mask", last, 0);
        const EspStats bare = row.painting.grown();
        CHECK(bare.nodes < both);
        CHECK(bare.nodes >= one);
        row.fill("mask", last, 1);
        CHECK(row.painting.grown().hash == before);
    }
    row.painting.hash();
}
