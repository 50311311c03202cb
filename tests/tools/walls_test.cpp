// A town's walls as ground: judged against all that the same grammar makes, as triangles.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/tools/program.hpp"

namespace {

using Point = std::array<float, 3>;

struct House {
    std::string name;
    std::vector<Point> corners;  // three a triangle
};

// Of the files that espalier-bake writes for towns: a node a house, positions and indices of one primitive.
std::vector<House> readTown(const std::string& path) {
    const std::string bytes = readAll(path);
    REQUIRE(bytes.size() > 20);
    uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    const auto json = nlohmann::json::parse(bytes.substr(20, length));
    const char* binary = bytes.data() + 20 + length + 8;
    const auto begin = [&](int accessor) {
        const auto& view = json["bufferViews"][json["accessors"][size_t(accessor)]["bufferView"].get<size_t>()];
        return binary + view["byteOffset"].get<size_t>();
    };
    std::vector<House> houses;
    for (const auto& mesh : json["meshes"]) {
        const auto& primitive = mesh["primitives"][0];
        const int indices = primitive["indices"];
        House house{mesh["name"], {}};
        for (size_t i = 0; i < json["accessors"][size_t(indices)]["count"].get<size_t>(); ++i) {
            uint32_t index = 0;
            std::memcpy(&index, begin(indices) + 4 * i, 4);
            Point p;
            std::memcpy(p.data(), begin(primitive["attributes"]["POSITION"]) + 12 * size_t(index), 12);
            house.corners.push_back(p);
        }
        houses.push_back(house);
    }
    return houses;
}

// Twice the area to the left of a-b-c, seen along z.
float turn(const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
}

}  // namespace

TEST_CASE("walls as ground have none where windows and doors stand out, and stand where the house's do") {
    const Folder folder;
    folder.write("plan.json", R"({"buildings": [
 {"id": "a", "outer": [[0, 0], [14, 0], [14, 9], [0, 9]], "roof:shape": "hipped", "roof:material": "slate", "building:levels": 2},
 {"id": "b", "outer": [[20, 0], [30, 0], [30, 8], [20, 8]], "building:levels": 1}]})");
    const std::string bake = "cd " + folder.path.string() + " && " + program("espalier-bake") +
                             " plan.json -q --grammar " + content("grammars/town.grammar");
    const Ran walls = run(bake + " --house a --walls -o walls.glb"), all = run(bake + " -o all.glb");
    REQUIRE_MESSAGE(walls.code == 0, walls.output);
    REQUIRE_MESSAGE(all.code == 0, all.output);
    const std::vector<House> ground = readTown(folder.file("walls.glb")), town = readTown(folder.file("all.glb"));
    REQUIRE(ground.size() == 1);
    REQUIRE(ground[0].name == "a");
    REQUIRE(town.size() == 2);

    // The wall towards the south, at z = 0.
    constexpr float kLength = 14, kPlinth = .6f, kHeight = 2 * 2.9f;
    std::vector<std::array<Point, 3>> south;
    double area = 0;
    for (size_t i = 0; i + 2 < ground[0].corners.size(); i += 3) {
        const std::array<Point, 3> t{ground[0].corners[i], ground[0].corners[i + 1], ground[0].corners[i + 2]};
        for (const Point& p : t)
            CHECK((p[0] > -.2f && p[0] < kLength + .2f && p[1] > -.01f && p[2] < .2f && p[2] > -9.2f));
        if (t[0][2] < 0 || t[1][2] < 0 || t[2][2] < 0) continue;
        if (turn(t[0], t[1], t[2]) <= 1e-6f) continue;  // a ledge
        area += .5 * turn(t[0], t[1], t[2]);
        south.push_back(t);
    }
    CHECK(area > .4 * kLength * kHeight);
    CHECK(area < .97 * kLength * kHeight);

    size_t standOut = 0, covered = 0;
    for (const Point& p : town[0].corners) {
        if (p[2] < .025f || p[2] > .25f || p[1] < kPlinth || p[1] > kHeight - .8f || p[0] < .5f || p[0] > kLength - .5f)
            continue;
        ++standOut;
        for (const auto& t : south)
            if (turn(t[0], t[1], p) >= 0 && turn(t[1], t[2], p) >= 0 && turn(t[2], t[0], p) >= 0) {
                ++covered;
                break;
            }
    }
    CHECK(standOut > 100);
    CHECK(covered == 0);

    const Ran unknown = run(bake + " --house nobody -o x.glb");
    CHECK(unknown.code == 1);
    CHECK(contains(unknown.output, "plan.json: holds no building 'nobody'"));
    const Ran bare =
        run("cd " + folder.path.string() + " && " + program("espalier-bake") + " plan.json --walls -o x.glb");
    CHECK(bare.code == 2);
    CHECK(contains(bare.output, "--walls requires --grammar"));
}

TEST_CASE("a town's triangles are the same in every run") {
    constexpr int kCorners = 720;  // of one house, whose walls several threads share
    const Folder folder;
    std::string outer;
    for (int i = 0; i < kCorners; ++i) {
        const double turn = 6.283185307179586 * i / kCorners;
        outer += (i > 0 ? ",[" : "[") + std::to_string(60 * std::cos(turn)) + "," +
                 std::to_string(60 * std::sin(turn)) + "]";
    }
    folder.write("round.json",
                 R"({"buildings": [{"id": "a", "roof:shape": "flat", "height": 10, "outer": [)" + outer + "]}]}");
    folder.write("cells.grammar",
                 "House -> Extrude(wallHeight) {Wall, NULL}\n"
                 "Wall -> Repeat(XY, vec2(0.2, 0.4), clip) {Cell}\n"
                 "Cell : rand() > 0.5 -> Shape(\"slate\")\n"
                 "Cell -> NULL\n");
    std::string first;
    for (int i = 0; i < 3; ++i) {
        const Ran ran = run("cd " + folder.path.string() + " && " + program("espalier-bake") +
                            " round.json -q --grammar cells.grammar -o town.glb");
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        const std::string bytes = readAll(folder.file("town.glb"));
        if (i == 0) first = bytes;
        CHECK((bytes == first));
    }
}

TEST_CASE("each footprint that is mended or left out is told of with its file") {
    const Folder folder;
    folder.write("plan.json", R"({"buildings": [{"id": "crossed", "outer": [[0, 0], [10, 0], [0, 8], [10, 8]]},
        {"id": "line", "outer": [[20, 0], [30, 0]]}, {"id": "thin", "outer": [[40, 0], [50, 0], [50, 0.00001]]}]})");
    const Ran ran = run("cd " + folder.path.string() + " && " + program("espalier-bake") + " plan.json -q -o town.glb");
    CHECK_MESSAGE(ran.code == 0, ran.output);
    for (const char* house : {"crossed", "line", "thin"})
        CHECK_MESSAGE(contains(ran.output, std::string("plan.json: warning: ") + house + ": "), ran.output);
}

TEST_CASE("outlines of very many corners without a turn are done in time, and leave four corners of each") {
    const Folder folder;
    std::string plan = "{\"buildings\": [";
    for (int house = 0; house < 20; ++house) {
        plan += std::string(house ? ", " : "") + "{\"id\": \"h" + std::to_string(house) + "\", \"outer\": [";
        const double corner[4][2] = {{0, 0}, {400, 0}, {400, 300}, {0, 300}};
        for (int side = 0; side < 4; ++side)
            for (int i = 0; i < 4900; ++i) {
                const double *a = corner[side], *b = corner[(side + 1) % 4], t = i / 4900.0;
                plan += (side + i ? ", [" : "[") + std::to_string(500 * house + a[0] + t * (b[0] - a[0])) + "," +
                        std::to_string(a[1] + t * (b[1] - a[1])) + "]";
            }
        plan += "]}";
    }
    folder.write("plan.json", plan + "]}");
    // Seconds of the processor's, which a busy machine has no part in.
    const Ran ran =
        run("ulimit -t 6; cd " + folder.path.string() + " && " + program("espalier-bake") + " plan.json -o town.glb");
    CHECK_MESSAGE(ran.code == 0, ran.output);
    CHECK_MESSAGE(contains(ran.output, "20 houses, 280 triangles"), ran.output);
}

TEST_CASE("a town that a limit cut short is written all the same, and how much of it was is told") {
    const Folder folder;
    folder.write("plan.json", R"({"buildings": [{"id": "a", "outer": [[0, 0], [8, 0], [8, 6], [0, 6]]}]})");
    for (const auto& [most, ended] : {std::pair("10", false), {"100", true}}) {
        folder.write("steps.grammar", std::string("House -> Extrude(wallHeight) {Wall, NULL}\n"
                                                  "Wall -> Step(0)\n"
                                                  "Step(n) : n < ") +
                                          most + " -> Step(n + 1) Shape(\"slate\")\nStep(n) -> NULL\n");
        const Ran ran = run("cd " + folder.path.string() + " && " + program("espalier-bake") +
                            " plan.json --grammar steps.grammar -o town.glb");
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        const bool told = ran.output.find("steps.grammar: warning: a limit ended 4 shapes") != std::string::npos;
        CHECK_MESSAGE(told == ended, ran.output);
        CHECK(std::filesystem::file_size(folder.file("town.glb")) > 0);
    }
}

TEST_CASE("walls as ground go up gables to a little below the verges, also where the roof breaks") {
    const Folder folder;
    folder.write("plan.json", R"({"buildings": [
 {"id": "gabled", "outer": [[0, 0], [8, 0], [8, 14], [0, 14]], "roof:shape": "gabled", "roof:angle": 45, "building:levels": 1},
 {"id": "gambrel", "outer": [[20, 0], [28, 0], [28, 14], [20, 14]], "roof:shape": "gambrel", "building:levels": 1},
 {"id": "mansard", "outer": [[40, 0], [48, 0], [48, 14], [40, 14]], "roof:shape": "mansard", "building:levels": 1,
  "edges": [{"edge": 0, "gable": true}, {"edge": 2, "gable": true}]}]})");
    const Ran walls = run("cd " + folder.path.string() + " && " + program("espalier-bake") +
                          " plan.json -q --grammar " + content("grammars/town.grammar") + " --walls -o walls.glb");
    REQUIRE_MESSAGE(walls.code == 0, walls.output);
    const std::vector<House> ground = readTown(folder.file("walls.glb"));

    // Gables 8 m wide at z = 0 and z = -14. Roofs rise over the eaves as fast as `below` until `inward`, then as
    // `above`.
    constexpr float kEave = 3, kFree = .3f;
    struct Roof {
        float middle, inward, below, above;
        float operator()(float x) const {
            const float in = std::max(4 - std::abs(x - middle), 0.f);
            return kEave + below * std::min(in, inward) + above * std::max(in - inward, 0.f);
        }
    };
    const Roof roofs[] = {{4, 4, 1, 0}, {24, 2, 1.732f, .577f}, {44, 2.4f / 2.747f, 2.747f, .364f}};
    REQUIRE(ground.size() == std::size(roofs));
    for (size_t house = 0; house < ground.size(); ++house) {
        CAPTURE(ground[house].name);
        const Roof& roof = roofs[house];
        const float ridge = roof(roof.middle), broken = roof(roof.middle - 4 + roof.inward);
        const double whole = double((8 - roof.inward) * (broken - kEave) + (4 - roof.inward) * (ridge - broken));
        float highest[2] = {};
        double area[2] = {};
        for (size_t i = 0; i + 2 < ground[house].corners.size(); i += 3) {
            const Point* t = &ground[house].corners[i];
            for (int k = 0; k < 3; ++k) CHECK(t[k][1] < roof(t[k][0]) - kFree + .03f);
            const bool far = t[0][2] < -7;
            if (std::abs(t[0][2] - t[1][2]) > 1e-3f || std::abs(t[0][2] - t[2][2]) > 1e-3f) continue;
            const float out = far ? -1 : 1;
            CHECK(out * turn(t[0], t[1], t[2]) > 0);
            const float lowest = std::min({t[0][1], t[1][1], t[2][1]});
            highest[far] = std::max({highest[far], t[0][1], t[1][1], t[2][1]});
            if (lowest > kEave - kFree - 1e-3f) area[far] += .5 * double(out * turn(t[0], t[1], t[2]));
        }
        for (int end : {0, 1}) {
            CAPTURE(end);
            CHECK(highest[end] > ridge - kFree - .02f);
            CHECK(area[end] > .8 * whole);  // a window may be in it
            CHECK(area[end] < whole + .1);
        }
    }
}
