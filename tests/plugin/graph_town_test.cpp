// Towns that procedural graphs ask for, and layers over them.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/plugin/town_host.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;

namespace {

constexpr int kHouses = 12;
constexpr float kApart = 20;  // metres from one to the next, along x

constexpr const char* kWorn =
    "context wear = 0\ncontext moss = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover : wear(house) > 0.5 -> Repeat(XY, vec2(0.6, 0.5), bond) {Tile}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Shape(\"slate\")\n";

struct TownHost : Bare {
    test::ScratchFolder scratch;
    const std::filesystem::path& folder = scratch.path;
    EspGraph graph{};

    TownHost() {
        std::string plan = "{\"buildings\": [";
        for (int i = 0; i < kHouses; ++i) {
            const std::string a = std::to_string(i * kApart), b = std::to_string(i * kApart + 9);
            plan += std::string(i ? ", " : "") + "{\"id\": \"" + std::to_string(i) + "\", \"outer\": [[" + a + ",0],[" +
                    b + ",0],[" + b + ",7],[" + a + ",7]]}";
        }
        std::ofstream(folder / "plan.json") << plan + "]}";
        std::ofstream(folder / "roofs.grammar") << kWorn;
    }

    void show(const std::string& nodes) {
        const std::string name = (folder / "test.graph").string();
        const std::string text =
            "graph 1\nrules = Grammar(file: \"roofs.grammar\")\ntown = Town(file: \"plan.json\", grammar: rules)\n" +
            nodes;
        EspGraphDef def{};
        def.structSize = sizeof def;
        def.name = name.c_str();
        def.text = text.data();
        def.length = text.size();
        const EspResult made =
            graph.id ? espRecompileGraph(context, graph, &def) : espCompileGraph(context, &def, &graph);
        REQUIRE_MESSAGE(made == ESP_OK, espLastError(context));
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    }
    void set(const char* node, const char* input, float value) {
        EspGraphInput given{};
        given.structSize = sizeof given;
        given.node = node;
        given.input = input;
        given.numbers[0] = value;
        REQUIRE(espSetGraphInput(context, graph, &given) == ESP_OK);
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    }
    EspRoofStats roofs() {
        EspRoofStats stats{};
        REQUIRE(espReadRoofStats(context, &stats) == ESP_OK);
        return stats;
    }
    std::string failures() { return espGraphFailures(context, graph); }
};

// Houses whose roofs, 1.5 m beyond the walls, lie over a texel that isn't what it was.
int under(EspContext* context, const std::vector<float>& before, const std::vector<float>& now) {
    EspTownInfo town{};
    REQUIRE(espTownInfo(context, &town) == ESP_OK);
    const uint32_t side = town.layerTexels;
    const double texel = town.layerSide / side;
    int count = 0;
    for (int house = 0; house < kHouses; ++house) {
        bool changed = false;
        for (uint32_t y = 0; y < side; ++y)
            for (uint32_t x = 0; x < side; ++x) {
                const size_t i = size_t(y) * side + x;
                const double px = town.layerLow[0] + (x + .5) * texel, pz = town.layerLow[1] + (y + .5) * texel;
                const double low = house * kApart - 1.5, high = house * kApart + 9 + 1.5;
                if (before[i] != now[i] && px > low - texel && px < high + texel && std::abs(pz + 3.5) < 5 + texel)
                    changed = true;
            }
        count += changed;
    }
    return count;
}

}  // namespace

TEST_CASE("noise that moves over a graph's town regrows the houses whose texels changed") {
    uint64_t hash = 0;
    {
        TownHost host;
        host.show(
            "wear = TownLayer(name: \"wear\", value: \"min(1, floor(1 + c - abs(x - a)))\", c: 12)\nshow town wear\n");
        CHECK(host.failures() == "");
        CHECK(host.roofs().houses == kHouses);
        std::vector<float> before = layerOf(host.context, "wear");
        CHECK(*std::ranges::max_element(before) == 1);
        for (const float a : {3.f, 40.f, 130.f, 131.f, 500.f, 40.f}) {
            const uint64_t grown = host.roofs().housesGrown;
            host.set("wear", "a", a);
            const std::vector<float> now = layerOf(host.context, "wear");
            const int wanted = under(host.context, before, now);
            CHECK(host.roofs().housesGrown - grown == uint64_t(wanted));
            CHECK(wanted < kHouses);
            before = now;
        }
        hash = host.roofs().hash;
    }
    // As if it had been so from the beginning.
    TownHost anew;
    anew.show(
        "wear = TownLayer(name: \"wear\", value: \"min(1, floor(1 + c - abs(x - a)))\", a: 40, c: 12)\n"
        "show town wear\n");
    CHECK(anew.roofs().hash == hash);
}

TEST_CASE("a graph's town comes and goes with its node, and what can't be is told") {
    TownHost host;
    host.show("wear = TownLayer(name: \"wear\", value: \"1\")\nshow town wear\n");
    const uint64_t worn = host.roofs().hash;
    SUBCASE("a layer that isn't shown any more is as its grammar has it") {
        host.show("show town\n");
        CHECK(host.roofs().hash != worn);
        CHECK(host.roofs().houses == kHouses);
    }
    SUBCASE("so is a town") {
        host.show("c = Cube\nshow c\n");
        EspTownInfo info{};
        CHECK(espTownInfo(host.context, &info) != ESP_OK);
    }
    SUBCASE("a layer without a town") {
        host.show("wear = TownLayer(name: \"wear\", value: \"1\")\nshow wear\n");
        CHECK(host.failures().find("wear: there is no town for the layer 'wear'") != std::string::npos);
    }
    SUBCASE("two towns") {
        host.show("other = Town(file: \"plan.json\", grammar: rules)\nshow town other\n");
        CHECK(host.failures().find("other: a scene has one town") != std::string::npos);
        CHECK(host.roofs().houses == kHouses);
    }
    SUBCASE("an expression with a mistake leaves the layer as it was") {
        host.show("wear = TownLayer(name: \"wear\", value: \"1 +\")\nshow town wear\n");
        CHECK(host.failures().find("wear: ") != std::string::npos);
        CHECK(host.roofs().hash == worn);
    }
    SUBCASE("the host's own town stays") {
        REQUIRE(espDestroyGraph(host.context, host.graph) == ESP_OK);
        host.graph = {};
        load(host.context, compiled(host.context, "roofs", kWorn),
             "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}");
        host.show("wear = TownLayer(name: \"wear\", value: \"1\")\nshow town wear\n");
        CHECK(host.failures().find("town: the scene has a town already") != std::string::npos);
        CHECK(host.roofs().houses == 1);
        CHECK(std::ranges::all_of(layerOf(host.context, "wear"), [](float v) { return v == 1; }));
    }
}
