// Plants and ground that procedural graphs ask for.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/grown_square.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace espalier;

namespace {

// A host whose graph plants a grammar of its own.
struct GraphHost {
    EspContext* context = nullptr;
    EspGraph graph{};
    test::ScratchFolder scratch;
    std::filesystem::path folder = scratch.path / "a/b";  // a graph may name files two folders up

    GraphHost() {
        std::filesystem::create_directories(folder);
        write("ivy.grammar", std::string("param bend = 0.35 [0 .. 1] \"\" \"Bend\"\n") + kSquaresIvy);
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
    }
    ~GraphHost() { espDestroy(context); }
    GraphHost(const GraphHost&) = delete;

    void write(const char* name, const std::string& text) { std::ofstream(folder / name, std::ios::binary) << text; }
    void load(const std::string& text) {
        EspGraphDef def{};
        def.structSize = sizeof def;
        const std::string name = (folder / "test.graph").string();
        def.name = name.c_str();
        def.text = text.data();
        def.length = text.size();
        const EspResult made =
            graph.id ? espRecompileGraph(context, graph, &def) : espCompileGraph(context, &def, &graph);
        REQUIRE_MESSAGE(made == ESP_OK, espLastError(context));
        update();
    }
    void update() { REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context)); }
    void set(const char* node, const char* input, std::vector<float> numbers) {
        EspGraphInput given{};
        given.structSize = sizeof given;
        given.kind = numbers.size() == 3 ? ESP_GRAPH_VECTOR : ESP_GRAPH_NUMBER;
        given.node = node;
        given.input = input;
        std::copy(numbers.begin(), numbers.end(), given.numbers);
        REQUIRE_MESSAGE(espSetGraphInput(context, graph, &given) == ESP_OK, espLastError(context));
        update();
    }
    EspStats stats() {
        EspStats stats{};
        REQUIRE(espReadStats(context, &stats) == ESP_OK);
        return stats;
    }
    EspGraphBake bake() {
        EspGraphBake bake{};
        bake.structSize = sizeof bake;
        REQUIRE(espNextGraphBake(context, graph, &bake) == ESP_OK);
        return bake;
    }
    std::string failures() { return espGraphFailures(context, graph); }
};

constexpr const char* kPlants =
    "graph 1\n"
    "feet = PointGrid(counts: (3, 1, 1), step: (0.3, 1, 1), centre: (0.5, 0.05, 0))\n"
    "rules = Grammar(file: \"ivy.grammar\")\n"
    "bent = Parameter(rules, name: \"bend\", value: 0.2)\n"
    "ivy = Grow(feet, bent, reach: 0.2, direction: (0, 1, 0))\n"
    "show ivy\n";

TEST_CASE("a graph plants on what stands in the scene, and takes its plants away") {
    GraphHost host;
    EspSurface square{};
    REQUIRE(espLoadSurface(host.context, ESPALIER_SQUARE, nullptr, &square) == ESP_OK);
    host.load(kPlants);
    CHECK(host.failures() == "");
    const EspStats first = host.stats();
    CHECK(first.seeds == 3);
    CHECK(first.nodes > 100);
    EspSeed seed{};
    EspSeedInfo info{};
    REQUIRE(espSeedAt(host.context, 1, &seed) == ESP_OK);
    REQUIRE(espSeedInfo(host.context, seed, &info) == ESP_OK);
    CHECK(info.ofGraph == 1);
    CHECK(info.position[0] == doctest::Approx(0.5).epsilon(1e-3));

    // Nothing changes, nothing is done; a host that clears its seeds leaves those of graphs.
    REQUIRE(espRemoveAllSeeds(host.context) == ESP_OK);
    host.update();
    CHECK(host.stats().expansions == first.expansions);

    SUBCASE("points that move take their plants along, and come back to the same") {
        host.set("feet", "centre", {0.45f, 0.05f, 0});
        CHECK(host.stats().hash != first.hash);
        host.set("feet", "centre", {0.5f, 0.05f, 0});
        CHECK(host.stats().hash == first.hash);
    }
    SUBCASE("more points leave the plants of the first ones alone") {
        host.set("feet", "counts", {4, 1, 1});
        CHECK(host.stats().seeds == 4);
        host.set("feet", "counts", {3, 1, 1});
        CHECK(host.stats().hash == first.hash);
    }
    SUBCASE("a parameter grows other plants") {
        host.set("bent", "value", {0.9f});
        CHECK(host.stats().hash == first.hash);  // no rule of this grammar reads it
        host.load(
            "graph 1\nfeet = PointGrid(counts: (3, 1, 1), step: (0.3, 1, 1), centre: (0.5, 0.05, 0))\n"
            "rules = Grammar(file: \"ivy.grammar\")\nbent = Parameter(rules, name: \"no\")\n"
            "ivy = Grow(feet, bent, reach: 0.2, direction: (0, 1, 0))\nshow ivy\n");
        CHECK(host.failures().find("test.graph:5:1: ivy: ") != std::string::npos);
        CHECK(host.failures().find("has no parameter 'no'") != std::string::npos);
        CHECK(host.stats().hash == first.hash);  // the last good ones stand
    }
    SUBCASE("points beyond reach are told") {
        host.set("feet", "centre", {0.5f, 0.05f, 0.5f});
        CHECK(host.failures().find("no ground is within 0.2 m of 3 of 3 points") != std::string::npos);
        CHECK(host.stats().seeds == 0);
        host.set("ivy", "reach", {1});
        CHECK(host.failures() == "");
        CHECK(host.stats().seeds == 3);
    }
    SUBCASE("surfaces that come later are ground, too") {
        REQUIRE(espDestroySurface(host.context, square) == ESP_OK);
        host.update();
        CHECK(host.stats().seeds == 0);
        REQUIRE(espLoadSurface(host.context, ESPALIER_SQUARE, nullptr, &square) == ESP_OK);
        host.update();
        CHECK(host.stats().hash == first.hash);
    }
    SUBCASE("what isn't shown any more goes") {
        host.load("graph 1\nc = Cube\nshow c\n");
        CHECK(host.stats().seeds == 0);
        CHECK(espSeedCount(host.context) == 0);
    }
    SUBCASE("a graph that is destroyed takes all along") {
        REQUIRE(espDestroyGraph(host.context, host.graph) == ESP_OK);
        host.update();
        CHECK(host.stats().seeds == 0);
    }
    SUBCASE("a graph from elsewhere names files near it only") {
        std::filesystem::create_symlink("/etc", host.folder / "elsewhere");
        for (const char* file : {"../../../../../../etc/hostname", "elsewhere/hostname"}) {
            host.load(std::string("graph 1\nfeet = PointGrid(centre: (0.5, 0.05, 0))\nfar = Grammar(file: \"") + file +
                      "\")\nivy = Grow(feet, far)\nshow ivy\n");
            CHECK_MESSAGE(host.failures().find(" leads out of ") != std::string::npos, host.failures());
        }
    }
    SUBCASE("ground that a host destroys is asked for again") {
        host.load("graph 1\nwall = Plane\nground = Bake(wall, resolution: 64)\nshow ground\n");
        const uint64_t key = host.bake().key;
        REQUIRE(key != 0);
        REQUIRE(espGiveGraphBake(host.context, host.graph, key, ESPALIER_SQUARE, nullptr) == ESP_OK);
        host.update();
        CHECK(host.bake().key == 0);
        EspHit hit{};
        hit.structSize = sizeof hit;
        REQUIRE(espDestroySurface(host.context, square) == ESP_OK);
        const float near[3] = {0.5f, 0.5f, 0};
        REQUIRE(espNearest(host.context, near, &hit) == ESP_OK);
        REQUIRE(espDestroySurface(host.context, hit.surface) == ESP_OK);
        host.update();
        CHECK(host.bake().key == key);
    }
    SUBCASE("a grammar with mistakes is told with its place") {
        host.write("ivy.grammar", "Ivy -> Marching(\n");
        host.load(
            "graph 1\nfeet = PointGrid(centre: (0.5, 0.05, 0))\nnew = Grammar(file: \"ivy.grammar\")\n"
            "ivy = Grow(feet, new)\nshow ivy\n");
        CHECK(host.failures().find("ivy.grammar:") != std::string::npos);
    }
}

TEST_CASE("ground of a graph is baked by the host, and plants wait for it") {
    GraphHost host;
    host.load(
        "graph 1\n"
        "wall = Plane(size: (1, 1, 1))\n"
        "ground = Bake(wall, resolution: 64)\n"
        "feet = PointGrid(counts: (3, 1, 1), step: (0.3, 1, 1), centre: (0.5, 0.05, 0))\n"
        "rules = Grammar(file: \"ivy.grammar\")\n"
        "ivy = Grow(feet, rules, ground, reach: 0.2, direction: (0, 1, 0))\n"
        "show ground ivy\n");
    CHECK(host.failures() == "");
    CHECK(host.stats().seeds == 0);
    EspGraphStats stats{};
    REQUIRE(espGraphStats(host.context, host.graph, &stats) == ESP_OK);
    CHECK(stats.triangles > 0);  // the mesh stands in for its surface
    const EspGraphBake asked = host.bake();
    REQUIRE(asked.key != 0);
    CHECK(asked.resolution == 64);
    CHECK(asked.indexCount == 6);
    CHECK(asked.positionCount == 4);

    SUBCASE("what the host gives is ground") {
        REQUIRE(espGiveGraphBake(host.context, host.graph, asked.key, ESPALIER_SQUARE, nullptr) == ESP_OK);
        host.update();
        CHECK(host.stats().seeds == 3);
        CHECK(host.bake().key == 0);
        REQUIRE(espGraphStats(host.context, host.graph, &stats) == ESP_OK);
        CHECK(stats.triangles == 0);
        const uint64_t hash = host.stats().hash;
        // Another mesh: the plants stand until it is ground, too.
        host.set("wall", "size", {1, 1, 2});
        CHECK(host.stats().hash == hash);
        const uint64_t other = host.bake().key;
        CHECK(other != 0);
        CHECK(other != asked.key);
        // Nobody asks for the first any more, and then for it again: it still stands.
        host.set("wall", "size", {1, 1, 1});
        CHECK(host.bake().key == 0);
        CHECK(host.stats().hash == hash);
    }
    SUBCASE("why it can't be is told, and the mesh stays") {
        REQUIRE(espGiveGraphBake(host.context, host.graph, asked.key, nullptr, "the disk is full") == ESP_OK);
        host.update();
        CHECK(host.failures().find("ground: the disk is full") != std::string::npos);
        CHECK(host.bake().key == 0);
        CHECK(espGiveGraphBake(host.context, host.graph, 77, ESPALIER_SQUARE, nullptr) == ESP_OK);  // nobody asks
        CHECK(espGiveGraphBake(host.context, host.graph, asked.key, nullptr, nullptr) == ESP_INVALID_ARGUMENT);
    }
    SUBCASE("a file that is no surface is told") {
        host.write("no.glb", "no surface");
        const std::string file = (host.folder / "no.glb").string();
        CHECK(espGiveGraphBake(host.context, host.graph, asked.key, file.c_str(), nullptr) != ESP_OK);
        host.update();
        CHECK(host.failures().find("no.glb") != std::string::npos);
    }
}

}  // namespace
