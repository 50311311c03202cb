// What people leave standing in yards and gardens: a woodpile, a barrel, a tub, a seat, a trough, a hand cart, hives,
// washing, a bed's boards, stepping stones. In: nothing. Out: meshes whose texture coordinates pick colours of the
// palette; what leans on a wall has it behind, at negative z.

#include <cmath>

#include "tools/content/builder.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

using glm::vec3;
const vec3 kUp(0, 1, 0);

// Split logs in courses between two posts, under boards; what lies behind their ends is in the dark. From afar only
// the ends are there, close before the dark.
Mesh woodpile(int lod) {
    Builder b;
    constexpr float kHalfLong = 0.98f, kFront = 0.24f, kLog = 0.195f, kRow = 0.18f;
    constexpr int kRows = 5;
    const float dark = kFront - (lod == 0 ? 0.09f : 0.05f);
    const float free = kHalfLong - 0.045f;  // between the posts
    b.box({-kHalfLong, -0.05f, -0.22f}, {kHalfLong, kRow * kRows, dark}, Paint::darkWood, 0.35f);
    for (float x : {-kHalfLong, kHalfLong})
        b.box({x - 0.045f, -0.1f, kFront - 0.13f}, {x + 0.045f, 1.02f, kFront - 0.04f}, Paint::wood, 0.28f);
    for (int row = 0; row < kRows; ++row) {
        float x = -free - (row % 2 ? 0.3f * kLog : 0);
        for (uint32_t i = 0; x < free - 0.55f * kLog; ++i) {
            const auto random = [&](uint32_t which) { return random01(uint32_t(row) * 64 + i, which, 101); };
            const float wide = kLog * (0.80f + 0.45f * random(0));
            const float bright = 0.50f + 0.42f * random(2), turn = 2 * kPi * random(3);
            const float r = 0.60f * std::min(wide, kRow), middle = glm::clamp(x + 0.5f * wide, r - free, free - r);
            const vec3 at(middle, kRow * (float(row) + 0.5f), kFront - 0.05f * random(1));
            const vec3 side(std::cos(turn), std::sin(turn), 0), up(-side.y, side.x, 0);
            if (lod == 0) {
                const Builder::Axis axis{{at.x, at.y, 0}, {0, 0, 1}, side};
                b.turn(axis, {{r, kFront - 0.1f}, {r, at.z}}, 4, Paint::darkWood, 0.75f, 0.4f);
                b.turn(axis, {{r, at.z}, {0, at.z}}, 4, Paint::wood, bright);
            } else {
                const vec3 end(at.x, at.y, dark + 0.015f);
                b.quad(end + r * side, end + r * up, end - r * side, end - r * up, Paint::wood, bright);
            }
            x += wide;
        }
    }
    for (int i = 0; i < 3; ++i) {
        const float z = -0.26f + 0.20f * float(i), y = 0.99f - 0.035f * float(i);
        b.box({-1.1f, y, z}, {1.1f, y + 0.035f, z + 0.22f}, Paint::wood, 0.30f + 0.12f * random01(102, uint32_t(i)));
    }
    return b.mesh;
}

// Staves held by hoops, `high` metres, filled almost to the brim; from afar to the brim.
void addBarrel(Builder& b, float high, float radius, int sides, Paint content, int lod) {
    const auto at = [&](float t, float over) {
        return Builder::Ring{radius * (0.84f + 0.62f * t * (1 - t)) + over, high * t};
    };
    const Builder::Ring rim = at(1, 0);
    if (lod == 0) {
        b.turn({}, {at(0, 0), at(0.3f, 0), at(0.7f, 0), rim}, sides, Paint::wood, 0.40f, 0.35f);
        const float inside = rim.radius - 0.03f, filled = high - 0.06f;
        b.turn({}, {rim, {inside, high + 0.001f}, {inside, filled}}, sides, Paint::wood, 0.32f);
        b.turn({}, {{inside, filled}, {0, filled + 0.001f}}, sides, content, 0.12f);
    } else {
        sides /= 2;
        b.turn({}, {at(0, 0), at(0.5f, 0), rim}, sides, Paint::wood, 0.40f, 0.35f);
        b.turn({}, {rim, {0, high}}, sides, content, 0.14f);
    }
    for (float t : {0.12f, 0.86f})
        b.turn({}, {at(t - 0.03f, 0.007f), at(t + 0.03f, 0.007f)}, sides, Paint::iron, 0.45f);
}
Mesh barrel(int lod) {
    Builder b;
    addBarrel(b, 0.88f, 0.33f, 12, Paint::iron, lod);
    return b.mesh;
}
// Half a barrel full of earth, for flowers.
Mesh tub(int lod) {
    Builder b;
    addBarrel(b, 0.36f, 0.27f, 10, Paint::mortar, lod);
    return b.mesh;
}

// A seat with a back, of boards.
Mesh seat(int) {
    Builder b;
    for (float x : {-0.68f, 0.68f}) {
        b.box({x - 0.035f, -0.05f, 0.12f}, {x + 0.035f, 0.43f, 0.19f}, Paint::wood, 0.36f);
        b.box({x - 0.035f, -0.05f, -0.22f}, {x + 0.035f, 0.86f, -0.16f}, Paint::wood, 0.36f);
        b.box({x - 0.03f, 0.37f, -0.16f}, {x + 0.03f, 0.43f, 0.12f}, Paint::wood, 0.34f);
    }
    for (int i = 0; i < 3; ++i) {
        const float z = -0.15f + 0.125f * float(i);
        b.box({-0.82f, 0.43f, z}, {0.82f, 0.465f, z + 0.112f}, Paint::wood, 0.50f + 0.12f * random01(111, uint32_t(i)));
    }
    for (int i = 0; i < 2; ++i) {
        const float y = 0.56f + 0.16f * float(i);
        b.box({-0.82f, y, -0.16f}, {0.82f, y + 0.12f, -0.13f}, Paint::wood, 0.46f + 0.14f * random01(112, uint32_t(i)));
    }
    return b.mesh;
}

// A stone trough, full.
Mesh trough(int) {
    Builder b;
    constexpr float kLong = 0.95f, kWide = 0.36f, kHigh = 0.52f, kThick = 0.10f;
    b.box({-kLong, -0.1f, -kWide}, {kLong, 0.40f, kWide}, Paint::stone, 0.46f, 0.01f);
    for (float side : {-1.0f, 1.0f}) {
        const float z = side * (kWide - 0.5f * kThick), x = side * (kLong - 0.5f * kThick);
        b.box({-kLong, 0.40f, z - 0.5f * kThick}, {kLong, kHigh, z + 0.5f * kThick}, Paint::stone, 0.55f, 0.008f);
        b.box({x - 0.5f * kThick, 0.40f, kThick - kWide}, {x + 0.5f * kThick, kHigh, kWide - kThick}, Paint::stone,
              0.52f, 0.004f);
    }
    b.quad({kThick - kLong, 0.455f, kWide - kThick}, {kLong - kThick, 0.455f, kWide - kThick},
           {kLong - kThick, 0.455f, kThick - kWide}, {kThick - kLong, 0.455f, kThick - kWide}, Paint::iron, 0.55f);
    return b.mesh;
}

// From afar a flat ring with two spokes across.
void addWheel(Builder& b, vec3 at, int lod) {
    constexpr float kRadius = 0.44f, kRim = 0.055f, kThick = 0.05f;
    if (lod > 0) {
        b.turn({at, {1, 0, 0}, kUp}, {{kRadius, 0}, {kRadius - 1.5f * kRim, 0.001f}}, 10, Paint::darkWood, 0.25f);
        for (const vec3 out : {vec3(0, 0.7f, 0.7f), vec3(0, 0.7f, -0.7f)}) {
            const vec3 end = kRadius * out, wide = 0.025f * vec3(0, -out.z, out.y);
            b.quad(at - end - wide, at + end - wide, at + end + wide, at - end + wide, Paint::wood, 0.15f);
        }
        return;
    }
    const Builder::Axis axis{at - vec3(0.5f * kThick, 0, 0), {1, 0, 0}, kUp};
    b.turn(axis, {{kRadius - kRim, 0}, {kRadius, 0}, {kRadius, kThick}, {kRadius - kRim, kThick}, {kRadius - kRim, 0}},
           12, Paint::darkWood, 0.80f);
    b.turn(axis, {{0, -0.05f}, {0.075f, -0.05f}, {0.075f, 0.10f}, {0, 0.10f}}, 6, Paint::darkWood, 0.9f);
    for (int i = 0; i < 8; ++i) {
        const float a = 2 * kPi * (float(i) + 0.5f) / 8;
        const vec3 out(0, std::cos(a), std::sin(a));
        b.pole(at + 0.05f * out, at + (kRadius - 0.5f * kRim) * out, 0.018f, 3, Paint::wood, 0.45f);
    }
}

// Two wheels, a bed of boards with rails, shafts that rest on the ground; hay in it.
Mesh cart(int lod) {
    Builder b;
    for (float side : {-1.0f, 1.0f}) {
        addWheel(b, {0.60f * side, 0.40f, -0.05f}, lod);
        const float x = 0.44f * side;
        b.pole({x, 0.50f, 0.75f}, {0.30f * side, -0.02f, 1.75f}, 0.032f, lod == 0 ? 4 : 3, Paint::wood, 0.42f);
        b.box({x - 0.02f, 0.78f, -0.85f}, {x + 0.02f, 0.86f, 0.80f}, Paint::wood, 0.44f);
        if (lod > 0) continue;
        b.pole({x, 0.50f, -0.85f}, {x, 0.50f, 0.80f}, 0.04f, 4, Paint::wood, 0.38f);
        for (float z : {-0.80f, -0.28f, 0.24f, 0.74f})
            b.box({x - 0.022f, 0.5f, z - 0.022f}, {x + 0.022f, 0.90f, z + 0.022f}, Paint::wood, 0.38f);
    }
    if (lod == 0) b.pole({-0.62f, 0.40f, -0.05f}, {0.62f, 0.40f, -0.05f}, 0.035f, 4, Paint::iron, 0.4f);
    b.box({-0.46f, 0.54f, -0.86f}, {0.46f, 0.575f, 0.82f}, Paint::wood, 0.40f);
    b.box({-0.42f, 0.575f, -0.82f}, {0.42f, 0.84f, 0.76f}, Paint::straw, 0.45f, -0.03f);
    b.box({-0.40f, 0.84f, -0.72f}, {0.40f, 1.06f, 0.66f}, Paint::straw, 0.60f, 0.20f);
    return b.mesh;
}

// Coils of straw, one on the other, on a board with legs; from afar smooth.
Mesh hives(int lod) {
    Builder b;
    for (float x : {-0.72f, 0.72f})
        for (float z : {-0.16f, 0.16f})
            b.box({x - 0.03f, -0.1f, z - 0.03f}, {x + 0.03f, 0.5f, z + 0.03f}, Paint::wood, 0.34f);
    b.box({-0.88f, 0.48f, -0.25f}, {0.88f, 0.53f, 0.25f}, Paint::wood, 0.45f);
    const int coils = lod == 0 ? 4 : 2, sides = lod == 0 ? 8 : 6;
    for (float x : {-0.56f, 0.0f, 0.56f}) {
        const auto radius = [&](float t) { return 0.225f * std::sqrt(std::max(1 - t * t, 0.0f)); };
        for (int c = 0; c < coils; ++c) {
            const float low = float(c) / float(coils), high = float(c + 1) / float(coils);
            const float r0 = radius(low), r1 = c + 1 == coils ? 0.0f : radius(high);
            const Builder::Ring foot{r0, 0.53f + 0.42f * low}, head{r1, 0.53f + 0.42f * high};
            const Builder::Ring belly{0.5f * (r0 + r1) + 0.016f, 0.5f * (foot.height + head.height)};
            const std::vector<Builder::Ring> rings =
                lod == 0 ? std::vector{foot, belly, head} : std::vector{foot, head};
            b.turn({{x, 0, 0}, kUp, {1, 0, 0}}, rings, sides, Paint::straw, 0.42f + 0.16f * random01(121, uint32_t(c)),
                   0.15f);
        }
        if (lod == 0) b.box({x - 0.05f, 0.53f, 0.20f}, {x + 0.05f, 0.575f, 0.235f}, Paint::darkWood, 0.05f);
    }
    return b.mesh;
}

// A cloth that hangs down from its upper corners, bellied by the wind, seen from both sides.
void addCloth(Builder& b, vec3 left, vec3 right, float length, float bright, uint32_t salt) {
    const auto at = [&](int column, int row) {
        const float t = float(row) / 2, wave = std::sin(2.5f * float(column) + 6 * random01(salt, 132)) * 0.03f * t;
        return glm::mix(left, right, float(column) / 2) + vec3(0, -length * t, 0.10f * t * t + wave);
    };
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 2; ++column) {
            const vec3 p = at(column, row + 1), q = at(column + 1, row + 1), r = at(column + 1, row),
                       s = at(column, row);
            b.quad(p, q, r, s, Paint::white, bright);
            b.quad(q, p, s, r, Paint::white, bright * 0.94f);
        }
}
// Lines between two posts, washing on one.
Mesh washing(int) {
    Builder b;
    constexpr float kHigh = 1.86f, kArm = 0.22f;
    for (float x : {-1.9f, 1.9f}) {
        b.box({x - 0.04f, -0.2f, -0.04f}, {x + 0.04f, kHigh + 0.08f, 0.04f}, Paint::wood, 0.36f);
        b.box({x - 0.03f, kHigh - 0.06f, -kArm - 0.05f}, {x + 0.03f, kHigh, kArm + 0.05f}, Paint::wood, 0.36f);
    }
    for (float z : {-kArm, kArm}) b.pole({-1.9f, kHigh, z}, {1.9f, kHigh, z}, 0.006f, 3, Paint::mortar, 0.8f);
    const struct {
        float left, right, length;
    } cloths[] = {{-1.65f, -0.95f, 1.15f}, {-0.80f, -0.35f, 0.62f}, {-0.20f, 0.70f, 1.20f}, {0.90f, 1.30f, 0.75f}};
    for (uint32_t i = 0; i < 4; ++i)
        addCloth(b, {cloths[i].left, kHigh, kArm}, {cloths[i].right, kHigh, kArm}, cloths[i].length,
                 0.72f + 0.25f * random01(131, i), i);
    return b.mesh;
}

// Boards about a bed of dug earth, 2.6 m by 1.3 m.
Mesh boards(int) {
    Builder b;
    constexpr float kLong = 1.3f, kWide = 0.65f, kHigh = 0.17f;
    for (float side : {-1.0f, 1.0f}) {
        b.box({-kLong, -0.08f, side * kWide - 0.025f}, {kLong, kHigh, side * kWide + 0.025f}, Paint::wood, 0.40f);
        b.box({side * kLong - 0.025f, -0.08f, -kWide}, {side * kLong + 0.025f, kHigh - 0.01f, kWide}, Paint::wood,
              0.36f);
    }
    b.box({-kLong, 0, -kWide}, {kLong, 0.09f, kWide}, Paint::mortar, 0.05f);
    for (int i = 0; i < 3; ++i) {  // ridges
        const float z = (float(i) - 1) * 0.42f;
        b.box({0.03f - kLong, 0.08f, z - 0.19f}, {kLong - 0.03f, 0.13f, z + 0.19f}, Paint::mortar, 0.07f, 0.08f);
    }
    return b.mesh;
}

// A stone to step on, almost level with the grass.
Mesh step(int) {
    Builder b;
    constexpr int kSides = 7;
    vec3 rim[kSides];
    for (int i = 0; i < kSides; ++i) {
        const float a = -2 * kPi * (float(i) + 0.5f * random01(141, uint32_t(i))) / kSides;
        const float r = 0.23f + 0.07f * random01(142, uint32_t(i));
        rim[i] = {1.15f * r * std::cos(a), 0.03f, r * std::sin(a)};
    }
    for (int i = 0; i < kSides; ++i) {
        const vec3 p = rim[i], q = rim[(i + 1) % kSides], down(0, -0.08f, 0);
        b.quad(p + down, q + down, q, p, Paint::stone, 0.42f);
        const uint32_t first = uint32_t(b.mesh.positions.size());
        for (vec3 corner : {vec3(0, 0.032f, 0), p, q}) {
            b.mesh.positions.push_back(corner);
            b.mesh.normals.push_back(kUp);
            b.mesh.uvs.push_back(paletteUv(Paint::stone, 0.85f));
        }
        for (uint32_t k : {0u, 1u, 2u}) b.mesh.indices.push_back(first + k);
    }
    return b.mesh;
}

}  // namespace

// What stands often, or is of many triangles, has a far level.
void addYard(PropMeshes& out) {
    const struct {
        const char* name;
        Mesh (*make)(int lod);
        int lods;
    } rows[] = {{"woodpile", woodpile, 2}, {"barrel", barrel, 2}, {"tub", tub, 2},     {"seat", seat, 1},
                {"trough", trough, 1},     {"cart", cart, 2},     {"hives", hives, 2}, {"washing", washing, 1},
                {"boards", boards, 1},     {"step", step, 1}};
    for (const auto& row : rows)
        for (int lod = 0; lod < row.lods; ++lod) out.add(row.name, lod, row.make(lod), PropMeshes::kBuilt);
}

}  // namespace espalier::content
