// What people leave standing. In: the plan, what stands already. Out: woodpiles, seats, barrels and tubs along walls,
// and in gardens beds, hives, washing and stones to step on.

#include <algorithm>
#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/site_layout.hpp"

namespace espalier::content {

using glm::vec2;
constexpr float kTubHigh = 0.30f;  // of its earth, metres
constexpr float kDoorway = 0.9f;   // metres on both sides of a door's middle that stay free
constexpr uint32_t kTries = 16;    // places looked at for one thing
constexpr float kStep = 0.78f;     // metres from stone to stone
constexpr float kStone = 0.37f;    // and of a stone's radius

bool Layout::place(const std::string& model, vec2 at, vec2 out, float radius, float fromHouse) {
    if (!clear(at, radius, fromHouse)) return false;
    put(model, at, std::atan2(out.x, out.y) * 180 / kPi, 1);
    taken_.push_back({at, radius});
    return true;
}

void Layout::leanOnWall(const std::string& model, const Outline& house, float radius, float depth, uint32_t salt) {
    for (uint32_t i = 0; i < kTries; ++i) {
        const size_t side = hash32(salt, i, 151) % house.size();
        const vec2 a = house[side], b = house[(side + 1) % house.size()], out = outOf(a, b);
        const float length = glm::distance(a, b), free = length - 2 * radius - 0.6f;
        if (free < 0) continue;
        const vec2 foot = glm::mix(a, b, (radius + 0.3f + free * random01(salt, i, 152)) / length);
        const bool before = std::any_of(plan_.doors.begin(), plan_.doors.end(), [&](const Door& door) {
            return glm::distance(door.at, foot) < radius + kDoorway;
        });
        if (!before && place(model, foot + depth * out, out, radius, depth - 0.1f)) return;
    }
}

void Layout::walls() {
    for (const Door& door : plan_.fronts)
        for (float side : {-1.0f, 1.0f}) {
            const vec2 at = door.at + 0.46f * door.out + side * 1.12f * vec2(-door.out.y, door.out.x);
            if (!place("tub", at, door.out, 0.3f, 0.4f)) continue;
            const uint32_t which = hash32(uint32_t(&door - plan_.fronts.data()), 153) % 2;
            put(which ? "flowers_b" : "flowers_c", at, 90 * side, 1.1f, -kTubHigh);
        }
    for (uint32_t h = 0; h < plan_.houses.size(); ++h) {
        const Outline& o = plan_.houses[h];
        leanOnWall("woodpile", o, 1.15f, 0.42f, h);
        leanOnWall("seat", o, 0.9f, 0.40f, h + 100);
        leanOnWall("barrel", o, 0.35f, 0.44f, h + 200);
        leanOnWall("barrel", o, 0.35f, 0.44f, h + 300);
    }
}

// From the gate to the house.
void Layout::steps(const Garden& g, vec2 gate) {
    const vec2 door = g.at(0.5f, 0) + 1.0f * g.out;
    const Line line =
        curve({gate, gate - 2.0f * g.along, 0.5f * (gate + door) + 0.8f * g.out, door + 1.2f * g.out, door});
    float walked = 0;
    for (size_t i = 1; i < line.size(); ++i) {
        walked += glm::distance(line[i - 1], line[i]);
        if (walked < kStep) continue;
        walked = 0;
        if (!clear(line[i], kStone, 0.5f)) continue;
        put("step", line[i], 360 * random01(uint32_t(i), 154), 0.85f + 0.2f * random01(uint32_t(i), 155));
        taken_.push_back({line[i], kStone});
    }
}

// Rows of flowers between boards.
void Layout::plantBed(vec2 at, vec2 along, vec2 out, uint32_t salt) {
    const char* kinds[] = {"flowers_a", "flowers_b", "flowers_c"};
    for (uint32_t row = 0; row < 3; ++row)
        for (uint32_t i = 0; i < 5; ++i) {
            const auto random = [&](uint32_t which) { return random01(salt * 16 + row, i, which) - 0.5f; };
            const vec2 p = at + (0.47f * (float(i) - 2) + 0.1f * random(158)) * along + 0.42f * (float(row) - 1) * out;
            put(kinds[(salt + row) % 3], p, 360 * random(159), 1.25f + 0.3f * random(160));
        }
}

void Layout::furnish(const Garden& g, uint32_t salt) {
    const float fence = std::round(g.deep / 2);  // pieces
    steps(g, g.at(1, 1.5f / fence) - 1.2f * g.along);
    const struct {
        const char* model;
        float radius;
        uint32_t every;     // so many gardens have one
        float least, most;  // depth, a share of the garden's
    } things[] = {{"boards", 1.48f, 1, 0.45f, 0.8f},
                  {"boards", 1.48f, 2, 0.45f, 0.8f},
                  {"hives", 0.95f, 3, 0.6f, 0.8f},
                  {"washing", 2.0f, 2, 0.4f, 0.7f}};
    uint32_t which = salt * 16;
    for (const auto& thing : things) {
        ++which;
        if ((salt + which) % thing.every != 0) continue;
        for (uint32_t i = 0; i < kTries; ++i) {
            const vec2 p = g.at(0.12f + 0.76f * random01(which, i, 156),
                                glm::mix(thing.least, thing.most, random01(which, i, 157)));
            if (!place(thing.model, p, -g.out, thing.radius, thing.radius)) continue;
            if (thing.model == std::string("boards")) plantBed(p, g.along, g.out, which);
            break;
        }
    }
}

}  // namespace espalier::content
