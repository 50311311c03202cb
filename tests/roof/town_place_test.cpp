// Coordinates of towns: metre grids, plans far from their origin, both sides of the antimeridian.
#include <nlohmann/json.hpp>

#include "runtime/roof/footprint_crs.hpp"
#include "tests/roof/town_support.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

std::string square(double x, double y, double width, double depth, const std::string& crs) {
    nlohmann::json ring{{x, y}, {x + width, y}, {x + width, y + depth}, {x, y + depth}, {x, y}};
    nlohmann::json document{{"type", "FeatureCollection"},
                            {"features",
                             {{{"type", "Feature"},
                               {"id", "a"},
                               {"properties", {{"building", "yes"}}},
                               {"geometry", {{"type", "Polygon"}, {"coordinates", nlohmann::json::array({ring})}}}}}}};
    if (!crs.empty()) document["crs"] = {{"type", "name"}, {"properties", {{"name", crs}}}};
    return document.dump();
}
std::string refusal(const std::string& text) {
    Result<Town> read = parseFootprints(text, "town.geojson");
    return read ? "" : read.failure().text();
}
double areaOf(const RoofStructure& roofs) {
    double twice = 0;
    const auto& ring = roofs.houses.at(0).rings[0];
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice / 2;
}
glm::dvec2 sizeOf(const Footprint& f) {
    glm::dvec2 low(INFINITY), high(-INFINITY);
    for (glm::dvec2 p : f.rings[0]) low = glm::min(low, p), high = glm::max(high, p);
    return high - low;
}

}  // namespace

TEST_CASE("metre grids agree with what their surveys publish") {
    const auto at = [](int epsg, double x, double y, double longitude, double latitude) {
        INFO(epsg);
        const glm::dvec2 p = CoordinateSystem::of(epsg)->toDegrees({x, y});
        CHECK(p.x == doctest::Approx(longitude).epsilon(1e-12).scale(1e5));  // 1e-7 degrees: a centimetre
        CHECK(p.y == doctest::Approx(latitude).epsilon(1e-12).scale(1e5));
    };
    // IOGP's guidance note 7-2.
    at(27700, 577274.99, 69740.50, 0.5, 50.5);
    at(28992, 196105.283, 557057.739, 6, 53);
    const glm::dvec2 belgian = CoordinateSystem::of(31370)->toDegrees({251763.20, 153034.13});  // of a sister grid
    CHECK(belgian.x == doctest::Approx(5 + 48 / 60. + 26.533 / 3600).epsilon(1e-7));
    CHECK(belgian.y == doctest::Approx(50 + 40 / 60. + 46.461 / 3600).epsilon(1e-7));
    // By definition.
    at(2154, 700000, 6600000, 3, 46.5);
    at(32632, 500000, 0, 9, 0);
    at(25833, 500000, 0, 15, 0);
    at(32733, 500000, 10000000, 15, 0);
    at(3857, 20037508.342789244, 0, 180, 0);
    at(31467, 3500000, 0, 9, 0);
    // By PROJ 9.1, without a change of datum.
    at(31468, 4468223.635, 5333260.550, 11.573, 48.1375);
    at(4647, 32691416.687, 5334784.917, 11.573, 48.1375);
    at(23031, 431210.515, 4581915.117, 2.1773, 41.3851);
    at(3949, 1652300.165, 8183524.371, 2.35, 48.85);
    CHECK(!CoordinateSystem::of(5514));
    CHECK(epsgOf("urn:ogc:def:crs:EPSG::25832") == 25832);
    CHECK(epsgOf("urn:ogc:def:crs:EPSG:6.9:28992") == 28992);
    CHECK(epsgOf("http://www.opengis.net/def/crs/EPSG/0/3857") == 3857);
    CHECK(epsgOf("urn:ogc:def:crs:OGC:1.3:CRS84") == 4326);
    CHECK(epsgOf("ESRI:102100") == 102100);
    CHECK(!epsgOf("urn:ogc:def:crs:IGNF:LAMB93"));
}

TEST_CASE("a town in a metre grid is as large as in degrees") {
    // At 48 degrees Web Mercator's metres are half as long again.
    const double k = 1 / std::cos(48 * 3.14159265358979 / 180);
    for (const auto& [crs, x, y, width, depth] :
         {std::tuple("urn:ogc:def:crs:EPSG::25832", 691603., 5334760., 12., 8.),
          std::tuple("EPSG:32632", 691603., 5334760., 12., 8.),
          std::tuple("EPSG:3857", 1288000., 6106854.8, 12 * k, 8 * k),
          std::tuple("EPSG:28992", 85000., 447000., 12., 8.), std::tuple("EPSG:27700", 530000., 180000., 12., 8.),
          std::tuple("EPSG:2154", 652000., 6862000., 12., 8.), std::tuple("EPSG:2056", 2683000., 1248000., 12., 8.)}) {
        INFO(crs);
        const GrownTown town = grown(square(x, y, width, depth, crs));
        const glm::dvec2 size = sizeOf(town.town.footprints.at(0));
        // Turned against the grid by up to some degrees, so that the bounds are a little larger.
        CHECK(areaOf(town.roofs) == doctest::Approx(96).epsilon(0.004));
        CHECK(size.x < 12.6);
        CHECK(town.town.geographic);
        CHECK(std::abs(town.town.origin.y - 49) < 5);
        CHECK(town.says(std::string("its crs is '") + crs + "', not WGS 84: its metres are brought to degrees"));
    }
}

TEST_CASE("coordinates that can't be brought to degrees are refused with the name of their crs") {
    CHECK(
        refusal(square(2, 3, 1, 1, "urn:ogc:def:crs:EPSG::31468")).find("'urn:ogc:def:crs:EPSG::31468', not WGS 84") !=
        std::string::npos);
    CHECK(refusal(square(691603, 5334760, 12, 8, "")).find("691603, 5334760, are not WGS 84's degrees") !=
          std::string::npos);
    CHECK(refusal(square(11, 48, .001, .001, "EPSG:25832")).find("look like degrees") != std::string::npos);
    CHECK(refusal(square(-740000, -1040000, 12, 8, "EPSG:5514")).find("'EPSG:5514', not WGS 84, and none that is") !=
          std::string::npos);
    CHECK(refusal(square(640000, 1600000, 12, 8, "EPSG:4559")).find("'EPSG:4559', but its coordinates") !=
          std::string::npos);
    CHECK(refusal(square(11, 48, .001, .001, "EPSG:4326")).empty());
    CHECK(grown(square(11, 48, .001, .001, "EPSG:4258")).says("'EPSG:4258', not WGS 84: its degrees are taken"));
    CHECK(refusal(R"({"crs":null,)" + square(11, 48, .001, .001, "").substr(1)).empty());
    if (const auto path = dataFile("reports/town_crs_origin.geojson")) {
        Result<Town> read = readFootprints(*path);
        REQUIRE(!read);
        CHECK(read.failure().text().find("EPSG::31468', not WGS 84") != std::string::npos);
    }
}

TEST_CASE("a town on both sides of the antimeridian is one town") {
    std::string all;
    // The last two as some programs write them, which go on beyond 180 degrees.
    for (const auto& [id, x, end] :
         {std::tuple("west", 179.9998, 179.9999), std::tuple("east", -179.9999, -179.9998),
          std::tuple("across", 179.99995, -179.99995), std::tuple("beyond", 180.0002, 180.0003),
          std::tuple("both", 179.99995, 180.00005)}) {
        char text[400];
        std::snprintf(
            text, sizeof text,
            R"(%s{"type":"Feature","id":"%s","properties":{},"geometry":{"type":"Polygon","coordinates":[[[%.6f,-17],[%.6f,-17],[%.6f,-16.9999],[%.6f,-16.9999],[%.6f,-17]]]}})",
            all.empty() ? "" : ",", id, x, end, end, x, x);
        all += text;
    }
    const GrownTown town = grown(R"({"type":"FeatureCollection","features":[)" + all + "]}");
    REQUIRE(town.roofs.houses.size() == 5);
    CHECK(std::abs(town.town.origin.x) > 179.9);
    for (const Footprint& f : town.town.footprints) {
        INFO(f.id);
        CHECK(sizeOf(f).x == doctest::Approx(10.65).epsilon(0.01));
        CHECK(std::abs(f.rings[0][0].x) < 50);
    }
    CHECK(town.said.empty());
}

TEST_CASE("a plan far from its origin stands near the town's own") {
    const auto judge = [](const GrownTown& town) {
        const RoofHouse& house = town.roofs.houses.at(0);
        glm::dvec2 low(INFINITY), high(-INFINITY);
        for (glm::dvec2 p : house.rings[0]) low = glm::min(low, p), high = glm::max(high, p);
        CHECK(high.x - low.x == doctest::Approx(10.25).epsilon(1e-5));
        CHECK(high.y - low.y == doctest::Approx(9.35).epsilon(1e-5));
        CHECK(glm::length(house.origin) < 20);
        CHECK(!town.town.geographic);
        CHECK(glm::distance(town.town.origin, {691603, 5334760}) < 20);
    };
    judge(grown(R"({"buildings":[{"id":"l","outer":[[691603,5334760],[691613.25,5334760],[691613.25,5334764.1],
        [691607.2,5334764.1],[691607.2,5334769.35],[691603,5334769.35]]}]})"));
    if (const auto report = grownReport("town_utm_plan.json")) judge(*report);
    CHECK(grown(R"({"buildings":[{"outer":[[900,50],[910,50],[910,60],[900,60]]}]})").town.origin == glm::dvec2(0));
}
