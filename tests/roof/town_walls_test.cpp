// Walls that neighbours share: roofs end there, and nothing looks into a neighbour.
#include "runtime/roof/check.hpp"
#include "tests/roof/town_support.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

struct Box {
    const char* id;
    double x, y, width, depth;
    std::string tags = "";
};
std::string plan(const std::vector<Box>& boxes) {
    std::string all;
    for (const Box& b : boxes) {
        char text[300];
        std::snprintf(text, sizeof text, R"(%s{"id":"%s","outer":[[%.4f,%.4f],[%.4f,%.4f],[%.4f,%.4f],[%.4f,%.4f]])",
                      all.empty() ? "" : ",", b.id, b.x, b.y, b.x + b.width, b.y, b.x + b.width, b.y + b.depth, b.x,
                      b.y + b.depth);
        all += text + std::string(b.tags.empty() ? "" : ",") + b.tags + "}";
    }
    return "{\"buildings\":[" + all + "]}";
}
// The height that a neighbour covers of the wall over the middle of which this is: metres from its foot.
float coveredAt(const RoofHouse& house, glm::dvec2 middle) {
    size_t edge = 0;
    for (const auto& ring : house.rings)
        for (size_t i = 0; i < ring.size(); ++i, ++edge) {
            const glm::dvec2 a = house.origin + glm::dvec2(ring[i]),
                             b = house.origin + glm::dvec2(ring[(i + 1) % ring.size()]);
            if (glm::distance((a + b) / 2.0, middle) < 0.1) return house.shared.empty() ? 0 : house.shared[edge];
        }
    FAIL("no wall there");
    return 0;
}

}  // namespace

TEST_CASE("houses in a row end in gables at the walls that they share") {
    for (const char* shape : {"", R"("roof:shape":"gabled")", R"("roof:shape":"hipped")", R"("roof:shape":"gambrel")",
                              R"("roof:shape":"mansard")", R"("roof:shape":"half-hipped")"})
        for (const double gap : {0.0, 0.04, -0.04, 0.2}) {
            INFO(shape << gap);
            std::vector<Box> boxes;
            for (int i = 0; i < 4; ++i)
                boxes.push_back({i == 0 ? "a" : i == 1 ? "b" : i == 2 ? "c" : "d", i * (6 + gap), 0, 6, 10, shape});
            const GrownTown town = grown(plan(boxes));
            REQUIRE(town.roofs.houses.size() == 4);
            for (int i = 0; i < 4; ++i) {
                const RoofHouse& house = town.roofs.houses[size_t(i)];
                const double west = i * (6 + gap), east = west + 6;
                if (i > 0) CHECK(gableAt(town.roofs, house, {west, 5}));
                if (i < 3) CHECK(gableAt(town.roofs, house, {east, 5}));
                CHECK(coveredAt(house, {west, 5}) == (i > 0 ? kEndsRoof : 0));
                CHECK(coveredAt(house, {east, 5}) == (i < 3 ? kEndsRoof : 0));
                CHECK(coveredAt(house, {west + 3, 0}) == 0);
                CHECK(!gableAt(town.roofs, house, {west + 3, 0}));
            }
        }
}

TEST_CASE("neighbours of other heights: a row's roofs end at both, a garage leaves the house its eaves") {
    const GrownTown row =
        grown(plan({{"low", 0, 0, 7, 9, R"("building:levels":2)"}, {"high", 7, 0, 7, 9, R"("building:levels":3)"}}));
    CHECK(gableAt(row.roofs, row.house("low"), {7, 4.5}));
    CHECK(gableAt(row.roofs, row.house("high"), {7, 4.5}));
    // Windows may look out over the lower roof, but not at its walls.
    CHECK(coveredAt(row.house("high"), {7, 4.5}) > 6);
    CHECK(coveredAt(row.house("high"), {7, 4.5}) < 10);
    const GrownTown garage = grown(
        plan({{"house", 0, 0, 14, 9, R"("building:levels":3)"}, {"garage", 14, 1, 4, 6, R"("building:levels":1)"}}));
    CHECK(gableAt(garage.roofs, garage.house("garage"), {14, 4}));
    CHECK(!gableAt(garage.roofs, garage.house("house"), {14, 4}));
    CHECK(coveredAt(garage.house("house"), {14, 0.5}) == 0);
    CHECK(coveredAt(garage.house("house"), {14, 4}) > 3);
    CHECK(coveredAt(garage.house("house"), {14, 8}) == 0);
    // A carport has no walls that cover any.
    const GrownTown carport = grown(plan({{"house", 0, 0, 14, 9}, {"port", 14, 1, 4, 6, R"("building":"carport")"}}));
    CHECK(coveredAt(carport.house("house"), {14, 4.5}) == 0);
}

TEST_CASE("a neighbour along a part of a long wall ends the roof there in a fire wall, and the rest keeps its eave") {
    const GrownTown town = grown(plan({{"long", 0, 0, 30, 10}, {"behind", 12, 10, 6, 8}}));
    const RoofHouse& house = town.house("long");
    CHECK(house.rings[0].size() == 6);
    CHECK(coveredAt(house, {15, 10}) == kEndsRoof);
    CHECK(coveredAt(house, {6, 10}) == 0);
    CHECK(coveredAt(house, {24, 10}) == 0);
    CHECK(!gableAt(town.roofs, house, {15, 10}));
    CHECK(gableAt(town.roofs, town.house("behind"), {15, 10}));
    // Of a wall that is shared for the most part the gable is the whole.
    const GrownTown staggered = grown(plan({{"a", 0, 0, 8, 10}, {"b", 8, 3, 8, 10}}));
    CHECK(gableAt(staggered.roofs, staggered.house("a"), {8, 5}));
    CHECK(gableAt(staggered.roofs, staggered.house("b"), {8, 8}));
}

TEST_CASE("a house between neighbours on all sides has a roof of its own kind") {
    const std::vector<Box> around{{"house", 0, 0, 10, 8},
                                  {"west", -10, 0, 10, 8},
                                  {"east", 10, 0, 10, 8},
                                  {"north", 0, 8, 10, 8},
                                  {"south", 0, -8, 10, 8}};
    for (const char* shape :
         {"hipped", "gabled", "half-hipped", "pyramidal", "skillion", "gambrel", "mansard", "flat"}) {
        INFO(shape);
        std::vector<Box> boxes = around;
        for (Box& b : boxes) b.tags = "\"roof:shape\":\"" + std::string(shape) + '"';
        const GrownTown town = grown(plan(boxes));
        REQUIRE(town.roofs.houses.size() == 5);
        CHECK(town.house("house").shape == town.town.footprints[0].shape);
        for (glm::dvec2 middle : {glm::dvec2(0, 4), {10, 4}, {5, 0}, {5, 8}})
            CHECK(coveredAt(town.house("house"), middle) == kEndsRoof);
        for (uint32_t h = 0; h < town.roofs.houses.size(); ++h) CHECK(checkRoof(town.roofs, h).empty());
    }
}

TEST_CASE("what stands on a house, beside it at a distance or across a corner shares no wall with it") {
    for (const Box& other : {Box{"x", 10.5, 0, 8, 8},
                             {"x", 10, 8, 8, 8},
                             {"x", 0, 0, 10, 8, R"("building:part":"yes","min_height":20,"height":30)"},
                             {"x", 10, 0, 8, 8, R"("min_height":20,"height":30)"},
                             {"x", 10, 7.7, 8, 8}}) {
        const GrownTown town = grown(plan({{"house", 0, 0, 10, 8, R"("building:part":"yes")"}, other}));
        INFO(other.x << " " << other.y << other.tags);
        for (float covered : town.house("house").shared) CHECK(covered == 0);
    }
}

TEST_CASE("reported party walls end in gables") {
    const auto town = grownReport("party_walls.geojson");
    if (!town) return;
    REQUIRE(town->roofs.houses.size() == 3);
    size_t closed = 0, gables = 0;
    for (const RoofHouse& house : town->roofs.houses) {
        std::vector<bool> gable(house.shared.size());
        for (uint32_t f = house.firstFace; f < house.firstFace + house.faceCount; ++f)
            if (town->roofs.faces[f].kind == FaceKind::gable) gable[town->roofs.faces[f].edge] = true;
        for (size_t e = 0; e < house.shared.size(); ++e) {
            closed += house.shared[e] == kEndsRoof;
            gables += house.shared[e] == kEndsRoof && gable[e];
        }
    }
    CHECK(closed == 4);
    CHECK(gables == 4);
}
