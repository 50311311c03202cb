// Gutters and downpipes, chimneys, dormers, skylights, railings. In: nothing. Out: meshes in the unit box of their
// shape, x along, y up and z out of a wall; chimneys stand on a ridge with z up; a dormer's z is the roof's run.
#include "tools/content/roof_solid.hpp"

namespace espalier::content {
namespace {

using glm::vec3;

// A half-round trough with a bead at its front edge, closed at both ends; open above.
Mesh gutter(int lod) {
    const int steps = lod == 0 ? 6 : 3;
    auto round = [](float x, float u) {
        const float a = 3.14159265f * u;
        return vec3(x, 1 - std::sin(a), 0.5f - 0.5f * std::cos(a));
    };
    Solid s;
    s.sheet(1, steps, [&](float u, float t) { return round(u, t); });
    for (int i = 0; i < steps; ++i)
        for (float x : {0.0f, 1.0f}) {
            const vec3 a = round(x, float(i) / float(steps)), b = round(x, float(i + 1) / float(steps));
            s.triangle(vec3(x, 1, 0.5f), x > 0 ? a : b, x > 0 ? b : a);
        }
    if (lod == 0) s.box({0, 0.9f, 0.97f}, {1, 1.04f, 1.07f});
    return s.mesh;
}

Mesh pipe(int lod) {
    const int around = lod == 0 ? 8 : 4;
    Solid s;
    s.sheet(around, 1, [](float u, float t) {
        const float a = 6.2831853f * u;
        return vec3(0.5f + 0.5f * std::sin(a), t, 0.5f + 0.5f * std::cos(a));
    });
    return s.mesh;
}

// Courses of bricks up to a head that juts out, with two flues. It goes down as far as it stands up.
Mesh chimney(int lod) {
    constexpr int kCourses = 11;
    Solid s;
    uint32_t random = 12345;
    auto brick = [&] {
        random = random * 1664525u + 1013904223u;
        return 0.78f + 0.34f * float(random >> 16) / 65535.0f;
    };
    const glm::vec2 corners[] = {{0, -0.5f}, {1, -0.5f}, {1, 0.5f}, {0, 0.5f}};
    for (int side = 0; side < 4; ++side) {
        const glm::vec2 a = corners[side], b = corners[(side + 1) % 4];
        if (lod > 0) {
            s.quad({a, -1}, {b, -1}, {b, 0.86f}, {a, 0.86f}, 0.95f);
            continue;
        }
        s.quad({a, -1}, {b, -1}, {b, 0}, {a, 0}, 0.9f);
        for (int c = 0; c < kCourses; ++c) {
            const float z0 = 0.86f * float(c) / kCourses, z1 = 0.86f * float(c + 1) / kCourses;
            const float first = c % 2 ? 0.125f : 0.25f;
            for (float u = 0, v = first; u < 1; u = v, v = std::min(1.0f, v + 0.25f)) {
                const glm::vec2 p = glm::mix(a, b, u), q = glm::mix(a, b, v);
                s.quad({p, z0}, {q, z0}, {q, z1}, {p, z1}, brick());
            }
        }
    }
    s.box({-0.06f, -0.56f, 0.84f}, {1.06f, 0.56f, 0.9f}, 0.9f);
    s.box({-0.1f, -0.6f, 0.9f}, {1.1f, 0.6f, 0.97f}, 0.8f);
    if (lod > 0) return s.mesh;
    s.quad({-0.06f, -0.56f, 0.84f}, {-0.06f, 0.56f, 0.84f}, {1.06f, 0.56f, 0.84f}, {1.06f, -0.56f, 0.84f}, 0.6f);
    s.quad({-0.1f, -0.6f, 0.9f}, {-0.1f, 0.6f, 0.9f}, {1.1f, 0.6f, 0.9f}, {1.1f, -0.6f, 0.9f}, 0.6f);
    for (float x : {0.28f, 0.72f}) {
        s.sheet(8, 1, [x](float u, float t) {
            const float a = 6.2831853f * u, r = 1 - 0.15f * t;
            return vec3(x + 0.14f * r * std::cos(a), 0.22f * r * std::sin(a), 0.97f + 0.22f * t);
        });
        s.quad({x - 0.09f, -0.13f, 1.185f}, {x + 0.09f, -0.13f, 1.185f}, {x + 0.09f, 0.13f, 1.185f},
               {x - 0.09f, 0.13f, 1.185f}, 0.1f);
    }
    return s.mesh;
}

constexpr float kGable = 0.42f;  // of a dormer, above its walls

// Front with its gable and cheeks down to the roof, whose plane is y = -z.
Mesh dormer() {
    Solid s;
    s.quad({0, -0.1f, 0}, {1, -0.1f, 0}, {1, 1, 0}, {0, 1, 0});
    s.triangle({0, 1, 0}, {1, 1, 0}, {0.5f, 1 + kGable, 0});
    s.triangle({1, -0.1f, 0}, {1, 1, -1.1f}, {1, 1, 0}, 0.95f);
    s.triangle({0, -0.1f, 0}, {0, 1, 0}, {0, 1, -1.1f}, 0.95f);
    return s.mesh;
}

// Its two slopes in courses, whose lower edges are darker, with boards at the verges.
Mesh dormerRoof(int lod) {
    const int courses = lod == 0 ? 7 : 1;
    constexpr float kOut = 0.1f, kFront = 0.12f, kBoard = 0.07f;
    const float drop = kGable * 2 * kOut;
    Solid s;
    for (float side : {-1.0f, 1.0f}) {
        auto at = [&](float u, bool front, float lift) {  // u: 0 at the eave, 1 at the ridge
            const float y = 1 - drop + (kGable + drop) * u + lift;
            return vec3(0.5f + side * (0.5f + kOut) * (1 - u), y, front ? kFront : -y - 0.05f);
        };
        for (int c = 0; c < courses; ++c) {
            const float u = float(c) / float(courses), v = float(c + 1) / float(courses);
            const float up = 0.05f, low = c == 0 && courses == 1 ? up : up - 0.018f;
            const vec3 a = at(u, true, up), b = at(u, false, up), d = at(v, true, low), e = at(v, false, low);
            if (side > 0)
                s.quad(a, b, e, d);
            else
                s.quad(b, a, d, e);
            const vec3 down(0, -0.022f, 0);
            if (lod == 0) s.quad(a + down, b + down, b, a, 0.55f);
        }
        const vec3 board(0, -kBoard, 0), a = at(0, true, 0.05f), b = at(1, true, 0.05f), e = at(0, false, 0.05f);
        s.quad(a + board, b + board, b, a, 0.7f);
        s.quad(e + board, a + board, a, e, 0.7f);
    }
    return s.mesh;
}

// Upstand around a pane.
Mesh skylight() {
    constexpr float kRim = 0.08f;
    Solid s;
    s.box({0, 0, 0}, {1, kRim, 1}).box({0, 1 - kRim, 0}, {1, 1, 1.1f});
    return s.box({0, kRim, 0}, {kRim, 1 - kRim, 1}).box({1 - kRim, kRim, 0}, {1, 1 - kRim, 1}).mesh;
}

Mesh railing(int lod) {
    Solid s;
    s.box({0, 0.93f, 0}, {1, 1, 1}).box({0, 0.04f, 0.25f}, {1, 0.08f, 0.75f});
    const int bars = lod == 0 ? 11 : 5;
    for (int i = 0; i < bars; ++i) {
        const float x = (float(i) + 0.5f) / float(bars), half = lod == 0 ? 0.011f : 0.014f;
        s.box({x - half, 0.06f, 0.3f}, {x + half, 0.94f, 0.7f});
    }
    return s.mesh;
}

}  // namespace

void addFittings(RoofMeshes& out) {
    for (int lod : {0, 1}) {
        const std::string end = "_lod" + std::to_string(lod);
        out.all.push_back({"gutter" + end, gutter(lod), 1});
        out.all.push_back({"pipe" + end, pipe(lod), 1});
        out.all.push_back({"chimney" + end, chimney(lod), 0});
        out.all.push_back({"dormerroof" + end, dormerRoof(lod), 0});
        out.all.push_back({"railing" + end, railing(lod), 1});
    }
    out.all.push_back({"dormer_lod0", dormer(), 0});
    out.all.push_back({"skylight_lod0", skylight(), 1});
}

}  // namespace espalier::content
