// In: nothing. Out: smooth bodies of some thousand triangles.
#include "tools/content/forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/content/roof_solid.hpp"

namespace espalier::content {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

// The angle of a share of a turn; the same bits at both ends.
float turnOf(float s) {
    return kTurn * (s - std::floor(s));
}

// A smooth curve through points (Catmull-Rom), at a share of its way; before and behind it goes straight on.
vec2 through(const std::vector<vec2>& points, float share) {
    if (share == 1) return points.back();  // to the bit, so that bodies are closed there
    const float x = share * float(points.size() - 1);
    const int i = std::clamp(int(std::floor(x)), 0, int(points.size()) - 2);
    const float t = x - float(i);
    const auto at = [&](int k) { return points[size_t(std::clamp(k, 0, int(points.size()) - 1))]; };
    const vec2 a = at(i - 1), b = at(i), c = at(i + 1), d = at(i + 2);
    return .5f * (2.0f * b + (c - a) * t + (2.0f * a - 5.0f * b + 4.0f * c - d) * t * t +
                  (3.0f * b - a - 3.0f * c + d) * t * t * t);
}

// Turned about the y axis: radius and height from the foot's middle around to the end.
Solid turned(const std::vector<vec2>& profile, int around, int up) {
    Solid solid;
    solid.sheet(around, up, [&](float s, float t) {
        const vec2 p = through(profile, t);
        const float a = turnOf(s), r = std::max(p.x, 0.0f);
        return vec3(r * std::cos(a), p.y, -r * std::sin(a));
    });
    return solid;
}

Solid vase() {
    // Outside up to the lip, then inside down to the bottom.
    return turned({{0, 0},
                   {.24f, 0},
                   {.26f, .04f},
                   {.22f, .12f},
                   {.34f, .36f},
                   {.46f, .66f},
                   {.44f, .92f},
                   {.28f, 1.16f},
                   {.2f, 1.3f},
                   {.22f, 1.42f},
                   {.3f, 1.5f},
                   {.28f, 1.51f},
                   {.17f, 1.38f},
                   {.16f, 1.26f},
                   {.2f, 1.1f},
                   {.2f, .9f},
                   {0, .85f}},
                  72, 96);
}

Solid pear() {
    return turned({{0, .03f},
                   {.12f, 0},
                   {.3f, .06f},
                   {.45f, .24f},
                   {.5f, .46f},
                   {.44f, .7f},
                   {.31f, .92f},
                   {.23f, 1.12f},
                   {.2f, 1.28f},
                   {.12f, 1.4f},
                   {0, 1.42f}},
                  64, 72);
}

// A breastplate and a backplate in one: broad at the chest, narrow at the waist, with a ridge in front.
Solid cuirass() {
    struct Girth {
        float height, side, depth;
    };
    const std::vector<Girth> girths{{0, 0, 0},           {.0f, .3f, .2f},   {.1f, .33f, .225f}, {.35f, .3f, .2f},
                                    {.6f, .36f, .24f},   {.9f, .43f, .27f}, {1.15f, .4f, .23f}, {1.28f, .24f, .16f},
                                    {1.36f, .14f, .13f}, {1.4f, 0, 0}};
    std::vector<vec2> sides, depths;
    for (const Girth& g : girths) sides.push_back({g.side, g.height}), depths.push_back({g.depth, g.height});
    Solid solid;
    solid.sheet(80, 80, [&](float s, float t) {
        const vec2 side = through(sides, t), depth = through(depths, t);
        const float a = turnOf(s), c = std::cos(a), front = -std::sin(a);
        // Squarer than an ellipse; the ridge is a fold of the chest's middle.
        const float square = std::pow(c * c * c * c + front * front * front * front, -.25f);
        const float chest = std::exp(-40 * (side.y - .85f) * (side.y - .85f) * .2f);
        const float ridge = front > 0 ? 1 + .16f * chest * std::exp(-24 * c * c) : 1;
        return vec3(std::max(side.x, 0.0f) * c * square, side.y, std::max(depth.x, 0.0f) * front * square * ridge);
    });
    return solid;
}

// A tube along a trefoil, which stands upright.
Solid knot() {
    const auto middle = [](float u) {
        const float a = kTurn * u;
        return vec3(std::sin(a) + 2 * std::sin(2 * a), std::cos(a) - 2 * std::cos(2 * a), -std::sin(3 * a) * 1.15f) *
               .21f;
    };
    Solid solid;
    solid.sheet(40, 220, [&](float s, float t) {
        const float u = t - std::floor(t), step = 1e-3f;
        const vec3 along = glm::normalize(middle(u + step) - middle(u - step));
        const vec3 side = glm::normalize(glm::cross(along, vec3(0, 0, 1)));
        const vec3 out = glm::cross(side, along);
        const float a = turnOf(s);
        return middle(u) + .15f * (std::cos(a) * side - std::sin(a) * out) + vec3(0, .82f, 0);
    });
    return solid;
}

// It stands upright and faces z.
Solid torus() {
    constexpr float kRing = .5f, kTube = .24f;
    Solid solid;
    solid.sheet(96, 48, [](float s, float t) {
        const float a = turnOf(s), b = turnOf(t), r = kRing + kTube * std::cos(b);
        return vec3(r * std::cos(a), kRing + kTube + r * std::sin(a), kTube * std::sin(b));
    });
    return solid;
}

// Upright, it faces z; a picture over its texture coordinates hangs on it as on a wall.
Mesh plane() {
    constexpr int kSquares = 32;
    Solid solid;
    solid.sheet(kSquares, kSquares, [](float s, float t) { return vec3(2 * s - 1, 2 * t, 0); });
    for (size_t i = 0; i < solid.mesh.positions.size(); ++i) {
        const vec3 p = solid.mesh.positions[i];
        solid.mesh.uvs[i] = {.5f * p.x + .5f, 1 - .5f * p.y};
    }
    return std::move(solid.mesh);
}

}  // namespace

FormMeshes makeForms() {
    return {{{"cuirass", cuirass().mesh},
             {"vase", vase().mesh},
             {"knot", knot().mesh},
             {"pear", pear().mesh},
             {"torus", torus().mesh},
             {"tori", makeLinkedTori()},
             {"plane", plane()}}};
}

}  // namespace espalier::content
