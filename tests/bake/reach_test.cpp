// How far plants get about on pieces, whose ground is known by construction.
#include <doctest/doctest.h>

#include "tests/bake/baking.hpp"
#include "tests/bake/kits.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec3;

TEST_CASE("pieces that touch are one, all of whose ground is reached; those apart are pieces of their own") {
    for (double lift : {0.0, 0.5}) {
        CAPTURE(lift);
        Kit kit;
        kit.box({0, 0, 0}, {2, 0.5, 2});
        kit.box({0, 0.9 + lift, 0}, dvec3(0.5));
        kit.box({1.5, 1 + lift, 1.5}, {0.2, 0.6, 0.2});
        const BakeReport report = kit.bake().report;
        REQUIRE(report.pieces.size() == (lift > 0 ? 3 : 1));
        CHECK(report.leastReachable() > 0.995);
        // Less what stands on the slab, and what is sunk into it.
        const double free = 2 * (4 * 4 + 4 * 1 * 2) + 6 + 4 * 0.4 * 1.2 + 2 * 0.16;
        const double expected = lift > 0 ? free : free - 2 * 1 - 4 * 0.1 - 2 * 0.16 - 4 * 0.4 * 0.1;
        CHECK(groundOf(report) == doctest::Approx(expected).epsilon(0.02));
        CHECK(report.json().find("\"reachable\"") != std::string::npos);
    }
}

TEST_CASE("a stone without a back hides the wall that it stands on; an awning without one does not") {
    for (bool stone : {true, false}) {
        CAPTURE(stone);
        Kit kit;
        kit.box({0, 0, 0}, {1, 1, 0.2});
        const dvec3 a(-0.5, -0.4, 0.2), side(1, 0, 0), up(0, 0.8, 0), out(0, 0, 0.15);
        kit.panel(a + out, side, up);
        kit.panel(a + out + up, side, -out);
        if (stone) {
            kit.panel(a, side, out);
            kit.panel(a, out, up);
            kit.panel(a + side + out, -out, up);
        }
        const BakeReport report = kit.bake().report;
        const double wall = 2 * (4 + 2 * 0.8), hidden = stone ? 0.8 : 0;
        const double added = 0.8 + 0.15 + (stone ? 0.15 + 2 * 0.12 : 0);
        CHECK(groundOf(report) == doctest::Approx(wall - hidden + added).epsilon(0.02));
        CHECK(report.leastReachable() > 0.99);
    }
}

TEST_CASE("of a plate's two sides the larger counts where no rim joins them, though a rod goes through both") {
    for (bool rim : {false, true}) {
        CAPTURE(rim);
        Kit kit;
        const double half = 1, thick = 0.1;
        kit.panel({-half, -half, thick}, {2 * half, 0, 0}, {0, 2 * half, 0});
        kit.panel({half, -half, -thick}, {-2 * half, 0, 0}, {0, 2 * half, 0});
        if (rim) {
            kit.panel({half, -half, thick}, {0, 0, -2 * thick}, {0, 2 * half, 0});
            kit.panel({-half, -half, -thick}, {0, 0, 2 * thick}, {0, 2 * half, 0});
            kit.panel({-half, half, thick}, {2 * half, 0, 0}, {0, 0, -2 * thick});
            kit.panel({-half, -half, -thick}, {2 * half, 0, 0}, {0, 0, 2 * thick});
        }
        kit.box({0.3, 0.2, 0.1}, {0.2, 0.2, 0.6});
        const BakeReport report = kit.bake().report;
        REQUIRE(report.pieces.size() == 1);
        // The plate less the rod's section; the rod as far as it stands out, longer before the plate than behind it.
        const double side = 4 - 0.16, front = side + 0.16 + 1.6 * 0.6, back = side + 0.16 + 1.6 * 0.4;
        const double expected = rim ? 1 : front / (front + back);
        CHECK(report.reachableShare() == doctest::Approx(expected).epsilon(0.02));
    }
}

TEST_CASE("the inside of a hall without a floor doesn't count, unless a wall is missing too") {
    for (bool wall : {true, false}) {
        CAPTURE(wall);
        Kit kit;
        const double half = 2, height = 0.4;
        kit.panel({-half, height, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
        kit.panel({-half, 0, half}, {2 * half, 0, 0}, {0, height, 0});
        kit.panel({half, 0, -half}, {-2 * half, 0, 0}, {0, height, 0});
        kit.panel({-half, 0, -half}, {0, 0, 2 * half}, {0, height, 0});
        if (wall) kit.panel({half, 0, half}, {0, 0, -2 * half}, {0, height, 0});
        // A ceiling that touches the walls' backs.
        kit.panel({-half, 0.3, -half}, {2 * half, 0, 0}, {0, 0, 2 * half});
        const BakeReport report = kit.bake().report;
        REQUIRE(report.pieces.size() == 1);
        const double outside = 16 + (wall ? 4 : 3) * 4 * height, ceiling = 16;
        CHECK(report.pieces[0].enclosed == doctest::Approx(wall ? ceiling : 0).epsilon(0.02));
        CHECK(report.reachableShare() == doctest::Approx(wall ? 1 : outside / (outside + ceiling)).epsilon(0.02));
    }
}

TEST_CASE("walks that end where the model goes on count against reach; those at its own borders don't") {
    Kit kit;
    kit.panel({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    kit.box({0, 0.5, 0}, dvec3(0.5), false);  // stands on the floor, and is one with it by contacts alone
    BakeOptions options;
    options.resolution = 512;
    options.keepLayout = true;
    for (bool joined : {true, false}) {
        CAPTURE(joined);
        options.contacts = joined;
        const BakeReport report = bakeOrFail(kit.model(), options).report;
        const double ended = report.endedWalks();
        CHECK((joined ? ended == 0 : ended > 0.1));
        CHECK((joined ? report.leastReachable() > 0.99 : report.leastReachable() < 0.5));
        CHECK(report.json().find("\"ended_walks\"") != std::string::npos);
    }
}

TEST_CASE("walks that end at glass that stands on the ground, or in it, don't count against reach") {
    for (double sunk : {0.0, 0.2}) {
        CAPTURE(sunk);
        Kit kit;
        kit.box({0, -0.5, 0}, {4, 0.5, 3});
        const int pane = kit.box({0, 1 - sunk, 0}, {2.5, 1, 0.03});
        Model model = kit.model();
        model.materials.resize(2);
        model.materials[1].bare = true;
        for (int i = 0; i < kit.count(); ++i)
            model.triangleMaterial.insert(model.triangleMaterial.end(), 2, i >= pane ? 1u : 0u);
        const BakeReport report = bakeOrFail(model, 512).report;
        CHECK(report.endedWalks() == 0);
        CHECK(report.leastReachable() > 0.99);
    }
}
