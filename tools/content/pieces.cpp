// In: nothing. Out: closed meshes, so that patterns know what is inside of them.
#include "tools/content/pieces.hpp"

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

// A body turned about z: radius and height along its profile from pole to pole. form moves its points.
using Form = std::function<vec3(vec3)>;
Solid turnedBody(int around, const std::vector<vec2>& profile, const Form& form = nullptr,
                 const Solid::Shade& shade = nullptr) {
    const int up = int(profile.size()) - 1;
    const auto at = [&profile, up](float t) {
        const float x = std::clamp(t, 0.0f, 1.0f) * float(up);
        const int i = std::min(int(x), up - 1);
        return glm::mix(profile[i], profile[i + 1], x - float(i));
    };
    Solid solid;
    solid.sheet(
        around, up,
        [&](float s, float t) {
            const vec2 p = at(t);
            const float a = turnOf(s);
            const vec3 v(p.x * std::cos(a), p.x * std::sin(a), p.y);
            return form ? form(v) : v;
        },
        shade);
    return solid;
}

std::vector<vec2> ballProfile(int rings, float low = -1) {
    std::vector<vec2> profile;
    for (int i = 0; i <= rings; ++i) {
        const float a = std::numbers::pi_v<float> * (float(i) / float(rings) - .5f);
        const bool pole = i == 0 || i == rings;
        profile.push_back({pole ? 0 : .5f * std::cos(a), .5f * std::max(std::sin(a), low)});
    }
    return profile;
}
// Half a ball on a flat bottom.
std::vector<vec2> domeProfile(int rings, float height) {
    std::vector<vec2> profile{{0, 0}, {.5f, 0}};
    for (int i = 1; i <= rings; ++i) {
        const float a = .5f * std::numbers::pi_v<float> * float(i) / float(rings);
        profile.push_back({i == rings ? 0 : .5f * std::cos(a), height * std::sin(a)});
    }
    return profile;
}

// A bar from -0.5 to 0.5 with round ends beyond, as lines are made of.
std::vector<vec2> roundBar(int steps) {
    constexpr int kEnd = 3;
    std::vector<vec2> profile{{0, -1}};
    const auto end = [&](int i) { return .5f * std::numbers::pi_v<float> * float(i) / float(kEnd); };
    for (int i = kEnd - 1; i > 0; --i) profile.push_back({.5f * std::cos(end(i)), -.5f - .5f * std::sin(end(i))});
    for (int i = 0; i <= steps; ++i) profile.push_back({.5f, float(i) / float(steps) - .5f});
    for (int i = 1; i < kEnd; ++i) profile.push_back({.5f * std::cos(end(i)), .5f + .5f * std::sin(end(i))});
    profile.push_back({0, 1});
    return profile;
}

// A thin bar with half a ball at either end: bars that follow each other make balls where they meet.
std::vector<vec2> edgeBar(int rings) {
    constexpr float kBar = .22f, kBall = .8f;
    const float quarter = .5f * std::numbers::pi_v<float>;
    std::vector<vec2> front;
    for (int i = 0; i < rings; ++i) {
        const float a = quarter * float(i) / float(rings);
        front.push_back({kBall * std::cos(a), .5f + kBall * std::sin(a)});
    }
    front.push_back({0, .5f + kBall});
    front.insert(front.begin(), {kBar, .42f});
    std::vector<vec2> profile;
    for (size_t i = front.size(); i-- > 0;) profile.push_back({front[i].x, -front[i].y});
    profile.insert(profile.end(), front.begin(), front.end());
    return profile;
}

Solid ring(int around, int tube, float large, float small, const Form& form = nullptr) {
    Solid solid;
    solid.sheet(around, tube, [&](float s, float t) {
        const float a = turnOf(s), b = turnOf(t), r = large + small * std::cos(b);
        const vec3 v(r * std::cos(a), r * std::sin(a), small * std::sin(b));
        return form ? form(v) : v;
    });
    return solid;
}

// An outline, counterclockwise, raised to a height with a bevel; its top rises towards the middle by `swell`.
Solid raised(const std::vector<vec2>& outline, float height, float bevel, float swell) {
    Solid solid;
    const size_t n = outline.size();
    const auto low = [&](size_t i) { return vec3(outline[i % n], 0); };
    const auto side = [&](size_t i) { return vec3(outline[i % n], height - bevel); };
    const auto top = [&](size_t i) { return vec3(outline[i % n] * (1 - 2 * bevel), height); };
    const vec3 foot(0, 0, 0), crown(0, 0, height + swell);
    for (size_t i = 0; i < n; ++i) {
        solid.triangle(foot, low(i + 1), low(i), .6f);
        solid.quad(low(i), low(i + 1), side(i + 1), side(i), .8f);
        solid.quad(side(i), side(i + 1), top(i + 1), top(i), .95f);
        solid.triangle(top(i), top(i + 1), crown);
    }
    return solid;
}

std::vector<vec2> polygon(int corners, float radius, float turn = 0) {
    std::vector<vec2> points;
    for (int i = 0; i < corners; ++i) {
        const float a = kTurn * float(i) / float(corners) + turn;
        points.push_back({radius * std::cos(a), radius * std::sin(a)});
    }
    return points;
}
std::vector<vec2> starOutline(int rays) {
    std::vector<vec2> points;
    for (int i = 0; i < 2 * rays; ++i) {
        const float a = kTurn * float(i) / float(2 * rays), r = i % 2 ? .21f : .5f;
        points.push_back({r * std::cos(a), r * std::sin(a)});
    }
    return points;
}

// A sheet over (s, t) with a thickness: both sides and the rims.
Solid leafOf(int across, int up, float thick, const Solid::Point& point, const Solid::Shade& shade = nullptr) {
    Solid solid;
    const auto at = [&](int i, int j) { return point(float(i) / float(across), float(j) / float(up)); };
    const vec3 down(0, 0, -thick);
    for (int j = 0; j < up; ++j)
        for (int i = 0; i < across; ++i) {
            const vec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            const float bright = shade ? shade((float(i) + .5f) / float(across), (float(j) + .5f) / float(up)) : 1;
            solid.quad(a, b, c, d, bright);
            solid.quad(d + down, c + down, b + down, a + down, .6f);
        }
    for (int i = 0; i < across; ++i) {
        solid.quad(at(i, 0) + down, at(i + 1, 0) + down, at(i + 1, 0), at(i, 0), .8f);
        solid.quad(at(i + 1, up) + down, at(i, up) + down, at(i, up), at(i + 1, up), .8f);
    }
    for (int j = 0; j < up; ++j) {
        solid.quad(at(0, j + 1) + down, at(0, j) + down, at(0, j), at(0, j + 1), .8f);
        solid.quad(at(across, j) + down, at(across, j + 1) + down, at(across, j + 1), at(across, j), .8f);
    }
    return solid;
}

// A scale as of a fish or a roof: its root lies on the surface at x = -0.5, its round tip stands up a little at x =
// 0.5.
Solid scale(int across, int up) {
    return leafOf(
        up, across, .05f,
        [](float s, float t) {
            // Rows around the tip stand at even angles, which makes it round by few of them.
            const float turn = s < .5f ? 0 : (s - .5f) * std::numbers::pi_v<float>;
            const float x = s < .5f ? s : .5f + .5f * std::sin(turn), y = 2 * t - 1;
            const float half = .5f * std::cos(turn);
            const float rise = .06f + .16f * x + .16f * (1 - y * y) * (1 - .4f * x);
            return vec3(x - .5f, half * y, rise);
        },
        [](float s, float t) { return .45f + .55f * s - .15f * std::abs(2 * t - 1); });
}

Solid leaf(int across, int up) {
    return leafOf(up, across, .02f, [](float s, float t) {
        const float y = 2 * t - 1;
        const float half = .34f * std::sin(std::numbers::pi_v<float> * std::pow(std::clamp(s, 0.0f, 1.0f), .75f));
        const float rise = .05f + .12f * std::sin(std::numbers::pi_v<float> * s) + .14f * std::abs(y) * half * 3;
        return vec3(s, half * y, rise);
    });
}

void append(Mesh& to, const Mesh& from) {
    const uint32_t first = uint32_t(to.positions.size());
    to.positions.insert(to.positions.end(), from.positions.begin(), from.positions.end());
    to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
    to.uvs.insert(to.uvs.end(), from.uvs.begin(), from.uvs.end());
    for (uint32_t i : from.indices) to.indices.push_back(first + i);
    for (uint32_t i = first; i < to.positions.size(); ++i) to.weld.push_back(i);
}

Mesh blossom(int petals, int across, int up) {
    Mesh mesh;
    for (int p = 0; p < petals; ++p) {
        const float a = kTurn * float(p) / float(petals), c = std::cos(a), s = std::sin(a);
        const Solid petal = leafOf(up, across, .03f, [=](float x, float t) {
            const float y = 2 * t - 1, r = .08f + .42f * x;
            const float half = .2f * std::sin(std::numbers::pi_v<float> * (.12f + .8f * x));
            const float rise = .06f + .22f * x * x + .05f * y * y;
            return vec3(c * r - s * half * y, s * r + c * half * y, rise);
        });
        append(mesh, petal.mesh);
    }
    append(mesh, turnedBody(
                     8, domeProfile(3, .2f), [](vec3 p) { return vec3(p.x * .3f, p.y * .3f, p.z + .04f); },
                     [](float, float) { return .55f; })
                     .mesh);
    return mesh;
}

// From a body whose z leads up to one whose y does.
Mesh upright(Mesh mesh) {
    for (std::vector<vec3>* all : {&mesh.positions, &mesh.normals})
        for (vec3& v : *all) v = {v.x, v.z, -v.y};
    return mesh;
}

}  // namespace

PieceMeshes makePieceMeshes() {
    PieceMeshes out;
    const auto add = [&](const char* kind, int lod, const Mesh& mesh, int material) {
        out.all.push_back({std::string(kind) + "_lod" + std::to_string(lod), upright(mesh), material});
    };
    const auto cobble = [](vec3 p) {
        return vec3(p.x * (1 + .06f * std::sin(3 * p.y)), p.y, p.z * (1 - .5f * (p.x * p.x + p.y * p.y)));
    };
    const auto alongY = [](vec3 p) { return vec3(p.x, -p.z, p.y); };
    const auto alongX = [](vec3 p) { return vec3(p.z, p.x, p.y); };
    // Lines stand out of the ground by more than half.
    const auto raisedAlongX = [](vec3 p) { return vec3(p.z, p.x, p.y + .2f); };
    const auto flat = [](vec3 p) { return vec3(p.z, p.x, .3f * p.y + .1f); };
    const auto oval = [](vec3 p) { return vec3(p.x, p.y * .72f, p.z + .12f + .14f * p.x); };
    const std::vector<vec2> drum{{0, -.5f}, {.5f, -.5f}, {.5f, .5f}, {0, .5f}};
    const std::vector<vec2> bar{{0, 0}, {.5f, 0}, {.5f, 1}, {0, 1}};
    for (int lod = 0; lod < 3; ++lod) {
        const int n = 24 >> lod, m = 12 >> lod;
        add("torus", lod, ring(n, std::max(m, 4), .38f, .12f).mesh, 1);
        add("link", lod, ring(std::max(n * 2 / 3, 6), std::max(m / 2, 3), .4f, .085f, oval).mesh, 1);
        add("ball", lod, turnedBody(std::max(n * 2 / 3, 6), ballProfile(std::max(m * 2 / 3, 3))).mesh, 1);
        add("stud", lod, turnedBody(std::max(n / 2, 6), domeProfile(std::max(m / 3, 1), .4f)).mesh, 1);
        add("ellipse", lod, turnedBody(std::max(n * 2 / 3, 6), domeProfile(std::max(m / 3, 1), .5f)).mesh, 1);
        add("cobble", lod, turnedBody(std::max(n / 2, 6), domeProfile(std::max(m / 3, 2), .55f), cobble).mesh, 0);
        add("cylinder", lod, turnedBody(std::max(n / 2, 5), drum, alongY).mesh, 0);
        add("rod", lod, turnedBody(std::max(n / 2, 5), bar, alongX).mesh, 0);
        add("tube", lod, turnedBody(std::max(n / 2, 5), roundBar(std::max(m * 2 / 3, 2)), raisedAlongX).mesh, 0);
        add("band", lod, turnedBody(std::max(n / 2, 6), roundBar(std::max(m * 2 / 3, 2)), flat).mesh, 1);
        add("scale", lod, scale(lod == 2 ? 2 : 6 - 2 * lod, lod == 2 ? 3 : 8 - 4 * lod).mesh, 1);
        add("leaf", lod, leaf(2, lod == 2 ? 2 : 6 >> lod).mesh, 0);
        add("blossom", lod, blossom(5, 2, lod == 0 ? 4 : 2), 0);
    }
    // By which pieces meet others that lie over or run into them by design.
    add("scale_collider", 0, raised(polygon(6, .24f), .2f, .01f, 0).mesh, 0);
    add("link_collider", 0, raised(polygon(6, .3f), .2f, .01f, 0).mesh, 0);
    const std::vector<vec2> shortBar{{0, .2f}, {.3f, .2f}, {.3f, .8f}, {0, .8f}};
    add("rod_collider", 0, turnedBody(6, shortBar, alongX).mesh, 0);
    // As Li 2011 calls two balls of its cracks.
    for (const char* kind : {"ico1", "ico2"})
        for (int lod = 0; lod < 2; ++lod) add(kind, lod, turnedBody(10 - 4 * lod, ballProfile(6 - 2 * lod)).mesh, 1);
    add("box", 0, raised(polygon(4, .70710678f, kTurn / 8), 1, .002f, 0).mesh, 0);
    add("tile", 0, raised(polygon(4, .70710678f, kTurn / 8), .25f, .05f, 0).mesh, 1);
    add("hexagon", 0, raised(polygon(6, .5f), .25f, .05f, .02f).mesh, 1);
    add("triangle", 0, raised(polygon(3, .57735027f), .25f, .05f, 0).mesh, 1);
    add("star", 0, raised(starOutline(5), .18f, .03f, .08f).mesh, 1);
    for (int lod = 0; lod < 3; ++lod)
        add("edge", lod, turnedBody(12 - 3 * lod, edgeBar(4 - lod), raisedAlongX).mesh, 1);
    return out;
}

}  // namespace espalier::content
