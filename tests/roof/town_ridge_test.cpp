// Where a ridge leads: roof:direction and roof:orientation.
#include "tests/roof/town_support.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

std::string house(const std::string& outer, const std::string& tags) {
    return R"({"buildings":[{"id":"h","outer":)" + outer + R"(,"height":7,"roof:height":3,)" + tags + "}]}";
}
Line ridgeOf(const std::string& text) {
    const GrownTown town = grown(text);
    return test::ridgeOf(town.roofs, town.house("h"));
}

const char* kSquare = "[[0,0],[8,0],[8,8],[0,8]]";
const char* kLong = "[[0,0],[12,0],[12,6],[0,6]]";
const char* kBay = "[[0,0],[5,0],[5,-0.5],[7,-0.5],[7,0],[12,0],[12,6],[0,6]]";

}  // namespace

TEST_CASE("roofs with gables fall to their direction") {
    for (const char* shape : {"gabled", "gambrel"}) {
        const auto ridge = [&](const char* outer, const std::string& direction) {
            return ridgeOf(
                house(outer, "\"roof:shape\":\"" + std::string(shape) + "\",\"roof:direction\":" + direction));
        };
        INFO(shape);
        for (const char* north : {R"("N")", "0", R"("180°")", R"("south")", R"("S")", "360", R"("NNE")", "-20"}) {
            INFO(north);
            CHECK(runs(ridge(kSquare, north), {0, 4}, {8, 4}));
            CHECK(runs(ridge(kLong, north), {0, 3}, {12, 3}));
        }
        for (const char* east : {R"("E")", "90", R"("West")", "270", R"("ENE")", R"("east-south-east")"}) {
            INFO(east);
            CHECK(runs(ridge(kSquare, east), {4, 0}, {4, 8}));
            CHECK(runs(ridge(kLong, east), {6, 0}, {6, 6}));
        }
    }
    const auto halfHip = [](const char* direction) {
        return ridgeOf(house("[[0,0],[9,0],[9,9],[0,9]]",
                             std::string(R"("roof:shape":"half-hipped","roof:direction":")") + direction + '"'));
    };
    CHECK(halfHip("S").from.y == doctest::Approx(4.5));
    CHECK(halfHip("S").to.y == doctest::Approx(4.5));
    CHECK(halfHip("W").from.x == doctest::Approx(4.5));
    CHECK(halfHip("W").to.x == doctest::Approx(4.5));
    // Its hips leave a third of a short ridge.
    CHECK(runs(ridgeOf(house(kLong, R"("roof:shape":"half-hipped","roof:direction":"E")")), {6, 2}, {6, 4}));
    CHECK(runs(ridgeOf(house(kLong, R"("roof:shape":"half-hipped","roof:direction":"N")")), {1.5, 3}, {10.5, 3}));
}

TEST_CASE("a ridge lies along or across any outline") {
    const auto ridge = [&](const char* outer, const char* orientation) {
        return ridgeOf(house(outer, std::string(R"("roof:shape":"gabled","roof:orientation":")") + orientation + '"'));
    };
    for (const char* outer : {kLong, kBay}) {
        INFO(outer);
        CHECK(runs(ridge(outer, "across"), {6, 0}, {6, 6}));
        CHECK(ridge(outer, "along").from.y == doctest::Approx(3));
        CHECK(ridge(outer, "along").to.y == doctest::Approx(3));
    }
    // A wing and its ridge lie across by themselves; the length of the house is the main ridge's.
    const char* l = "[[0,0],[15,0],[15,7],[7,7],[7,15],[0,15]]";
    CHECK(ridge(l, "along").height == ridge(l, "across").height);
    for (const char* outer : {kLong, kBay, l, "[[0,0],[18,0],[18,7],[12.5,7],[12.5,15],[5.5,15],[5.5,7],[0,7]]",
                              "[[0,0],[20,0],[20,15],[13.5,15],[13.5,7],[6.5,7],[6.5,15],[0,15]]",
                              "[[2,0],[6,0],[8,2],[8,6],[6,8],[2,8],[0,6],[0,2]]"})
        for (const char* shape : {"gabled", "gambrel", "half-hipped", "skillion", "hipped", "mansard"})
            for (const char* tag : {R"("roof:orientation":"across")", R"("roof:orientation":"along")",
                                    R"("roof:direction":"N")", R"("roof:direction":"E")", R"("roof:direction":"NE")"}) {
                INFO(outer << shape << tag);
                const GrownTown town = grown(house(outer, std::string(R"("roof:shape":")") + shape + "\"," + tag));
                CHECK(town.house("h").shape == town.town.footprints[0].shape);
                CHECK(!town.says("could not"));
            }
    CHECK(grown(house(kLong, R"("roof:shape":"hipped","roof:orientation":"across")")).says("ignored"));
    CHECK(grown(house(kLong, R"("roof:shape":"hipped","roof:direction":"E")"))
              .says("roof:direction would turn the ridge"));
    CHECK(!grown(house(kLong, R"("roof:shape":"hipped","roof:direction":"N")")).says("roof:direction"));
    CHECK(grown(house(kLong, R"("roof:shape":"pyramidal","roof:direction":"N")")).says("means nothing for this shape"));
    CHECK(grown(house(kSquare, R"("roof:shape":"gabled","roof:direction":"NE")"))
              .says("lies between the directions of its walls"));
    CHECK(grown(house(kSquare, R"("roof:shape":"skillion","roof:direction":"NE")"))
              .says("lies between the directions of its walls"));
}

TEST_CASE("reported ridges") {
    if (const auto town = grownReport("town_direction_gabled.json")) {
        CHECK(runs(test::ridgeOf(town->roofs, town->house("n")), {0, 4}, {8, 4}));
        CHECK(runs(test::ridgeOf(town->roofs, town->house("e")), {20, 0}, {20, 8}));
        CHECK(runs(test::ridgeOf(town->roofs, town->house("90")), {38, 0}, {38, 6}));
        CHECK(runs(test::ridgeOf(town->roofs, town->house("0")), {48, 3}, {60, 3}));
    }
    if (const auto town = grownReport("town_direction_gambrel.json"))
        CHECK(runs(test::ridgeOf(town->roofs, town->house("n")), {0, 4}, {8, 4}));
    if (const auto town = grownReport("town_direction_half_hip.json")) {
        const Line ridge = test::ridgeOf(town->roofs, town->house("s"));
        CHECK(ridge.from.y == doctest::Approx(4.5));
        CHECK(ridge.to.y == doctest::Approx(4.5));
    }
    if (const auto town = grownReport("town_orientation_bay.json"))
        CHECK(runs(test::ridgeOf(town->roofs, town->house("bay")), {6, 0}, {6, 6}));
}
