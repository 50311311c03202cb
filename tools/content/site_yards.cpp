// What belongs to houses. In: the plan. Out: yards before doors, gardens behind, beds along walls.

#include "tools/content/maths.hpp"
#include "tools/content/site_layout.hpp"

#include <algorithm>
#include <cmath>

#include "tools/content/noise.hpp"

namespace espalier::content {

using glm::vec2;
constexpr float kPiece = 1.9f, kHalfGate = 0.75f;  // of a yard's fence

vec2 Layout::outOf(vec2 a, vec2 b) const {
    const vec2 along = glm::normalize(b - a), out(along.y, -along.x);
    return plan_.toHouse(0.5f * (a + b) + 0.5f * out) < 0 ? -out : out;
}

void Layout::row(const std::string& piece, vec2 a, vec2 b, int gate) {
    const float length = glm::distance(a, b);
    const int count = std::max(1, int(std::round(length / 2)));
    const float degrees = -std::atan2(b.y - a.y, b.x - a.x) * 180 / kPi, scale = length / (2 * float(count));
    // Pieces of fences have a post where they begin, walls have piers at both ends.
    const bool posts = piece == "fence" || piece == "rails", piers = piece == "wall";
    const auto joint = [&](int i) { return glm::mix(a, b, float(i) / float(count)); };
    const auto stand = [&](const char* what, vec2 at, float room) {
        if (plan_.toHouse(at) > room && (posts || plan_.paved(at) < -0.3f)) put(what, at, degrees, 1);
    };
    for (int i = 0, last = -1; i <= count; ++i) {
        const vec2 at = glm::mix(a, b, (float(i) + 0.5f) / float(count));
        const bool into = std::min(plan_.toHouse(joint(i)), plan_.toHouse(joint(i + 1))) < -0.1f;
        const bool goesOn = i > 0 && last == i - 1;
        if (i == count || i == gate || plan_.paved(at) > -0.3f || plan_.toHouse(at) < 0.25f || into) {
            if (posts && goesOn) stand("post", joint(i), 0.1f);
            if (piers && goesOn) stand("pier", joint(i), 0.3f);
            continue;
        }
        if (piers && !goesOn) stand("pier", joint(i), 0.3f);
        put(piece, at, degrees, scale, 0);
        taken_.push_back({at, piece == "hedge" ? 1.3f : 1.0f});
        last = i;
    }
}

// A yard before each door that a path leads to: fenced towards the street on both sides of the gate and back to the
// wall, in pieces of one length.
void Layout::yards() {
    const char* kinds[] = {"hedge", "fence", "wall"};
    for (uint32_t i = 0; i < plan_.fronts.size(); ++i) {
        const Door& door = plan_.fronts[i];
        const Outline& o = plan_.nearestHouse(door.at);
        const char* kind = kinds[uint32_t(&o - plan_.houses.data()) % 3];
        int deep = 2;
        while (deep > 0 && plan_.paved(door.at + (kPiece * float(deep) + 0.4f) * door.out +
                                       1.6f * glm::vec2(-door.out.y, door.out.x)) > 0)
            --deep;
        if (deep == 0) continue;
        // To the wall's corners, or as far as there's room before the street.
        const float out = kPiece * float(deep);
        const auto end = [&](vec2 along, int pieces) {
            return door.at + out * door.out + (kHalfGate + kPiece * float(pieces)) * along;
        };
        const vec2 ways[2] = {{-door.out.y, door.out.x}, {door.out.y, -door.out.x}};
        int pieces[2];
        for (int k = 0; k < 2; ++k) {
            float reach = 0;
            for (vec2 corner : o)
                if (std::abs(glm::dot(corner - door.at, door.out)) < 0.2f)
                    reach = std::max(reach, glm::dot(corner - door.at, ways[k]));
            pieces[k] = int((reach - kHalfGate - 0.2f) / kPiece);
            while (pieces[k] > 0 && plan_.paved(end(ways[k], pieces[k])) > -0.4f) --pieces[k];
        }
        if (std::min(pieces[0], pieces[1]) < 1) continue;
        for (int k = 0; k < 2; ++k) {
            const vec2 corner = end(ways[k], pieces[k]);
            row(kind, end(ways[k], 0), corner);
            row(kind, corner, corner - out * door.out);
        }
    }
}

Layout::Garden Layout::gardenOf(const Outline& o, uint32_t salt) const {
    // The widest side whose middle lies farthest from streets.
    float best = 1e9f;
    size_t side = 0;
    for (size_t i = 0; i < o.size(); ++i) {
        const vec2 a = o[i], b = o[(i + 1) % o.size()];
        if (glm::distance(a, b) < 5) continue;
        const float score = plan_.paved(0.5f * (a + b)) - 0.2f * glm::distance(a, b);
        if (score < best) best = score, side = i;
    }
    const vec2 a = o[side], b = o[(side + 1) % o.size()], along = glm::normalize(b - a);
    return {a - along * 1.5f, b + along * 1.5f, along, outOf(a, b), 7 + 3 * random01(salt, 31)};
}

// Each house has a garden at the side away from the street, fenced in one of three ways, a gate in its side. All fences
// come first: gardens lie close to each other.
void Layout::gardens() {
    const char* kinds[] = {"fence", "wall", "hedge"};
    std::vector<Garden> gardens;
    for (uint32_t h = 0; h < plan_.houses.size(); ++h) {
        const Garden& g = gardens.emplace_back(gardenOf(plan_.houses[h], h));
        const char* kind = kinds[h % 3];
        const vec2 a = g.at(0, 0), b = g.at(1, 0), c = g.at(1, 1), d = g.at(0, 1);
        row(kind, b, c, 1);
        row(kind, c, d);
        row(kind, d, a);
    }
    for (uint32_t h = 0; h < gardens.size(); ++h) {
        furnish(gardens[h], h);
        for (uint32_t i = 0; i < 3; ++i) {
            const vec2 p = gardens[h].at(random01(h, i, 32), 0.35f + 0.4f * random01(h, i, 33));
            if (clear(p, 1.8f, 2.6f))
                tree(i % 2 ? "apple_a" : "apple_b", p, 0.8f + 0.35f * random01(h, i, 34), 1.9f, h * 8 + i);
        }
    }
}

// Beds along a house's walls, between its corners and what may be a door: flowers of one kind, a bush at the
// corner.
void Layout::beds() {
    const char* kinds[] = {"flowers_b", "flowers_a", "flowers_c"};
    for (uint32_t h = 0; h < plan_.houses.size(); ++h) {
        const Outline& o = plan_.houses[h];
        for (uint32_t side = 0; side < o.size(); ++side) {
            const auto random = [&](uint32_t i, uint32_t which) { return random01(h * 16 + side, i, which); };
            const vec2 a = o[side], b = o[(side + 1) % o.size()], along = glm::normalize(b - a);
            const float bed = 0.5f * glm::distance(a, b) - 1.6f;
            const vec2 out = outOf(a, b);
            for (uint32_t end : {0u, 1u}) {
                if (bed < 0.8f || random(end, 81) < 0.35f) continue;
                const vec2 from = end ? b : a, way = end ? -along : along;
                const vec2 corner = from + 0.7f * way + 0.75f * out;
                if (random(end, 82) < 0.6f && clear(corner, 0.6f, 0.5f))
                    put("bush_b", corner, 360 * random(end, 83), 0.55f + 0.3f * random(end, 84), 0.04f);
                for (float x = 1.4f; x < bed; x += 0.38f) {
                    const uint32_t i = uint32_t(x * 100) * 2 + end;
                    const vec2 p = from + (x + 0.2f * random(i, 85)) * way + (0.36f + 0.25f * random(i, 86)) * out;
                    if (random(i, 87) < 0.8f && clear(p, 0.15f, 0.25f))
                        put(kinds[h % 3], p, 360 * random(i, 88), 0.8f + 0.5f * random(i, 89), 0.02f);
                }
            }
        }
    }
}

}  // namespace espalier::content
