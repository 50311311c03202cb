// Heights of walls and roofs out of OpenStreetMap's tags, which count from the ground.
#include "tests/roof/town_support.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

std::string box(const char* id, double x, double width, double depth, const std::string& tags) {
    char text[300];
    std::snprintf(text, sizeof text, R"({"id":"%s","outer":[[%g,0],[%g,0],[%g,%g],[%g,%g]],)", id, x, x + width,
                  x + width, depth, x, depth);
    return text + tags + "}";
}
std::string plan(const std::vector<std::string>& boxes) {
    std::string all;
    for (const std::string& b : boxes) all += (all.empty() ? "" : ",") + b;
    return "{\"buildings\":[" + all + "]}";
}
void stands(const RoofHouse& h, double base, double eave, double ridge) {
    INFO(h.id);
    CHECK(h.baseHeight == doctest::Approx(base));
    CHECK(h.eaveHeight == doctest::Approx(eave));
    CHECK(h.ridgeHeight == doctest::Approx(ridge));
}

}  // namespace

TEST_CASE("storeys count from the ground, those below a part too") {
    const GrownTown town = grown(plan(
        {box("a", 0, 6, 4,
             R"("building:part":"yes","building:levels":"5","building:min_level":"2","roof:shape":"flat")"),
         box("b", 10, 6, 4, R"("building:part":"yes","building:levels":"4","min_height":"6","roof:shape":"flat")"),
         box("c", 20, 6, 4, R"("building:part":"yes","building:levels":"3","building:min_level":"3","roof:levels":"1",
             "roof:shape":"gabled")"),
         box("wrong", 30, 6, 4, R"("building:levels":"2","building:min_level":"5","roof:shape":"flat")")}));
    stands(town.house("a"), 6, 15, 15);
    stands(town.house("b"), 6, 12, 12);
    stands(town.house("c"), 9, 9, 12);
    stands(town.house("wrong"), 15, 21, 21);
    CHECK(town.says("wrong: building:levels counts from the ground"));
    if (const auto report = grownReport("town_levels_from_ground.json")) {
        stands(report->house("a"), 6, 15, 15);
        stands(report->house("b"), 6, 12, 12);
        stands(report->house("c"), 9, 9, 12);
    }
}

TEST_CASE("a roof is as high as its tag says, also where it leaves no wall") {
    const auto judge = [](const GrownTown& town) {
        stands(town.house("r"), 5.7, 5.7, 8.7);
        stands(town.house("c"), 0, 2, 8);
        stands(town.house("d"), 10, 10, 16);
    };
    judge(grown(plan(
        {box("r", 0, 12, 8,
             R"("building:part":"roof","min_height":"5.7","height":"8.7","roof:shape":"gabled","roof:height":"3")"),
         box("c", 20, 12, 8, R"("height":"8","roof:shape":"hipped","roof:height":"6")"),
         box("d", 40, 6, 6,
             R"("building:part":"yes","min_height":"10","height":"16","roof:shape":"pyramidal","roof:height":"6")")})));
    if (const auto report = grownReport("town_roof_part.json")) judge(*report);
    const GrownTown high = grown(plan({box("x", 0, 12, 8, R"("height":5,"roof:shape":"gabled","roof:height":7)")}));
    stands(high.house("x"), 0, 0, 5);
    CHECK(high.says("roof:height is more than the building's height"));
    // Where nothing says how high the roof is, walls keep a third.
    stands(grown(plan({box("y", 0, 12, 8, R"("height":3,"roof:shape":"gabled")")})).house("y"), 0, 1, 3);
}

TEST_CASE("a roof on posts has no walls, and stands on the ground") {
    const GrownTown town = grown(
        plan({box("canopy", 0, 12, 8, R"("building":"roof","height":"5","min_height":"4")"),
              box("carport", 20, 6, 4, R"("building":"carport")"),
              box("hall", 30, 12, 8, R"("building":"yes","wall":"no","height":5,"roof:shape":"gabled")"),
              box("barn", 50, 12, 8, R"("building":"roof","height":5,"min_height":"3.5","roof:shape":"gabled")"),
              box("house", 70, 6, 4, R"("building":"yes","walls":"yes")"),
              box("stand", 80, 12, 8, R"("building:part":"roof","min_height":7,"height":9,"roof:shape":"skillion")")}));
    CHECK(town.house("canopy").open);
    CHECK(town.house("canopy").shape == RoofShape::flat);
    stands(town.house("canopy"), 0, 5, 5);
    CHECK(town.house("carport").open);
    stands(town.house("carport"), 0, 3, 3);
    CHECK(town.house("hall").open);
    CHECK(town.house("hall").shape == RoofShape::gable);
    stands(town.house("barn"), 0, 3.5, 5);
    CHECK(!town.house("house").open);
    // Of a part that is only a roof, too, nothing is left to hang in the air below it.
    stands(town.house("stand"), 7, 7, 9);
    if (const auto report = grownReport("town_building_roof.geojson")) {
        CHECK(report->house("way/1").open);
        stands(report->house("way/1"), 0, 3.5, 5);
    }
}

TEST_CASE("a part on which another stands has a flat roof where nothing says what roof it has") {
    const std::string low = R"("building:part":"yes","height":"20")",
                      mid = R"("building:part":"yes","min_height":"20","height":"30")";
    const auto stacked = [&](const std::string& lower) {
        return "{\"buildings\":[" + box("low", 0, 10, 10, lower) +
               R"(,{"id":"mid","outer":[[2,2],[8,2],[8,8],[2,8]],)" + mid + "}]}";
    };
    CHECK(grown(stacked(low)).house("low").shape == RoofShape::flat);
    stands(grown(stacked(low)).house("low"), 0, 20, 20);
    CHECK(grown(stacked(low)).house("mid").shape == RoofShape::hip);
    CHECK(grown(stacked(R"("building:part":"yes","building:levels":6)")).house("low").shape == RoofShape::flat);
    CHECK(grown(stacked(low + R"(,"roof:shape":"hipped")")).house("low").shape == RoofShape::hip);
    CHECK(grown(stacked(R"("building:part":"yes","height":"9")")).house("low").shape == RoofShape::hip);
    // Beside each other they don't stand on each other.
    CHECK(grown(plan({box("low", 0, 10, 10, low), box("mid", 10, 10, 10, mid)})).house("low").shape == RoofShape::hip);
    if (const auto report = grownReport("stacked_parts_no_roof_shape.json"))
        CHECK(report->house("low").shape == RoofShape::flat);
}

TEST_CASE("a wide hall of which nothing says what roof it has has a low one") {
    const GrownTown town = grown(
        plan({box("hall", 0, 60, 40, R"("building":"industrial")"), box("house", 70, 12, 9, R"("building":"yes")"),
              box("church", 90, 40, 20, R"("building":"church","roof:shape":"gabled")"),
              box("tall", 140, 40, 20, R"("building":"yes","roof:angle":45)"),
              box("market", 190, 60, 60, R"("building":"retail","height":6)")}));
    const auto pitch = [&](const char* id) {
        for (const RoofFace& f : town.roofs.faces)
            if (town.roofs.houses[f.house].id == id && f.kind == FaceKind::slope)
                return std::atan(f.slope) * 180 / 3.14159265;
        return 0.0;
    };
    CHECK(pitch("hall") == doctest::Approx(10).epsilon(0.01));
    CHECK(pitch("house") == doctest::Approx(35).epsilon(0.01));
    CHECK(pitch("church") == doctest::Approx(35).epsilon(0.01));
    CHECK(pitch("tall") == doctest::Approx(45).epsilon(0.01));
    stands(town.house("market"), 0, 4, 6);
}
