// Which features of a town are houses, whichever program wrote the file.
#include "tests/roof/town_support.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A feature of its own place, a house of 12 by 8 m.
std::string feature(int place, const std::string& properties) {
    const double x = 11.57 + place * 4e-4, y = 48.13;
    char ring[300];
    std::snprintf(ring, sizeof ring, "[[[%.7f,%.7f],[%.7f,%.7f],[%.7f,%.7f],[%.7f,%.7f],[%.7f,%.7f]]]", x, y,
                  x + 1.614e-4, y, x + 1.614e-4, y + 7.19e-5, x, y + 7.19e-5, x, y);
    return "{\"type\":\"Feature\",\"id\":\"" + std::string(1, char('a' + place)) + "\",\"properties\":{" + properties +
           "},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":" + ring + "}}";
}
std::string collection(const std::vector<std::string>& properties) {
    std::string all;
    for (size_t i = 0; i < properties.size(); ++i) all += (i ? "," : "") + feature(int(i), properties[i]);
    return "{\"type\":\"FeatureCollection\",\"features\":[" + all + "]}";
}

}  // namespace

TEST_CASE("of a town's file only buildings are houses, and one line counts the rest") {
    const GrownTown town = grown(
        collection({R"("building":"house")", R"("natural":"water")", R"("building":"no","leisure":"pitch")",
                    R"("landuse":"residential")", R"("amenity":"school")", R"("building:part":"yes")", R"("name":"x")",
                    R"("building":"yes","amenity":"school")", R"("demolished:building":"yes")", R"("building":null)"}));
    CHECK(town.ids() == "a f h ");
    CHECK(town.said.size() == 1);
    CHECK(
        town.says("7 features are no houses: left out (3 no tag building, 1 amenity=school, 1 building=no, "
                  "1 landuse=residential, 1 natural=water)"));
    if (const auto report = grownReport("town_no_building.geojson")) CHECK(report->ids() == "way/1 ");
}

TEST_CASE("what lies below the ground is no house, whatever layer a house is drawn in") {
    const GrownTown town = grown(collection(
        {R"("building":"yes","location":"underground")", R"("building":"yes","layer":"-1")",
         R"("building":"yes","layer":"-1","building:levels":"3")", R"("building":"yes","layer":-1,"height":"9 m")",
         R"("building":"yes","building:levels":"0","building:levels:underground":"2")",
         R"("building":"yes","building:levels":"2","building:levels:underground":"1")",
         R"("building":"yes","layer":"1")", R"("building":"yes","layer":"-1","location":"overground")",
         R"("building":"demolished")", R"("building":"parking","parking":"underground")"}));
    CHECK(town.ids() == "c d f g h ");
    CHECK(town.says("5 features are no houses: left out (4 underground, 1 building=demolished)"));
    if (const auto report = grownReport("town_below_ground.geojson")) CHECK(report->ids() == "way/1 ");
}

TEST_CASE("footprints of a file that knows no tag building are houses, but not areas of another kind") {
    CHECK(grown(collection({"", R"("OBJECTID":7,"height":9)", R"("class":"house","num_floors":3)"})).ids() == "a b c ");
    const GrownTown areas = grown(collection({R"("natural":"water")", R"("parcel":12)", R"("amenity":"school")"}));
    CHECK(areas.ids() == "b ");
    CHECK(areas.says("2 features are no houses"));
}

TEST_CASE("tags as other programs write them") {
    const GrownTown town = grown(collection({
        R"("@id":"way/1","building":"yes","building:levels":"3","roof:shape":"gabled")",  // Overpass turbo
        R"("id":1,"type":"way","tags":{"building":"yes","building:levels":"3","roof:shape":"gabled"})",  // osmtogeojson
        R"("osm_id":"1","building":"yes","other_tags":"\"building:levels\"=>\"3\",\"roof:shape\"=>\"gabled\"")",  // GDAL
        R"("full_id":"w1","building":"yes","building:levels":"3","roof:shape":"gabled","height":"")",  // QuickOSM, QGIS
        R"("element":"way","building":"yes","building:levels":"3","roof:shape":"gabled","height":null)",  // OSMnx
        R"("building":"yes","building_levels":3,"roof_shape":"gabled")",                                  // tables
        R"("building":true,"all_tags":"{\"building:levels\":\"3\",\"roof:shape\":\"gabled\"}")",
    }));
    REQUIRE(town.town.footprints.size() == 7);
    for (const Footprint& f : town.town.footprints) {
        INFO(f.id);
        CHECK(f.levels == 3);
        CHECK(f.shape == RoofShape::gable);
        CHECK(!f.height);
    }
    CHECK(town.said.empty());
    // Overture
    const GrownTown other = grown(collection(
        {R"("subtype":"residential","class":"house","height":9.5,"num_floors":2,"roof_shape":"half_hipped","roof_direction":90,
            "roof_height":3,"roof_color":"#804020","min_height":1,"has_parts":false,"is_underground":false)",
         R"("is_underground":true)", R"("theme":"base","type":"land_use","class":"park")"}));
    REQUIRE(other.ids() == "a ");
    const Footprint& f = other.town.footprints[0];
    CHECK(f.shape == RoofShape::halfHip);
    CHECK(f.height == 9.5);
    CHECK(f.roofHeight == 3);
    CHECK(f.baseHeight == 1);
    CHECK(f.direction.value() == doctest::Approx(1.5707963));
    CHECK(f.colour == 0xff204080u);
}

TEST_CASE("closed ways that a program wrote as lines are outlines, points are counted") {
    const std::string line =
        R"({"type":"Feature","id":"w","properties":{"building":"yes"},"geometry":{"type":"LineString",
        "coordinates":[[11.5,48],[11.5002,48],[11.5002,48.0001],[11.5,48.0001],[11.5,48]]}})";
    const std::string open = R"({"type":"Feature","properties":{"building":"yes"},"geometry":{"type":"LineString",
        "coordinates":[[11.5,48],[11.5002,48],[11.5002,48.0001],[11.5,48.0001]]}})";
    const std::string point =
        R"({"type":"Feature","properties":{"building":"yes"},"geometry":{"type":"Point","coordinates":[11.5,48]}})";
    const GrownTown town =
        grown("{\"type\":\"FeatureCollection\",\"features\":[" + line + "," + open + "," + point + "]}");
    CHECK(town.ids() == "w ");
    CHECK(town.says("2 features are no houses: left out (1 LineString, 1 Point)"));
    CHECK(
        grown(
            R"({"type":"FeatureCollection","features":[)" + line +
            R"(,{"id":"x","type":"Feature","properties":{"building":"yes"},"geometry":{"type":"GeometryCollection","geometries":[]}}]})")
            .says("x: is a GeometryCollection, not a Polygon"));
}

TEST_CASE("lengths as people write them") {
    for (auto [text, metres] :
         {std::pair(R"("12")", 12.0), std::pair("12.5", 12.5), std::pair(R"("12,5")", 12.5),
          std::pair(R"("12 m")", 12.0), std::pair(R"("12m")", 12.0), std::pair(R"("40 ft")", 12.192),
          std::pair(R"("40'")", 12.192), std::pair(R"("12'6\"")", 3.81), std::pair(R"("12' 6\"")", 3.81),
          std::pair(R"("12 ft 6 in")", 3.81), std::pair(R"("12'-6\"")", 3.81), std::pair(R"("250 cm")", 2.5),
          std::pair(R"("12′6″")", 3.81), std::pair(R"("40 feet")", 12.192), std::pair(R"("12 metres")", 12.0),
          std::pair(R"(" 12 ")", 12.0), std::pair(R"("+12")", 12.0)}) {
        INFO(text);
        const GrownTown town = grown(collection({std::string(R"("building":"yes","height":)") + text}));
        CHECK(town.town.footprints[0].height.value_or(0) == doctest::Approx(metres));
        CHECK(town.said.empty());
    }
    for (const char* text :
         {R"("12 bananas")", R"("12'13\"")", R"("12'6")", R"("m")", R"("12;15")", R"("12m6\"")", R"("10-12")"}) {
        INFO(text);
        CHECK(grown(collection({std::string(R"("building":"yes","height":)") + text})).says("height is not a number"));
    }
}
