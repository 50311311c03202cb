// Reading towns: tags, degrees, and input that is broken in every way.
#include <doctest/doctest.h>

#include <cmath>

#include "runtime/roof/shapes.hpp"
#include "tests/support/data.hpp"

using namespace espalier;

namespace {

const char* kSquare = R"([[[11.5,49.9],[11.5002,49.9],[11.5002,49.9001],[11.5,49.9001],[11.5,49.9]]])";

std::string feature(const std::string& tags, const std::string& rings = kSquare, const std::string& type = "Polygon") {
    return R"({"type":"Feature","id":"way/7","properties":{)" + tags + R"(},"geometry":{"type":")" + type +
           R"(","coordinates":)" + rings + "}}";
}
Town town(const std::string& text) {
    Result<Town> read = parseFootprints(text, "town.geojson");
    REQUIRE(bool(read));
    return *read;
}
bool says(const std::vector<Diagnostic>& all, const std::string& what) {
    for (const Diagnostic& d : all)
        if (toString(d).find(what) != std::string::npos) return true;
    return false;
}

}  // namespace

TEST_CASE("degrees become metres") {
    Town t = town(feature(""));
    REQUIRE(t.footprints.size() == 1);
    const auto& ring = t.footprints[0].rings[0];
    CHECK(ring.size() == 4);
    // Lengths of an arc second at 49.9 degrees: 0.0002 degrees of longitude are 14.36 m, 0.0001 of latitude 11.12 m.
    CHECK(glm::distance(ring[0], ring[1]) == doctest::Approx(14.37).epsilon(0.002));
    CHECK(glm::distance(ring[1], ring[2]) == doctest::Approx(11.12).epsilon(0.002));
}

TEST_CASE("tags") {
    Town t = town(feature(R"("roof:shape":"mansard","height":"12 m","building:levels":"3","roof:height":4.5,
        "roof:angle":"60°","roof:direction":"NE","roof:orientation":"across","roof:material":"slate","roof:colour":"#a04030")"));
    const Footprint& f = t.footprints[0];
    CHECK(f.id == "way/7");
    CHECK(f.shape == RoofShape::mansard);
    CHECK(f.height.value() == 12);
    CHECK(f.levels.value() == 3);
    CHECK(f.roofHeight.value() == 4.5);
    CHECK(f.slope.value() == doctest::Approx(std::tan(60 * 3.14159265 / 180)));
    CHECK(f.direction.value() == doctest::Approx(3.14159265 / 4));
    CHECK(f.orientation == RidgeOrientation::across);
    CHECK(f.material == RoofMaterial::slate);
    CHECK(f.colour == 0xff3040a0u);
    CHECK(t.diagnostics.empty());
    CHECK(town(feature(R"("roof:colour":"red","roof:direction":"200")")).footprints[0].colour == 0xff0000ffu);
}

TEST_CASE("tags that can't be meant are named and left out") {
    for (auto [tag, cause] :
         {std::pair(R"("height":-5)", "height is -5, not between"),
          std::pair(R"("height":"high")", "height is not a number"), std::pair(R"("height":1e400)", ""),
          std::pair(R"("building:levels":"-2")", "building:levels is -2"),
          std::pair(R"("roof:height":-1)", "roof:height is -1"), std::pair(R"("roof:angle":95)", "roof:angle is 95"),
          std::pair(R"("roof:angle":"nan")", "roof:angle is not a number"),
          std::pair(R"("roof:shape":"pagoda")", "roof:shape 'pagoda' is unknown"),
          std::pair(R"("roof:shape":5)", "roof:shape is not a text"),
          std::pair(R"("roof:shape":"onion")", "the nearest shape instead"),
          std::pair(R"("roof:orientation":"up")", "neither along nor across"),
          std::pair(R"("roof:direction":"left")", "neither degrees nor a compass point"),
          std::pair(R"("roof:material":"jam")", "roof:material 'jam' is unknown"),
          std::pair(R"("roof:colour":"#12345g")", "neither #rrggbb nor a known name"),
          std::pair(R"("roof:glitter":"yes")", "roof:glitter is not known"),
          std::pair(R"("edges":7)", "edges is not a list"), std::pair(R"("edges":[{"edge":9}])", "names edge 9 of 4"),
          std::pair(R"("edges":[{"gable":true}])", "without the number of its edge"),
          std::pair(R"("edges":[{"edge":1,"angle":-3}])", "an angle that is not between")}) {
        INFO(tag);
        Result<Town> read = parseFootprints(feature(tag), "town.geojson");
        if (!*cause) {
            CHECK(!read);  // no double holds it: the JSON itself is refused
            continue;
        }
        REQUIRE(bool(read));
        CHECK(says(read->diagnostics, cause));
        CHECK(says(read->diagnostics, "town.geojson: warning: way/7: "));
        std::vector<Diagnostic> said;
        CHECK(roofsOf(read->footprints, said).houses.size() == 1);
    }
}

TEST_CASE("edges of their own") {
    Town t = town(R"({"buildings":[{"id":"a","outer":[[0,0],[12,0],[12,8],[0,8]],"roof:shape":"hipped",
        "edges":[{"edge":1,"gable":true},{"edge":2,"angle":60}]}]})");
    std::vector<Diagnostic> said;
    RoofStructure roof = roofsOf(t.footprints, said);
    REQUIRE(roof.houses.size() == 1);
    int gables = 0;
    for (const RoofFace& f : roof.faces) {
        gables += f.kind == FaceKind::gable && f.edge == 1;
        if (f.edge == 2) CHECK(f.slope == doctest::Approx(std::sqrt(3.0)));
    }
    CHECK(gables == 1);
}

TEST_CASE("one bad feature leaves the rest of the town standing") {
    std::string good = feature("");
    for (auto [bad, cause] :
         {std::pair(feature("", "[[[500,49.9],[11.5002,49.9],[11.5002,49.9001]]]"), "out of range"),
          std::pair(feature("", "[[[11.5,99],[11.5002,49.9],[11.5002,49.9001]]]"), "out of range"),
          std::pair(feature("", "[[[11.5,49.9],[11.5002,49.9]]]"), "fewer than three corners"),
          std::pair(feature("", R"([[["a","b"],[11.5002,49.9],[11.5,49.8]]])"), "isn't two numbers"),
          std::pair(feature("", "[[[11.5],[11.5002,49.9],[11.5,49.8]]]"), "isn't two numbers"),
          std::pair(feature("", "[]"), "has no rings"), std::pair(feature("", "5"), "has no coordinates"),
          std::pair(feature("", "[11.5,49.9]", "Point"), "1 feature is no house: left out (1 Point)"),
          std::pair(std::string(R"({"type":"Feature","id":"way/7"})"), "has no geometry"),
          std::pair(std::string(R"({"type":"Feature","id":"way/7","geometry":null})"), "has no geometry"),
          std::pair(std::string("17"), "is not an object"),
          std::pair(feature("", "[[[-70,10],[-70.0002,10],[-70.0002,10.0001]]]"), "more than 100 km")}) {
        INFO(cause);
        Town t = town(R"({"type":"FeatureCollection","features":[)" + good + "," + bad + "," + good + "]}");
        CHECK(t.footprints.size() == 2);
        CHECK(says(t.diagnostics, cause));
        CHECK(t.diagnostics.size() == 1);
    }
}

TEST_CASE("parts of a building stand for its outline") {
    auto box = [](const char* id, double x0, double x1, const char* tags) {
        const std::string a = std::to_string(x0), b = std::to_string(x1);
        return "{\"id\":\"" + std::string(id) + "\",\"outer\":[[" + a + ",0],[" + b + ",0],[" + b + ",8],[" + a +
               ",8]]" + tags + "}";
    };
    const char* part = ",\"building:part\":\"yes\",\"height\":12";
    auto ids = [&](std::string buildings) {
        Result<Town> t = parseFootprints("{\"buildings\":[" + buildings + "]}", "plan");
        REQUIRE(t);
        std::string all;
        for (const Footprint& f : t->footprints) all += f.id + " ";
        return all;
    };
    CHECK(ids(box("whole", 0, 20, "") + "," + box("left", 0, 9, part) + "," + box("right", 9, 20, part)) ==
          "left right ");
    // A tower on half of a house leaves the house standing; so do parts of the house beside it.
    CHECK(ids(box("whole", 0, 20, "") + "," + box("tower", 0, 9, part)) == "whole tower ");
    CHECK(ids(box("whole", 0, 20, "") + "," + box("beside", 21, 42, part)) == "whole beside ");
    CHECK(ids(box("whole", 0, 20, "") + "," + box("not", 0, 20, ",\"building:part\":\"no\"")) == "whole not ");
}

TEST_CASE("files that are no towns") {
    for (auto [text, cause] :
         {std::pair("", "is not JSON"), std::pair("{\"type\":\n \"FeatureCollection\", ]", ":2:23: is not JSON"),
          std::pair("[1,2]", "neither GeoJSON nor a plan"), std::pair("{}", "neither GeoJSON"),
          std::pair(R"({"features":7})", "no list"), std::pair("\xff\xfe", "is not JSON"),
          std::pair(R"({"type":"Topology"})", "neither GeoJSON")}) {
        INFO(text);
        Result<Town> read = parseFootprints(text, "town.geojson");
        REQUIRE(!read);
        INFO(read.failure().text());
        CHECK(read.failure().text().find(cause) != std::string::npos);
    }
    CHECK(!parseFootprints(std::string(200000, '['), "deep.geojson"));
    CHECK(!readFootprints("no/such/file.geojson"));
}

TEST_CASE("multipolygons, holes and outlines too large") {
    std::string two = "[" + std::string(kSquare) + ",[[[11.501,49.9],[11.5012,49.9],[11.5012,49.9001]]]]";
    Town t = town(feature("", two, "MultiPolygon"));
    REQUIRE(t.footprints.size() == 2);
    CHECK(t.footprints[1].id == "way/7#2");

    Town holed = town(
        R"({"buildings":[{"id":"a","outer":[[0,0],[20,0],[20,20],[0,20]],"holes":[[[5,5],[9,5],[9,9],[5,9]],[[1,1]]]}]})");
    CHECK(holed.footprints[0].rings.size() == 2);
    CHECK(says(holed.diagnostics, "hole 2 has fewer than three corners: filled"));

    // What a feature says is looked at for each of its polygons; its messages are bounded.
    for (size_t polygons : {2000, 20000}) {
        std::string triangles = "[[[0,0],[1e-4,0],[0,1e-4]]]", keys = R"("edges":[{"edge":0})";
        for (size_t i = 1; i < polygons; i++) triangles += ",[[[0,0],[1e-4,0],[0,1e-4]]]", keys += R"(,{"edge":0})";
        keys +=
            R"(],"roof:shape":")" + std::string(500000, 'x') + R"(","roof:angle":")" + std::string(500000, '7') + '"';
        for (size_t i = 0; i < polygons; i++) keys += R"(,"roof:x)" + std::to_string(i) + R"(":1)";
        Town heavy = town(feature(keys, "[" + triangles + "]", "MultiPolygon"));
        CHECK(heavy.footprints.size() == polygons);
        CHECK(heavy.diagnostics.size() == std::min(polygons + 3 * polygons, kMostMessages + 1));
        CHECK(says(heavy.diagnostics, "way/7: roof:x1 is not known"));
        const bool all = polygons < 10000;
        CHECK(says(heavy.diagnostics, "way/7#9: edges has more entries than there are edges") == all);
        CHECK(says(heavy.diagnostics, "more than 10000 messages: the rest is left out") == !all);
    }
    // So are those of what is made of footprints.
    std::vector<Footprint> flat(kMostMessages + 100);
    for (Footprint& f : flat) f.id = "flat", f.rings = {{{0, 0}, {9, 0}, {18, 0}}};
    std::vector<Diagnostic> said;
    CHECK(roofsOf(flat, said).houses.empty());
    CHECK(said.size() == kMostMessages + 1);

    std::string many;
    for (int i = 0; i < 100000; i++)
        many += (i ? ",[" : "[") + std::to_string(100 * std::cos(i * 6.2831853e-5)) + "," +
                std::to_string(100 * std::sin(i * 6.2831853e-5)) + "]";
    Town round =
        town(R"({"buildings":[{"id":"gasometer","outer":[)" + many + R"(]},{"id":"b","outer":[[0,0],[9,0],[9,9]]}]})");
    CHECK(round.footprints.size() == 1);
    CHECK(says(round.diagnostics, "gasometer: has 100000 corners, more than 20000"));
}

TEST_CASE("what only a hostile file holds costs no minutes and no stack") {
    Town deep =
        town(R"({"buildings":[{"id":"deep","outer":)" + std::string(200000, '[') + std::string(200000, ']') + "}]}");
    CHECK(says(deep.diagnostics, "deep: its outline"));
    // A scribble of 1000 corners crosses itself some 100,000 times.
    Footprint scribble;
    scribble.id = "scribble";
    uint32_t state = 1;
    auto random = [&] { return double((state = state * 1664525u + 1013904223u) >> 8) / (1 << 24) * 1000; };
    scribble.rings.resize(1);
    for (int i = 0; i < 1000; i++) {
        double x = random(), y = random();
        scribble.rings[0].push_back({x, y});
    }
    RoofStructure out;
    std::vector<Diagnostic> said;
    CHECK(!appendRoof(scribble, out, said));
    CHECK(says(said, "scribble: the outline crosses or touches itself more than 1000 times: left out"));
}

TEST_CASE("the OSM extracts as GeoJSON") {
    for (auto [name, count] : {std::pair("osm_north_bayreuth_DE", 4267), std::pair("osm_monaco_west", 649),
                               std::pair("osm_campo_grande_BR", 102)}) {
        std::optional<std::string> path = test::dataFile(std::string("footprints/") + name + ".geojson");
        if (!path) return;
        Result<Town> read = readFootprints(*path);
        REQUIRE(bool(read));
        std::vector<Diagnostic> said;
        RoofStructure roof = roofsOf(read->footprints, said);
        INFO(toString(read->diagnostics) << toString(said));
        CHECK(roof.houses.size() >= size_t(count));
    }
}
