// What is built on the site: garden walls, fences, a well, a bench. In: nothing. Out: meshes whose texture
// coordinates pick colours of the palette.

#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tools/content/builder.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

using glm::vec3;

// A stone in a wall's face: its front drawn in towards the joints. The face is the plane z = depth, seen from side.
void addStone(Builder& builder, float x0, float x1, float y0, float y1, float depth, float side, float bright) {
    const float in = 0.022f, out = depth + 0.014f;
    const auto at = [&](float x, float y, float z) { return vec3(x * side, y, z * side); };
    const vec3 a = at(x0, y0, depth), b = at(x1, y0, depth), c = at(x1, y1, depth), d = at(x0, y1, depth);
    const vec3 e = at(x0 + in, y0 + in, out), f = at(x1 - in, y0 + in, out), g = at(x1 - in, y1 - in, out),
               h = at(x0 + in, y1 - in, out);
    builder.quad(e, f, g, h, Paint::stone, bright);
    builder.quad(a, b, f, e, Paint::stone, bright * 0.75f);
    builder.quad(b, c, g, f, Paint::stone, bright * 0.9f);
    builder.quad(c, d, h, g, Paint::stone, bright);
    builder.quad(d, a, e, h, Paint::stone, bright * 0.9f);
}

// Courses of rubble under slabs, from -1 to 1 m.
Mesh wall(int lod) {
    Builder b;
    constexpr float kHigh = 1.02f, kHalfThick = 0.19f;
    b.box({-1, -0.15f, -kHalfThick}, {1, kHigh, kHalfThick}, lod == 0 ? Paint::mortar : Paint::stone, 0.45f);
    if (lod == 0)
        for (float side : {1.0f, -1.0f}) {
            float y = -0.05f;
            for (uint32_t course = 0; y < kHigh - 0.05f; ++course) {
                const uint32_t salt = course * 2 + (side > 0 ? 1 : 0);
                const float y1 = std::min(y + 0.14f + 0.12f * random01(61, salt), kHigh);
                float x = -1;
                for (uint32_t i = 0; x < 0.98f; ++i) {
                    float x1 = x + 0.20f + 0.30f * random01(62, salt, i);
                    if (x1 > 0.82f) x1 = 1;
                    addStone(b, x + 0.008f, x1 - 0.008f, y + 0.008f, y1 - 0.008f, kHalfThick, side,
                             0.30f + 0.45f * random01(63, salt, i));
                    x = x1;
                }
                y = y1;
            }
        }
    for (int i = 0; i < 3; ++i) {
        const float x0 = -1 + 2 * float(i) / 3, x1 = x0 + 2.0f / 3, sag = 0.02f * random01(64, uint32_t(i));
        b.box({x0 + 0.008f, kHigh - sag, -0.25f}, {x1 - 0.008f, kHigh + 0.10f - sag, 0.25f}, Paint::stone,
              0.5f + 0.2f * random01(65, uint32_t(i)), 0.015f);
    }
    return b.mesh;
}

// A pier where a wall ends.
Mesh pier(int lod) {
    Builder b;
    for (int i = 0; i < (lod == 0 ? 4 : 1); ++i) {
        const float y0 = lod == 0 ? 0.34f * float(i) - 0.1f : -0.1f, y1 = lod == 0 ? y0 + 0.335f : 1.26f;
        const float half = 0.28f - 0.008f * random01(66, uint32_t(i));
        b.box({-half, y0, -half}, {half, y1, half}, Paint::stone, 0.45f + 0.2f * random01(67, uint32_t(i)), 0.008f);
    }
    b.box({-0.34f, 1.25f, -0.34f}, {0.34f, 1.36f, 0.34f}, Paint::stone, 0.62f, 0.02f);
    b.box({-0.22f, 1.36f, -0.22f}, {0.22f, 1.52f, 0.22f}, Paint::stone, 0.58f, 0.14f);
    return b.mesh;
}

// Pickets between posts, from -1 to 1 m.
Mesh fence(int lod) {
    Builder b;
    const Paint wood = Paint::wood;
    for (float y : {0.28f, 0.74f}) b.box({-1, y, -0.02f}, {1, y + 0.07f, 0.02f}, wood, 0.42f);
    b.box({-1.05f, -0.1f, -0.05f}, {-0.95f, 1.08f, 0.05f}, wood, 0.40f, 0.01f);
    const int pickets = 13;
    for (int i = 0; i < pickets; ++i) {
        const float x = -0.92f + 1.84f * float(i) / (pickets - 1), bright = 0.42f + 0.3f * random01(71, uint32_t(i));
        const float top = 0.98f + 0.03f * (random01(72, uint32_t(i)) - 0.5f);
        if (lod == 0) {
            b.box({x - 0.04f, 0.06f, 0.02f}, {x + 0.04f, top - 0.08f, 0.045f}, wood, bright);
            b.quad({x - 0.04f, top - 0.08f, 0.045f}, {x + 0.04f, top - 0.08f, 0.045f}, {x + 0.001f, top, 0.045f},
                   {x - 0.001f, top, 0.045f}, wood, bright);
            b.quad({x + 0.04f, top - 0.08f, 0.02f}, {x - 0.04f, top - 0.08f, 0.02f}, {x - 0.001f, top, 0.02f},
                   {x + 0.001f, top, 0.02f}, wood, bright);
        } else {
            b.quad({x - 0.045f, 0.06f, 0.03f}, {x + 0.045f, 0.06f, 0.03f}, {x + 0.03f, top, 0.03f},
                   {x - 0.03f, top, 0.03f}, wood, bright);
        }
    }
    return b.mesh;
}

// Two rails between posts, from -1 to 1 m; from afar flat.
Mesh rails(int lod) {
    Builder b;
    const auto board = [&](vec3 low, vec3 high, float bright) {
        if (lod == 0)
            b.box(low, high, Paint::wood, bright, 0.004f);
        else
            b.quad({low.x, low.y, 0}, {high.x, low.y, 0}, {high.x, high.y, 0}, {low.x, high.y, 0}, Paint::wood, bright);
    };
    board({-1.055f, -0.2f, -0.055f}, {-0.945f, 1.02f, 0.055f}, 0.40f);
    for (int i = 0; i < 2; ++i) {
        const float y = 0.42f + 0.38f * float(i);
        board({-1.0f, y, 0.03f}, {1.0f, y + 0.10f, 0.07f}, 0.48f + 0.14f * random01(75, uint32_t(i)));
    }
    return b.mesh;
}

// Of rails or pickets, where they end: within the post that a next piece may begin with.
Mesh post(int) {
    Builder b;
    b.box({-0.048f, -0.1f, -0.048f}, {0.048f, 1.01f, 0.048f}, Paint::wood, 0.40f);
    return b.mesh;
}

// A ring of stones, two posts with a windlass, a small roof of shingles.
Mesh well(int) {
    Builder b;
    constexpr int around = 14, courses = 3, rows = 5;
    const auto at = [](float a, float r, float y) { return vec3(r * std::cos(a), y, r * std::sin(a)); };
    for (int c = 0; c < courses; ++c)
        for (int i = 0; i < around; ++i) {
            const float a0 = 2 * kPi * (float(i) + 0.5f * float(c % 2)) / float(around),
                        a1 = a0 + 2 * kPi / float(around);
            const float g = 0.012f, y0 = 0.80f * float(c) / float(courses) - (c == 0 ? 0.1f : 0),
                        y1 = 0.80f * float(c + 1) / float(courses) - g;
            b.quad(at(a1 - g, 0.95f, y0), at(a0 + g, 0.95f, y0), at(a0 + g, 0.95f, y1), at(a1 - g, 0.95f, y1),
                   Paint::stone, 0.35f + 0.35f * random01(81, uint32_t(c), uint32_t(i)));
        }
    for (int i = 0; i < around; ++i) {
        const float a0 = 2 * kPi * float(i) / float(around), a1 = a0 + 2 * kPi / float(around),
                    bright = 0.55f + 0.15f * random01(82, uint32_t(i));
        b.quad(at(a1, 1.02f, 0.80f), at(a0, 1.02f, 0.80f), at(a0, 1.02f, 0.93f), at(a1, 1.02f, 0.93f), Paint::stone,
               bright * 0.9f);
        b.quad(at(a1, 1.02f, 0.93f), at(a0, 1.02f, 0.93f), at(a0, 0.62f, 0.93f), at(a1, 0.62f, 0.93f), Paint::stone,
               bright);
        b.quad(at(a0, 0.62f, 0.2f), at(a1, 0.62f, 0.2f), at(a1, 0.62f, 0.93f), at(a0, 0.62f, 0.93f), Paint::stone,
               0.25f);
        b.quad(at(a0, 0.62f, 0.3f), at(a0, 0.0f, 0.3f), at(a1, 0.0f, 0.3f), at(a1, 0.62f, 0.3f), Paint::iron, 0.1f);
    }
    for (float x : {-0.84f, 0.84f}) b.box({x - 0.07f, 0.9f, -0.07f}, {x + 0.07f, 2.6f, 0.07f}, Paint::darkWood, 0.5f);
    b.box({-1.1f, 2.54f, -0.06f}, {1.1f, 2.66f, 0.06f}, Paint::darkWood, 0.4f);
    b.box({-0.9f, 1.42f, -0.09f}, {0.9f, 1.58f, 0.09f}, Paint::wood, 0.45f);
    b.box({-0.16f, 0.98f, -0.14f}, {0.16f, 1.22f, 0.14f}, Paint::darkWood, 0.55f, -0.03f);
    for (int i = 0; i < rows; ++i)
        for (float side : {1.0f, -1.0f}) {
            const auto p = [&](float x, float t, float lift) {
                return vec3(x * side, 2.72f - 0.72f * t + lift, 0.86f * t * side);
            };
            const float t0 = float(i) / float(rows), t1 = float(i + 1) / float(rows);
            b.quad(p(-1.15f, t1, 0.03f), p(1.15f, t1, 0.03f), p(1.15f, t0, 0), p(-1.15f, t0, 0), Paint::clay,
                   0.4f + 0.3f * random01(83, uint32_t(i), side > 0));
            b.quad(p(1.15f, t1, -0.02f), p(-1.15f, t1, -0.02f), p(-1.15f, t0, -0.04f), p(1.15f, t0, -0.04f),
                   Paint::darkWood, 0.35f);
        }
    return b.mesh;
}

// A slab on two stones.
Mesh bench(int) {
    Builder b;
    for (float x : {-0.62f, 0.62f})
        b.box({x - 0.14f, -0.1f, -0.17f}, {x + 0.14f, 0.38f, 0.17f}, Paint::stone, 0.42f, 0.012f);
    b.box({-0.95f, 0.38f, -0.24f}, {0.95f, 0.48f, 0.24f}, Paint::stone, 0.62f, 0.012f);
    return b.mesh;
}

}  // namespace

Picture paintPalette() {
    constexpr int kRow = 8;
    const vec3 ends[][2] = {
        {{0.085f, 0.075f, 0.058f}, {0.46f, 0.42f, 0.345f}},  {{0.05f, 0.042f, 0.032f}, {0.30f, 0.27f, 0.22f}},
        {{0.050f, 0.038f, 0.026f}, {0.34f, 0.275f, 0.195f}}, {{0.020f, 0.014f, 0.009f}, {0.115f, 0.080f, 0.050f}},
        {{0.25f, 0.24f, 0.22f}, {0.80f, 0.78f, 0.72f}},      {{0.010f, 0.011f, 0.012f}, {0.12f, 0.12f, 0.125f}},
        {{0.070f, 0.026f, 0.014f}, {0.34f, 0.135f, 0.075f}}, {{0.150f, 0.105f, 0.040f}, {0.58f, 0.45f, 0.21f}}};
    static_assert(std::size(ends) == size_t(Paint::count));
    Picture picture(64, kRow * int(Paint::count));
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < 64; ++x) {
            const auto& row = ends[y / kRow];
            const float bright = float(x) / 63;
            const vec3 color = glm::mix(row[0], row[1], bright);
            for (int k = 0; k < 3; ++k) picture.at(x, y)[k] = toByte(srgbOfLinear(color[k]));
            picture.at(x, y)[3] = 255;
        }
    return picture;
}

void addFurniture(PropMeshes& out) {
    const struct {
        const char* name;
        Mesh (*make)(int lod);
        int lods;
    } rows[] = {{"wall", wall, 2}, {"pier", pier, 2}, {"fence", fence, 2}, {"rails", rails, 2},
                {"post", post, 1}, {"well", well, 1}, {"bench", bench, 1}};
    for (const auto& row : rows)
        for (int lod = 0; lod < row.lods; ++lod) out.add(row.name, lod, row.make(lod), PropMeshes::kBuilt);
}

PropMeshes makePropMeshes() {
    PropMeshes out;
    addTrees(out);
    addSmallPlants(out);
    addFurniture(out);
    addYard(out);
    addFallenStones(out);
    return out;
}

}  // namespace espalier::content
