// Walking through a world of boxes, whose rays are met by formulas.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sample_game/view_camera.hpp"

namespace {

constexpr float kEyes = 1.65f, kBody = .3f, kFrame = .05f;

struct Box {
    glm::vec3 low, high;
};

// Over a floor at y = 0.
struct World {
    std::vector<Box> boxes;
    sample::ViewCamera walker;

    explicit World(std::vector<Box> stands) : boxes(std::move(stands)) {
        boxes.push_back({{-100, -1, -100}, {100, 0, 100}});
        EspCamera camera{};
        camera.eye[1] = camera.target[1] = kEyes;
        camera.target[2] = -1;  // towards -z
        camera.fovY = .7f;
        walker.set(camera, 10);
    }
    bool meets(glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) const {
        bool found = false;
        for (const Box& box : boxes) {
            float first = 0, last = reach;
            glm::vec3 normal(0);
            for (int i = 0; i < 3; ++i) {
                if (std::abs(along[i]) < 1e-9f) {
                    if (from[i] < box.low[i] || from[i] > box.high[i]) last = -1;
                    continue;
                }
                float a = (box.low[i] - from[i]) / along[i], b = (box.high[i] - from[i]) / along[i];
                if (a > b) std::swap(a, b);
                if (a > first) first = a, normal = glm::vec3(0), normal[i] = along[i] > 0 ? -1.f : 1.f;
                last = std::min(last, b);
            }
            const float met = first > 0 ? first : last;  // from inside its far side
            if (first > last || met <= 0 || (first <= 0 && last >= reach)) continue;
            reach = hit.distance = met;
            const glm::vec3 at = from + met * along;
            std::copy(&at.x, &at.x + 3, hit.position);
            std::copy(&normal.x, &normal.x + 3, hit.normal);
            found = true;
        }
        return found;
    }
    glm::vec3 go(glm::vec2 rightAhead, float seconds) {
        const sample::Meets rays = [this](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
            return meets(from, along, reach, hit);
        };
        for (float t = 0; t < seconds; t += kFrame) walker.walk(rays, rightAhead, kFrame, false, false);
        return walker.eye();
    }
};

}  // namespace

TEST_CASE("a walker climbs stairs and comes down again") {
    std::vector<Box> stairs;
    for (int step = 0; step < 8; ++step) {
        const float face = -1 - .28f * float(step);
        stairs.push_back({{-2, 0, -8}, {2, .18f * float(step + 1), face}});
    }
    World world(stairs);
    const glm::vec3 up = world.go({0, 1}, 3);
    CHECK(up.z < -4);
    CHECK(up.y == doctest::Approx(8 * .18f + kEyes).epsilon(.01));
    const glm::vec3 down = world.go({0, -1}, 3);
    CHECK(down.z > -.6f);
    CHECK(down.y == doctest::Approx(kEyes).epsilon(.01));
}

TEST_CASE("walls stop a walker, and let him go along them") {
    World ahead({{{-3, 0, -5}, {3, 1, -2}}});
    const glm::vec3 stopped = ahead.go({0, 1}, 4);
    CHECK(stopped.z >= -2 + kBody - .02f);
    CHECK(stopped.z < -1.5f);
    CHECK(stopped.y == doctest::Approx(kEyes).epsilon(.01));

    World slanting({{{-30, 0, -5}, {30, 3, -2}}});
    const glm::vec3 slid = slanting.go({.7f, .7f}, 4);
    CHECK(slid.z >= -2 + kBody - .02f);
    CHECK(slid.x == doctest::Approx(4 * 1.7f * .7f).epsilon(.03));
}

TEST_CASE("who is let go of in the air comes down on the ground") {
    World world({{{-2, 0, -2}, {2, 3, 2}}});
    world.walker.fly({0, 1, 0}, 3, false);
    world.walker.fly({0, 0, 1}, 10, false);
    REQUIRE(world.walker.eye().y > 4);
    REQUIRE(world.walker.eye().z < -4);
    CHECK(world.go({0, 0}, 4).y == doctest::Approx(kEyes).epsilon(.01));
}

TEST_CASE("who looked from the height of a knee, or from below, stands on the ground before the first step") {
    for (const float height : {.2f, 1.f, kEyes}) {
        CAPTURE(height);
        World world({});
        const sample::Meets rays = [&](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
            return world.meets(from, along, reach, hit);
        };
        EspCamera camera = world.walker.camera();
        camera.eye[1] = camera.target[1] = height;
        world.walker.set(camera, 10);
        world.walker.stand(rays);
        CHECK(world.walker.eye().y == doctest::Approx(std::max(height, kEyes)).epsilon(.001));
        CHECK(world.go({0, 1}, 1).y == doctest::Approx(kEyes).epsilon(.01));
    }
}

TEST_CASE("who is below all ground stands upon it, and walks there") {
    World world({});
    EspCamera camera = world.walker.camera();
    camera.eye[1] = camera.target[1] = -3;
    world.walker.set(camera, 10);
    world.walker.stand([&](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
        return world.meets(from, along, reach, hit);
    });
    CHECK(world.walker.eye().y == doctest::Approx(kEyes));  // over the floor's upper side, a metre above its lower one
    CHECK(world.go({0, 1}, 1).y == doctest::Approx(kEyes));
}

TEST_CASE("who flew high isn't put down, but falls") {
    World world({});
    EspCamera camera = world.walker.camera();
    camera.eye[1] = camera.target[1] = 8;
    world.walker.set(camera, 10);
    world.walker.stand([&](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
        return world.meets(from, along, reach, hit);
    });
    CHECK(world.walker.eye().y == 8);
    CHECK(world.go({0, 1}, 4).y == doctest::Approx(kEyes).epsilon(.01));
}

TEST_CASE("a jump on the spot goes as high at any frame rate, and comes down again") {
    for (const float frame : {1 / 60.f, kFrame}) {
        CAPTURE(frame);
        World world({});
        const sample::Meets rays = [&](glm::vec3 from, glm::vec3 along, float reach, EspHit& hit) {
            return world.meets(from, along, reach, hit);
        };
        world.walker.walk(rays, {0, 0}, frame, false, true);
        float highest = 0, seconds = frame;
        for (; world.walker.inAir() && seconds < 3; seconds += frame) {
            world.walker.walk(rays, {0, 0}, frame, false, false);
            highest = std::max(highest, world.walker.eye().y);
        }
        CHECK(highest == doctest::Approx(kEyes + 3.4f * 3.4f / (2 * 9.81f)).epsilon(.01));
        CHECK(seconds == doctest::Approx(2 * 3.4f / 9.81f).epsilon(.15));
        CHECK(world.walker.eye().y == doctest::Approx(kEyes).epsilon(.001));
    }
}

TEST_CASE("two keys walk and fly no faster than one") {
    World ahead({}), across({});
    const auto way = [](glm::vec3 to) { return glm::length(glm::vec2(to.x, to.z)); };
    CHECK(way(across.go({1, 1}, 1)) == doctest::Approx(way(ahead.go({0, 1}, 1))));
    const glm::vec3 from = ahead.walker.eye(), other = across.walker.eye();
    ahead.walker.fly({0, 0, 1}, 1, false);
    across.walker.fly({1, 1, 1}, 1, false);
    CHECK(glm::distance(other, across.walker.eye()) == doctest::Approx(glm::distance(from, ahead.walker.eye())));
}

TEST_CASE("what is framed lies in what a panel leaves free of the window, however narrow that is") {
    for (const float panel : {0.f, 320.f, 640.f}) {
        const glm::vec2 window(1280, 800);
        const float shift = panel / window.x, aspect = window.x / window.y;
        CAPTURE(panel);
        sample::ViewCamera camera;
        camera.turnTo(.4f, -.3f);
        const glm::vec3 centre(3, 2, -5);
        const glm::vec3 half(4, 3, 5);
        camera.frame(centre - half, centre + half, (window.x - panel) / window.y);
        glm::vec2 low(1e9f), high(-1e9f);
        for (int i = 0; i < 8; ++i) {
            const glm::vec3 side(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
            glm::vec2 at;
            REQUIRE(camera.project(centre + side * half, aspect, shift, at));
            low = glm::min(low, at * window);
            high = glm::max(high, at * window);
        }
        CHECK(low.x >= panel);
        CHECK(low.y >= 0);
        CHECK(high.x <= window.x);
        CHECK(high.y <= window.y);
        const glm::vec2 filled = (high - low) / glm::vec2(window.x - panel, window.y);
        CHECK(std::max(filled.x, filled.y) > .85f);
        // As much is free on either side.
        CHECK(low.x - panel == doctest::Approx(window.x - high.x).epsilon(.01));
        CHECK(low.y == doctest::Approx(window.y - high.y).epsilon(.01));
    }
}
