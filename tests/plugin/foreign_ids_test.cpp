// Ids of one context given to another: each is refused, and neither context has changed.
#include <doctest/doctest.h>

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "runtime/plugin/context_number.hpp"
#include "tests/plugin/life.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;

namespace {

constexpr const char* kHouse = R"({"buildings": [{"id": "a", "outer": [[0,0],[12,0],[12,8],[0,8]]}]})";

// One object of each kind. Two gardens that are made alike have ids that differ by their contexts alone.
struct Garden : Life {
    EspGrammar roofs{};
    EspStroke ended{}, open{};

    Garden() {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = silent;
        REQUIRE(step("create", espCreate(ESP_VERSION, &def, &context)));
        REQUIRE((load() && compile() && plant(1)));
        roofs = compiled(context, "roofs", kDecaying);
        espalier::load(context, roofs, kHouse);
        const EspBrush brush = brushOn("damp", .2f);
        ended = stroke(context, brush, EspDab{{0, 0, 0}, {0, 0, 1}, 1});
        REQUIRE(espBeginStroke(context, &brush, &open) == ESP_OK);
        REQUIRE_MESSAGE(update(), espLastError(context));
    }
};

void refused(EspContext* context, EspResult gave) {
    CHECK(gave == ESP_INVALID_ARGUMENT);
    CHECK(espLastError(context)[0] != 0);
}

void refuseSurface(EspContext* context, EspSurface foreign) {
    EspSurfaceInfo info;
    const EspTransform place = espIdentity();
    uint32_t count = 0;
    const float texel = 1;
    EspLayerDef layer = esp::defaults<EspLayerDef>();
    layer.surface = foreign;
    layer.name = "mask";
    layer.texels = &texel;
    layer.width = layer.height = 1;
    EspStroke made{};
    refused(context, espSurfaceInfo(context, foreign, &info));
    refused(context, espMoveSurface(context, foreign, &place));
    refused(context, espReadAtlas(context, foreign, 0, nullptr, &count));
    refused(context, espReadLinks(context, foreign, nullptr, &count));
    refused(context, espSetLayer(context, &layer));
    refused(context, espImportLayer(context, &layer, &made));
    refused(context, espReadLayer(context, foreign, "damp", nullptr, &count));
    CHECK_FALSE(espLayerPainted(context, foreign, "damp"));
    refused(context, espDestroySurface(context, foreign));
}

void refuseGrammar(EspContext* context, EspGrammar foreign, EspGrammar foreignRoofs) {
    const std::string text = kLifeIvy;
    const EspGrammarDef def = esp::grammarDef("ivy", text);
    EspParamInfo info;
    const float one = 1;
    EspSeedDef seed = esp::defaults<EspSeedDef>();
    seed.grammar = foreign;
    EspSeed planted{};
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kHouse;
    town.length = std::string(kHouse).size();
    town.grammar = foreignRoofs;
    CHECK(espParamCount(context, foreign) == 0);
    CHECK(espLayerCount(context, foreignRoofs) == 0);
    CHECK(espGrammarWarnings(context, foreign)[0] == 0);
    refused(context, espParamInfo(context, foreign, 0, &info));
    refused(context, espSetParam(context, foreign, "reach", &one, 1));
    refused(context, espRecompileGrammar(context, foreign, &def));
    refused(context, espPlant(context, &seed, &planted));
    refused(context, espSetTownGrammar(context, foreignRoofs));
    refused(context, espLoadTown(context, &town));
    refused(context, espDestroyGrammar(context, foreign));
}

void refuseSeed(EspContext* context, EspSeed foreign) {
    EspSeedInfo info;
    EspPlantInfo plant;
    const float place[3] = {.1f, 0, 0}, up[3] = {0, 1, 0};
    float value[3];
    uint32_t count = 0;
    size_t bytes = 0;
    refused(context, espSeedInfo(context, foreign, &info));
    refused(context, espPlantInfo(context, foreign, &plant));
    refused(context, espMoveSeed(context, foreign, place, up));
    refused(context, espSetSeedNumber(context, foreign, 5, 0));
    refused(context, espSetSeedParam(context, foreign, "reach", place, 1));
    refused(context, espSeedParam(context, foreign, "reach", value, &count));
    refused(context, espFreezePlant(context, foreign, 1));
    refused(context, espReadFrozen(context, foreign, nullptr, &bytes));
    refused(context, espFreezeAs(context, foreign, "espalier", 8));
    refused(context, espRemoveSeed(context, foreign));
}

void refuseStroke(EspContext* context, EspStroke ended, EspStroke open, EspSurface own) {
    const EspDab dab{{0, 0, 0}, {0, 0, 1}, 1};
    refused(context, espStrokeDabs(context, open, &dab, 1));
    refused(context, espEndStroke(context, open));
    refused(context, espSwapStroke(context, ended));
    CHECK(espStrokeBytes(context, ended) == 0);
    CHECK_FALSE(espStrokePainted(context, ended, own));
    refused(context, espDestroyStroke(context, ended));
}

}  // namespace

TEST_CASE("an id of one context is refused by another, which has an object of its own in that place") {
    Garden a, b;
    const uint64_t hash = b.stats().hash;
    CHECK(a.surface.id != b.surface.id);
    refuseSurface(b.context, a.surface);
    refuseGrammar(b.context, a.grammar, a.roofs);
    refuseSeed(b.context, a.seed);
    refuseStroke(b.context, a.ended, a.open, b.surface);
    CHECK(b.update());
    CHECK(b.stats().hash == hash);
    CHECK(espSeedCount(b.context) == 1);
    CHECK(espStrokePainted(b.context, b.ended, b.surface));
    // Houses have no ids but numbers of their own town, and what is beyond its last is refused.
    EspHouseInfo house;
    REQUIRE(espRemoveTown(b.context) == ESP_OK);
    refused(b.context, espHouseInfo(b.context, 0, &house));
    CHECK(espHouseInfo(a.context, 0, &house) == ESP_OK);
}

TEST_CASE("an id of a context that is gone is refused by the next ones") {
    EspSurface gone{};
    {
        Garden a;
        gone = a.surface;
    }
    Garden b;
    EspSurfaceInfo info;
    refused(b.context, espSurfaceInfo(b.context, gone, &info));
}

TEST_CASE("contexts that live at a time have unlike numbers, as many as there are") {
    constexpr size_t kNumbers = 1u << kContextBits;
    std::vector<std::unique_ptr<ContextNumber>> all;
    std::set<uint32_t> seen;
    for (size_t i = 0; i < kNumbers; ++i) {
        all.push_back(std::make_unique<ContextNumber>());
        CHECK(all.back()->value() < kNumbers);
        seen.insert(all.back()->value());
    }
    CHECK(seen.size() == kNumbers);
    const ContextNumber more;  // shares one
    CHECK(more.value() < kNumbers);
    // The number that comes free is taken, though others follow in the ring.
    const bool shared = all[7]->value() == more.value();
    auto& going = shared ? all[8] : all[7];
    const uint32_t freed = going->value();
    going.reset();
    CHECK(ContextNumber().value() == freed);
}
