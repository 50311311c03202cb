// Hedges, flowers and tall grass as cards, tufts as blades; fewer and larger ones a level.

#include <cmath>

#include "tools/content/card.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

// A hedge, clipped: twigs lie on a box of 2 m by 1.25 m by 0.8 m. Between its sides others stand in the dark, across
// and along, so that one doesn't see through it.
Mesh makeHedge(int lod) {
    Mesh mesh;
    const int along = lod == 0 ? 7 : lod == 1 ? 4 : 2, rows = lod == 0 ? 4 : lod == 1 ? 2 : 1;
    const float side = 2.9f / float(along), high = 1.2f, half = 0.34f;
    uint32_t i = 0;
    const auto card = [&](glm::vec3 at, glm::vec3 out, float size, float inside) {
        ++i;
        const auto random = [&](uint32_t which) { return random01(911u + uint32_t(lod), i, which); };
        const glm::vec3 turned = glm::normalize(out + 0.7f * (glm::vec3(random(0), random(1), random(2)) - 0.5f));
        const auto litAt = [&](glm::vec3 p) -> Lit {
            return {glm::normalize(5.0f * glm::normalize(p - at + out) + turned),
                    inside * glm::clamp(0.35f + 0.5f * p.y / high, 0.2f, 1.0f)};
        };
        addCard(mesh, at + 0.08f * (glm::vec3(random(4), random(5), random(6)) - 0.5f), turned,
                std::abs(out.y) > 0.5f ? glm::vec3(0.3f, 0, 1) : glm::vec3(0.2f * (random(7) - 0.5f), 1, 0), size,
                cellOf(lod, 3, random(3)), litAt);
    };
    const auto atRow = [&](int r) { return high * (float(r) + 0.5f) / float(rows); };
    for (int a = 0; a < along; ++a) {
        const float x = -1 + 2 * (float(a) + 0.5f) / float(along);
        for (int r = 0; r < rows; ++r) {
            card({x, atRow(r), half}, {0, 0, 1}, side, 1);
            card({x, atRow(r), -half}, {0, 0, -1}, side, 1);
            card({x, 0.94f * atRow(r), 0}, {0, 0, 1}, 1.35f * side, 0.4f);
        }
        card({x, high, 0.14f}, {0, 1, 0.2f}, side, 1);
        card({x, high, -0.14f}, {0, 1, -0.2f}, side, 1);
    }
    const int across = lod == 0 ? 4 : 2;
    for (int a = 0; a <= across; ++a) {
        const bool end = a == 0 || a == across;
        const float x = -1 + 2 * float(a) / float(across);
        for (int r = 0; r < rows; ++r)
            for (float z : {-0.2f, 0.2f})
                card({x, 0.96f * atRow(r), z}, {x < 0 ? -1 : 1, 0, 0}, std::max(1.1f * side, 0.4f), end ? 1 : 0.4f);
    }
    return mesh;
}

// A clump that stands upright on cards.
Mesh makeFlowers(int kind, int lod) {
    Mesh mesh;
    const int count = lod == 0 ? 6 : lod == 1 ? 3 : 1;
    const float side = lod == 0 ? 0.34f : lod == 1 ? 0.40f : 0.5f;
    const Cell cell{{1 - kFlowerSide, kFlowerSide * float(kind)}, kFlowerSide};
    for (int i = 0; i < count; ++i) {
        const float angle = 2.399963f * float(i), r = lod < 2 ? 0.16f * std::sqrt(float(i) / float(count)) : 0;
        const glm::vec3 at(r * std::cos(angle), 0.47f * side, r * std::sin(angle));
        const glm::vec3 out = glm::normalize(glm::vec3(std::cos(2 * angle), 0.25f, std::sin(2 * angle)));
        const auto litAt = [&](glm::vec3 p) -> Lit {
            return {glm::normalize(glm::vec3(0, 1, 0) + 2.1f * (p - at) + 1.1f * out), 0.9f};
        };
        addCard(mesh, at, out, {0, 1, 0}, side, cell, litAt);
    }
    return mesh;
}

// Grass as tall as one's knees, on cards that lean apart, so that it is seen from above, too; lit as the ground is.
Mesh makeMeadow(int kind, int lod) {
    constexpr float kLean = 0.40f;  // radians
    Mesh mesh;
    const int count = 5 - lod;
    const float side = lod == 0 ? 0.74f : lod == 1 ? 0.82f : 0.95f;
    const Cell cell{{1 - kFlowerSide, kFlowerSide * float(kFlowers + kind)}, kFlowerSide};
    for (int i = 0; i < count; ++i) {
        const float angle = 2.399963f * float(i), r = lod < 2 ? 0.34f * std::sqrt(float(i) / float(count)) : 0.08f;
        const float turn = lod < 2 ? 1.9f * angle : 2.09f * float(i) + 0.4f;
        const glm::vec3 foot(r * std::cos(angle), 0, r * std::sin(angle)), level(std::cos(turn), 0, std::sin(turn));
        const float lean = glm::dot(level, foot) < 0 ? -kLean : kLean;
        const glm::vec3 up = glm::vec3(0, std::cos(lean), 0) + std::sin(lean) * level;
        const glm::vec3 out = std::cos(lean) * level - glm::vec3(0, std::sin(lean), 0);
        const glm::vec3 at = foot + 0.48f * side * up;
        const auto litAt = [&](glm::vec3 p) -> Lit {
            return {glm::normalize(5.0f * (p - at + glm::vec3(0, 1, 0)) + out), 0.8f};
        };
        addCard(mesh, at, out, up, side, cell, litAt);
    }
    return mesh;
}

// A patch of clover, on cards that lean outward all around.
Mesh makeClover(int lod) {
    constexpr float kLean = 1.08f;  // radians
    Mesh mesh;
    const int count = lod == 0 ? 5 : lod == 1 ? 3 : 2;
    const float side = lod == 0 ? 0.24f : lod == 1 ? 0.30f : 0.36f;
    const Cell cell{{1 - kFlowerSide, kFlowerSide * float(kCloverCell)}, kFlowerSide};
    for (int i = 0; i < count; ++i) {
        const float angle = 6.2832f * (float(i) + 0.3f * random01(37, uint32_t(i))) / float(count);
        const glm::vec3 level(std::cos(angle), 0, std::sin(angle));
        const glm::vec3 up = glm::vec3(0, std::cos(kLean), 0) + std::sin(kLean) * level;
        const glm::vec3 out = std::cos(kLean) * level - glm::vec3(0, std::sin(kLean), 0);
        const auto litAt = [&](glm::vec3 p) -> Lit { return {glm::normalize(glm::vec3(0, 1, 0) + 1.2f * p), 0.85f}; };
        addCard(mesh, 0.45f * side * up - glm::vec3(0, 0.015f, 0), -out, up, side, cell, litAt);
    }
    return mesh;
}

// Blades of grass. roots: within so many metres of the middle; spread: how far blades lean, metres; wide: their half
// width, metres. u is how far up the blade.
Mesh makeTuft(uint32_t salt, int blades, float tall, float roots, float spread, float wide, int lod) {
    Mesh mesh;
    const int steps = lod == 0 ? 2 : 1, count = lod == 0 ? blades : lod == 1 ? blades / 2 : blades / 4;
    for (int b = 0; b < count; ++b) {
        const auto random = [&](uint32_t which) { return random01(salt, uint32_t(b), which); };
        const float angle = 2.399963f * float(b) + random(0), high = tall * (0.55f + 0.45f * random(1));
        const glm::vec3 out(std::cos(angle), 0, std::sin(angle)), across(-out.z, 0, out.x);
        const glm::vec3 root = out * (roots * random(2));
        const float half = wide *
                           (lod == 0   ? 1.0f
                            : lod == 1 ? 1.7f
                                       : 3.3f) *
                           (0.8f + 0.6f * random(3)),
                    lean = spread * (0.35f + 0.9f * random(4));
        const uint32_t first = uint32_t(mesh.positions.size());
        for (int s = 0; s <= steps; ++s) {
            const float t = float(s) / float(steps);
            const glm::vec3 at = root + out * (lean * t * t) + glm::vec3(0, high * (t - 0.25f * t * t) - 0.02f, 0);
            for (float side : {-1.0f, 1.0f}) {
                if (s == steps && side > 0) continue;  // a tip
                mesh.positions.push_back(at + across * (s == steps ? 0.0f : side * half * (1 - 0.4f * t)));
                mesh.normals.push_back(glm::normalize(glm::vec3(0, 1, 0) + 0.45f * out));
                mesh.uvs.push_back({t, 0.5f});
            }
        }
        for (int s = 0; s < steps; ++s) {
            const uint32_t a = first + 2 * uint32_t(s);
            for (uint32_t k : {a, a + 1, a + 2}) mesh.indices.push_back(k);
            if (s + 1 < steps)
                for (uint32_t k : {a + 1, a + 3, a + 2}) mesh.indices.push_back(k);
        }
    }
    return mesh;
}

}  // namespace

void addSmallPlants(PropMeshes& out) {
    for (int lod = 0; lod < kPlantLods; ++lod) out.add("hedge", lod, makeHedge(lod), PropMeshes::kFoliage);
    for (int lod = 0; lod < kPlantLods; ++lod) {
        for (int kind = 0; kind < kFlowers; ++kind)
            out.add("flowers_" + std::string(1, char('a' + kind)), lod, makeFlowers(kind, lod), PropMeshes::kFoliage);
        for (int kind = 0; kind < kMeadows; ++kind)
            out.add("meadow_" + std::string(1, char('a' + kind)), lod, makeMeadow(kind, lod), PropMeshes::kMeadow);
        out.add("clover", lod, makeClover(lod), PropMeshes::kMeadow);
        out.add("tuft_a", lod, makeTuft(31, 18, 0.20f, 0.045f, 0.13f, 0.0042f, lod), PropMeshes::kGrass);
        out.add("tuft_b", lod, makeTuft(32, 26, 0.32f, 0.07f, 0.20f, 0.0042f, lod), PropMeshes::kGrass);
        out.add("tuft_c", lod, makeTuft(33, 14, 0.12f, 0.042f, 0.12f, 0.0042f, lod), PropMeshes::kGrass);
        out.add("turf", lod, makeTuft(34, 48, 0.11f, 0.32f, 0.08f, 0.009f, lod), PropMeshes::kGrass);
    }
}

}  // namespace espalier::content
