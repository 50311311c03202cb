// Pieces that touch: where they meet is known by construction.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/bake/kits.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec3;

namespace {

bool near(glm::vec3 p, dvec3 q, double tolerance) {
    return glm::length(dvec3(p) - q) <= tolerance;
}

int floorOf(Kit& kit, double half) {
    return kit.panel({-half, 0, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

}  // namespace

TEST_CASE("where sheets fan out from one edge, a walk goes on upon the one that it turns to first") {
    for (int sheets : {3, 4, 5}) {
        CAPTURE(sheets);
        Kit kit;
        std::vector<dvec3> away;
        for (int i = 0; i < sheets; ++i) {
            const double angle = 0.4 + (i + 0.25 * (i % 2)) * 6.2831853 / sheets;
            away.push_back({0, std::cos(angle), std::sin(angle)});
            kit.panel({-1, 0, 0}, {2, 0, 0}, away.back());  // faces the next one's back
        }
        const Baked baked = kit.bake();
        CHECK(baked.report.leastReachable() > 0.99);
        Stroll stroll(baked.surface);
        for (int i = 0; i < sheets; ++i)
            for (double s : {0.03, 0.5, 0.97}) {
                CAPTURE(i);
                CAPTURE(s);
                REQUIRE(stroll.start(kit, i, s, 0.5, -away[size_t(i)]));
                CHECK(stroll.go(0.8) == kWalkDone);
                const dvec3 to = dvec3(2 * s - 1, 0, 0) + away[size_t((i + 1) % sheets)] * 0.3;
                CHECK(glm::length(dvec3(stroll.w.position) - to) < 2e-3);
            }
    }
}

TEST_CASE("a gable that stands where a floor ends on another one of its height is climbed from there, and left") {
    for (double wider : {0.1, 0.4}) {
        CAPTURE(wider);
        Kit kit;
        const int upper = kit.panel({-0.5, 0, 0.8}, {1, 0, 0}, {0, 0, -0.8});
        kit.panel({-0.5 - wider, 0, 0}, {1 + 2 * wider, 0, 0}, {0, 0.8, 0});  // its outside is the upper floor's side
        floorOf(kit, 1);
        const Baked baked = kit.bake();
        Stroll stroll(baked.surface);
        for (double s : {0.1, 0.5, 0.9}) {
            CAPTURE(s);
            REQUIRE(stroll.start(kit, upper, s, 0.5, {0, 0, -1}));
            CHECK(stroll.go(0.7) == kWalkDone);
            CHECK(near(stroll.w.position, {s - 0.5, 0.3, 0}, 2e-3));
            stroll.turnBack();
            CHECK(stroll.go(0.7) == kWalkDone);
            CHECK(near(stroll.w.position, {s - 0.5, 0, 0.4}, 2e-3));
        }
    }
}

TEST_CASE("a sheet that lies on a wall, close to another one that stands out of it, is left for both") {
    for (double slit : {0.1, 0.3})
        for (bool up : {true, false}) {
            CAPTURE(slit);
            CAPTURE(up);
            const double texel = 2 / 0.44 / 512;  // metres
            Kit kit;
            const int wall = kit.panel({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
            const int brick = kit.panel({-0.5, 0, 0.3 * texel}, {1, 0, 0}, {0, 0.5, 0});
            const double y = -slit * texel, from = up ? 0.3 : 0;
            kit.panel({-0.5, y, from}, {1, 0, 0}, {0, 0, 0.3 - 2 * from});  // its outside up or down
            const Baked baked = kit.bake();
            CHECK(baked.report.danglingContacts == 0);
            // Over the slit, which is narrower than a texel, onto the shelf; and from there back.
            Stroll stroll(baked.surface);
            REQUIRE(stroll.start(kit, brick, 0.5, 0.4, {0, -1, 0}));
            CHECK(stroll.go(0.3) == kWalkDone);
            CHECK(near(stroll.w.position, {0, y, 0.1}, 2 * texel));
            stroll.turnBack();
            CHECK(stroll.go(0.2) == kWalkDone);
            CHECK(stroll.w.position.z < texel);
            CHECK(std::abs(stroll.w.position.y) > 0.09);
            REQUIRE(stroll.start(kit, wall, 0.5, 0.25, {0, 1, 0}));
            CHECK(stroll.go(0.6) == kWalkDone);
            CHECK(near(stroll.w.position, {0, y, 0.1}, 2 * texel));
        }
}

TEST_CASE("a slit between boxes on either side of a bend is ground down to its bottom, and what is under them isn't") {
    const double texel = 2 / (0.88 / 4) / 512;  // metres
    for (double left : {-0.4, -0.6})
        for (double right : {0.75, 0.9}) {
            CAPTURE(left);
            CAPTURE(right);
            Kit kit;
            const double fall = 0.2;
            kit.panel({-1, -fall, 1}, {1, fall, 0}, {0, 0, -2});
            kit.panel({0, 0, 1}, {1, -fall, 0}, {0, 0, -2});
            const dvec3 half(0.25, 0.4, 0.4);
            const int from = kit.box({left * texel - half.x, 0.2, 0}, half);
            kit.box({right * texel + half.x, 0.2, 0}, half);
            const Baked baked = kit.bake();
            Stroll stroll(baked.surface);
            for (double s : {0.2, 0.5, 0.8}) {
                CAPTURE(s);
                REQUIRE(stroll.start(kit, from, 0.5, s, {0, -1, 0.1}));
                CHECK(stroll.go(0.4) == kWalkDone);
                CHECK(stroll.w.position.x == doctest::Approx(right * texel).epsilon(1e-3));
                CHECK(stroll.w.position.y > 0.1);
            }
        }
}

TEST_CASE("what lies under a box is no ground, however close to the floor's bend the box ends") {
    const double texel = 2 / (0.88 / 3) / 512;  // metres
    for (double gap : {0.2, 0.4, 0.6, 0.8}) {
        CAPTURE(gap);
        Kit kit;
        const double fall = 0.2;
        kit.panel({-1, -fall, 1}, {1, fall, 0}, {0, 0, -2});
        kit.panel({0, 0, 1}, {1, -fall, 0}, {0, 0, -2});
        const dvec3 half(0.25, 0.4, 0.4), middle(gap * texel + half.x, 0.2, 0);
        kit.box(middle, half);
        const Baked baked = kit.bake();
        int under = 0, beside = 0;
        for (const Texel& t : baked.surface.levels[0].texels) {
            if (texelClass(t.bits) != kTexelInner || std::abs(t.position.y + fall * t.position.x) > 1e-4) continue;
            const dvec3 in = half - glm::abs(dvec3(t.position) - middle);
            (std::min(in.x, in.z) > 2 * texel ? under : beside)++;
        }
        CHECK(under == 0);
        CHECK(beside > 1000);
    }
}

TEST_CASE("a walk leaves the floor for a wall that stands on it, and comes back") {
    struct Case {
        double lift;  // of the wall's underside over the floor
        bool underside;
        double tolerance;
    };
    for (Case c : {Case{0, true, 1e-3},
                   {0, false, 1e-3},
                   {1e-5, true, 1e-3},
                   {-1e-5, false, 1e-3},
                   {0.002, true, 0.008},
                   {0.002, false, 0.008},
                   {-0.1, true, 1e-3},
                   {-0.1, false, 1e-3}}) {
        CAPTURE(c.lift);
        CAPTURE(c.underside);
        Kit kit;
        int floor = floorOf(kit, 2);
        int box = kit.box({0, 0.5 + c.lift, 0}, dvec3(0.5), c.underside);
        Baked baked = kit.bake();
        Stroll walk(baked.surface);
        for (uint32_t level : {0u, 1u}) {
            // From the floor at x = 1.4 along -x, up the wall at x = 0.5.
            REQUIRE(walk.start(kit, floor, 3.4 / 4, 0.53, {-1, 0, 0}, level));
            double z = 2 - 4 * 0.53;
            CHECK(walk.go(1.4) == kWalkDone);
            CHECK_MESSAGE(near(walk.w.position, {0.5, 0.5, z}, c.tolerance), walk.w.position.x, " ", walk.w.position.y);
            CHECK(near(walk.w.walk.direction, {0, 1, 0}, 1e-3));
            walk.turnBack();
            CHECK(walk.go(1.4) == kWalkDone);
            CHECK(near(walk.w.position, {1.4, 0, z}, c.tolerance));
        }
        // Aslant: the angle to the contact line is kept.
        REQUIRE(walk.start(kit, floor, 3.4 / 4, 0.5, {-3, 0, -1}));
        CHECK(walk.go(1.2 * std::sqrt(10.0) / 3) == kWalkDone);
        CHECK(near(walk.w.position, {0.5, 0.3, -0.4}, c.tolerance));
        (void)box;
    }
}

TEST_CASE("what lies within or under a piece is no ground") {
    for (double sunk : {0.0, 0.25}) {
        for (bool underside : {true, false}) {
            CAPTURE(sunk);
            CAPTURE(underside);
            Kit kit;
            kit.box({0, -0.5, 0}, {2, 0.5, 2});
            kit.box({0, 0.5 - sunk, 0}, dvec3(0.5), underside);
            Baked baked = kit.bake(1024);
            const SurfaceLevelData& level = baked.surface.levels[0];
            int wrong = 0, buried = 0;
            for (size_t i = 0; i < level.texels.size(); ++i) {
                const Texel& t = level.texels[i];
                uint32_t triangle = level.aux[i].triangle;
                if (texelClass(t.bits) == kTexelEmpty) continue;
                // The centre in its panel; gutters lie outside.
                glm::vec3 p = t.position;
                bool slab = triangle < 12, top = triangle / 2 == 2;
                glm::vec3 reach = glm::abs(p - glm::vec3(0, slab ? -0.5f : float(0.5 - sunk), 0));
                float most = slab ? 2.0f : 0.5f;
                if (reach.x > most + 1e-5f || reach.z > most + 1e-5f || reach.y > 0.5f + 1e-5f) continue;
                float side = std::max(std::abs(p.x), std::abs(p.z));
                bool beside = slab ? top && std::abs(side - 0.5f) < 0.002f : std::abs(p.y) < 0.002f && side > 0.499f;
                if (beside) continue;
                bool expected = slab ? top && side < 0.5f : p.y < 0.002f, ground = texelClass(t.bits) == kTexelInner;
                buried += expected && !ground;
                wrong += expected == ground;
            }
            CHECK(wrong == 0);
            CHECK(buried > 500);
            CHECK(baked.report.buriedTexels > 500);
        }
    }
}

TEST_CASE("a sheet that stands on a floor is climbed from both sides") {
    for (double lift : {0.0, -0.2, 0.003}) {
        CAPTURE(lift);
        Kit kit;
        int floor = floorOf(kit, 2);
        kit.panel({0, lift, 1}, {0, 0, -2}, {0, 1, 0});  // in x = 0, its outside towards +x
        Baked baked = kit.bake();
        Stroll walk(baked.surface);
        for (double from : {1.0, -1.0}) {
            CAPTURE(from);
            REQUIRE(walk.start(kit, floor, (from + 2) / 4, 0.55, {-from, 0, 0}));
            CHECK(walk.go(1.5) == kWalkDone);
            CHECK(near(walk.w.position, {0, 0.5, -0.2}, 0.008));
            CHECK(near(walk.w.walk.direction, {0, 1, 0}, 1e-3));
        }
        // Down again on its outside.
        walk.turnBack();
        CHECK(walk.go(1.5) == kWalkDone);
        CHECK(near(walk.w.position, {1, 0, -0.2}, 0.008));
        // Beside the sheet's end nothing is in the way.
        REQUIRE(walk.start(kit, floor, 0.75, 0.9, {-1, 0, 0}));
        CHECK(walk.go(2) == kWalkDone);
        CHECK(near(walk.w.position, {-1, 0, -1.6}, 1e-3));
    }
}

TEST_CASE("pieces put corner to corner are pieces: a ledge is met at its top though its foot shares the wall's edge") {
    Kit kit;
    const double deep = 0.3, high = 0.1;
    const int lower = kit.panel({-1, 0, 0}, {2, 0, 0}, {0, 1, 0}), upper = kit.panel({-1, 1, 0}, {2, 0, 0}, {0, 1, 0});
    // A ledge without a back, whose foot ends where the wall's panels meet.
    kit.panel({-1, 1, 0}, {2, 0, 0}, {0, 0, deep});
    kit.panel({-1, 1, deep}, {2, 0, 0}, {0, high, 0});
    kit.panel({-1, 1 + high, deep}, {2, 0, 0}, {0, 0, -deep});
    kit.panel({-1, 1, 0}, {0, 0, deep}, {0, high, 0});
    kit.panel({1, 1, deep}, {0, 0, -deep}, {0, high, 0});
    Baked baked = kit.bake();
    Stroll walk(baked.surface);
    const double around = 0.5 - high + deep + high + deep + 0.5;
    for (double s : {0.3, 0.5, 0.72}) {
        CAPTURE(s);
        REQUIRE(walk.start(kit, upper, s, 0.5, {0, -1, 0}));
        CHECK(walk.go(around) == kWalkDone);
        CHECK(near(walk.w.position, kit[lower].at(s, 0.5), 2e-3));
        CHECK(near(walk.w.walk.direction, {0, -1, 0}, 1e-3));
        walk.turnBack();
        CHECK(walk.go(around) == kWalkDone);
        CHECK(near(walk.w.position, kit[upper].at(s, 0.5), 2e-3));
    }
    // The wall behind the ledge is no ground.
    const SurfaceLevelData& level = baked.surface.levels[0];
    auto classAt = [&](double t) {
        return texelClass(level.texels[texelAt(level.size, glm::vec2(kit.uv(upper, 0.5, t)))].bits);
    };
    CHECK(classAt(high / 2) == kTexelLink);
    CHECK(classAt(2 * high) == kTexelInner);
}

TEST_CASE("a wall that ends in the middle of another one is met, though they are one piece around the corner") {
    // A niche, seen from inside; its back wall goes on behind the right one.
    Kit kit;
    const int back = kit.panel({-1, 0, 0}, {2, 0, 0}, {0, 1, 0});
    kit.panel({-1, 0, 1}, {0, 0, -1}, {0, 1, 0});
    kit.panel({-1, 1, 0}, {1, 0, 0}, {0, 0, 1});
    kit.panel({0, 0, 0}, {0, 0, 1}, {0, 1, 0});
    kit.panel({-1, -1, 2}, {2, 0, 0}, {0, 1, 0});  // another piece, far off
    Baked baked = kit.bake();
    Stroll walk(baked.surface);
    REQUIRE(walk.start(kit, back, 0.25, 0.6, {1, 0, 0}));
    CHECK(walk.go(1) == kWalkDone);
    CHECK(near(walk.w.position, {0, 0.6, 0.5}, 2e-3));
    CHECK(near(walk.w.walk.direction, {0, 0, 1}, 1e-3));
    walk.turnBack();
    CHECK(walk.go(1) == kWalkDone);
    CHECK(near(walk.w.position, {-0.5, 0.6, 0}, 2e-3));
}

TEST_CASE("a groove between boards, narrower than a texel, is gone through or over, never along only") {
    const double depth = 0.08, texel = 4 / (0.88 / 5 * 1024);
    // Boards nearer to each other than a tenth of their thickness count as touching.
    for (double width : {0.7 * texel, 0.003}) {
        CAPTURE(width);
        Kit kit;
        kit.box({0, 0, 0}, {2, 1, 0.2});
        int board[2];
        for (int k = 0; k < 2; ++k) {
            const double middle = (k == 0 ? -1 : 1) * (0.25 + width / 2);
            board[k] = kit.box({0, middle, 0.2 + depth / 2 - 0.01}, {1.5, 0.25, depth / 2 + 0.01});
        }
        Baked baked = kit.bake(1024);
        Stroll walk(baked.surface);
        const bool filled = width < 0.1 * depth;
        for (int k : {0, 1})
            for (double s : {0.2, 0.5, 0.71}) {
                REQUIRE(walk.start(kit, board[k] + 4, s, 0.5, {0, k == 0 ? 1 : -1, 0}));
                CHECK(walk.go(0.5 + width + (filled ? 0 : 2 * depth)) == kWalkDone);
                const dvec3 start = kit[board[k] + 4].at(s, 0.5);
                CHECK_MESSAGE(near(walk.w.position, {start.x, -start.y, 0.2 + depth}, 0.01), walk.w.position.x, " ",
                              walk.w.position.y, " ", walk.w.position.z);
            }
        CHECK(baked.report.reachableShare() > 0.995);
    }
}

TEST_CASE("a walk down a wedge whose foot is narrower than a texel comes out again") {
    // A sheet on a floor, before it a block that leans away, its edge in the floor.
    const double texel = 3 / (0.88 / 4 * 1024), gap = 0.75 * texel, lean = 0.15, thick = 0.2;
    const dvec3 up(0, std::cos(lean), std::sin(lean)), out(0, -std::sin(lean), std::cos(lean));
    Kit kit;
    kit.box({0, 0, 0}, {1.5, 0.2, 1.5});
    const int sheet = kit.panel({-1, 0.2, 0}, {2, 0, 0}, {0, 0.8, 0});
    const double z = gap + (thick + 0.25 * std::sin(lean)) / std::cos(lean);
    kit.box({0, 0.45, z}, glm::dmat3(dvec3(0.4, 0, 0), up * 0.3, out * thick));
    const Baked baked = kit.bake(1024);
    Stroll walk(baked.surface);
    for (double s : {0.35, 0.42, 0.5, 0.57, 0.65}) {
        CAPTURE(s);
        REQUIRE(walk.start(kit, sheet, s, 0.9, {0, -1, 0}));
        CHECK(walk.go(0.72 + 0.2) == kWalkDone);
        // Up the block's back.
        CHECK(walk.w.position.y > 0.35f);
        CHECK(std::abs(glm::dot(dvec3(walk.w.position) - dvec3(0, 0.2, gap), out)) < 0.3 * texel);
    }
}

TEST_CASE("boxes stacked, side by side and through each other: walks stay on the outside and go everywhere") {
    std::vector<std::pair<dvec3, glm::dmat3>> boxes;
    auto axes = [](dvec3 half, double turn) {
        double c = std::cos(turn), s = std::sin(turn);
        return glm::dmat3(dvec3(c, 0, -s) * half.x, dvec3(0, half.y, 0), dvec3(s, 0, c) * half.z);
    };
    boxes.push_back({{0, 0, 0}, axes({1, 0.5, 1}, 0)});
    boxes.push_back({{0, 1, 0}, axes({0.7, 0.5, 0.7}, 0)});             // stands on the first, exactly
    boxes.push_back({{1.5, 0, 0.1}, axes({0.5, 0.4, 0.5}, 0)});         // beside it, face to face
    boxes.push_back({{-0.9, 0.45, 0.3}, axes({0.5, 0.35, 0.4}, 0.4)});  // through it
    boxes.push_back({{0.3, 1.5, 0.2}, axes({0.2, 0.4, 1.1}, 0.7)});     // through the second's top
    Kit kit;
    for (auto& [middle, a] : boxes) kit.box(middle, a);
    Baked baked = kit.bake(1024);
    CHECK(baked.report.contactCrossings > 30);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    auto depth = [&](glm::vec3 p) {  // inside of any box
        double deepest = -1;
        for (auto& [middle, a] : boxes) {
            dvec3 d = glm::inverse(a) * (dvec3(p) - middle), room = 1.0 - glm::abs(d);
            double least = 1e9;
            for (int k = 0; k < 3; ++k) least = std::min(least, room[k] * glm::length(a[k]));
            deepest = std::max(deepest, least);
        }
        return deepest;
    };
    int ended = 0, deep = 0, walks = 0;
    std::vector<int> seen(boxes.size(), 0);
    Stroll walk(baked.surface);
    while (walks < 600) {
        int panel = int(unit(random) * kit.count());
        double s = 0.02 + 0.96 * unit(random), t = 0.02 + 0.96 * unit(random);
        if (depth(kit[panel].at(s, t)) > 1e-3) continue;
        if (panel / 6 != 4) {
            // Not covered by a face that touches it.
            if (depth(kit[panel].at(s, t) + kit[panel].normal() * 1e-2) > 0) continue;
        }
        const Panel& p = kit[panel];
        double angle = 6.2831853 * unit(random);
        if (!walk.start(kit, panel, s, t,
                        glm::normalize(p.right) * std::cos(angle) + glm::normalize(p.up) * std::sin(angle)))
            continue;
        ++walks;
        walk.samples.clear();
        for (int i = 0; i < 60; ++i)
            if (walk.go(0.1) != kWalkDone) {
                ++ended;
                break;
            }
        for (glm::vec3 q : walk.samples) {
            deep += depth(q) > 0.01;
            for (size_t b = 0; b < boxes.size(); ++b) {
                dvec3 d = glm::abs(glm::inverse(boxes[b].second) * (dvec3(q) - boxes[b].first));
                if (std::max({d.x, d.y, d.z}) < 1.001) seen[b] |= 1 << (panel / 6);
            }
        }
    }
    CHECK(ended == 0);
    CHECK(deep == 0);
    for (int from : seen) CHECK(from == 31);  // each box was reached from each
}
