// Ivy leaves drawn from control points: lobes with slightly convex sides, rounded sinuses, a notch at the stalk.
// In: a variant. Out: its outline, veins and place in the atlas.

#include "tools/content/leaf_shape.hpp"

#include <algorithm>
#include <cmath>

#include "tools/content/leaf.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

// A lobe's side or a sinus: a quadratic curve from the last point over `control` to `end`.
struct Stroke {
    glm::vec2 control, end;
};

// The right half from the notch to the tip, blade coordinates: notch at (0, 0), tip at (0, 1).
std::vector<Stroke> halfOutline(int variant) {
    switch (variant) {
        case 0:  // five lobes, the common form
            return {{{0.06f, -0.13f}, {0.20f, -0.185f}}, {{0.34f, -0.22f}, {0.50f, -0.155f}},
                    {{0.45f, -0.02f}, {0.385f, 0.075f}}, {{0.36f, 0.13f}, {0.42f, 0.175f}},
                    {{0.58f, 0.25f}, {0.70f, 0.385f}},   {{0.52f, 0.40f}, {0.36f, 0.39f}},
                    {{0.255f, 0.40f}, {0.245f, 0.50f}},  {{0.24f, 0.70f}, {0.0f, 1.0f}}};
        case 1:  // three broad lobes
            return {{{0.05f, -0.10f}, {0.18f, -0.135f}}, {{0.36f, -0.16f}, {0.50f, -0.03f}},
                    {{0.60f, 0.08f}, {0.68f, 0.26f}},    {{0.53f, 0.30f}, {0.39f, 0.335f}},
                    {{0.30f, 0.36f}, {0.30f, 0.45f}},    {{0.29f, 0.68f}, {0.0f, 1.0f}}};
        case kFirstOval:  // an egg with a drawn-out tip
            return {
                {{0.10f, -0.06f}, {0.26f, 0.00f}}, {{0.52f, 0.12f}, {0.47f, 0.40f}}, {{0.42f, 0.74f}, {0.0f, 1.0f}}};
        case kFirstOval + 1:  // a lance
            return {
                {{0.06f, -0.02f}, {0.18f, 0.06f}}, {{0.37f, 0.20f}, {0.33f, 0.45f}}, {{0.27f, 0.76f}, {0.0f, 1.0f}}};
        default:  // five narrow lobes, a long middle one
            return {{{0.04f, -0.12f}, {0.15f, -0.20f}},  {{0.26f, -0.28f}, {0.43f, -0.26f}},
                    {{0.36f, -0.11f}, {0.30f, -0.015f}}, {{0.27f, 0.045f}, {0.33f, 0.09f}},
                    {{0.46f, 0.17f}, {0.585f, 0.30f}},   {{0.43f, 0.295f}, {0.275f, 0.285f}},
                    {{0.185f, 0.295f}, {0.185f, 0.41f}}, {{0.20f, 0.66f}, {0.0f, 1.0f}}};
    }
}

// Tips that the main veins run to, right half and middle.
std::vector<glm::vec2> lobeTips(int variant) {
    if (variant == 0) return {{0, 1}, {0.70f, 0.385f}, {0.50f, -0.155f}};
    if (variant >= kFirstOval) return {{0, 1}};
    if (variant == 1) return {{0, 1}, {0.68f, 0.26f}, {0.44f, -0.06f}};
    return {{0, 1}, {0.585f, 0.30f}, {0.43f, -0.26f}};
}

// A living leaf's halves differ a little.
glm::vec2 liven(glm::vec2 p, int variant) {
    uint32_t salt = 900u + static_cast<uint32_t>(variant) * 7u;
    glm::vec2 d(0.030f * noise(p * 2.1f, salt), 0.035f * noise(p * 2.1f + 9.0f, salt + 1));
    return p + d * saturate(glm::length(p) * 2.0f) * saturate((1.0f - p.y) * 4.0f);
}

float polylineDistance(const std::vector<glm::vec2>& line, glm::vec2 p, bool closed) {
    float best = 1e9f;
    for (size_t i = 0; i + (closed ? 0 : 1) < line.size(); ++i) {
        glm::vec2 a = line[i], d = line[(i + 1) % line.size()] - a;
        float t = saturate(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-12f));
        best = std::min(best, glm::distance(p, a + d * t));
    }
    return best;
}

// Five petals around a middle, a vein along each.
LeafShape blossomShape() {
    constexpr int kPetals = 5, kPoints = 80;
    LeafShape shape;
    shape.base = 0.30f;
    const float radius = 0.5f * (1 - shape.base);
    const glm::vec2 middle(0, shape.base + radius);
    const auto at = [&](float turn, float share) {
        const float petal = std::pow(std::abs(std::cos(0.5f * kPetals * turn)), 0.55f);
        return middle + radius * share * (0.46f + 0.54f * petal) * glm::vec2(std::sin(turn), std::cos(turn));
    };
    // Counter-clockwise from the stalk.
    for (int i = 0; i < kPoints; ++i)
        shape.outline.push_back(at(kPi - 2 * kPi * (static_cast<float>(i) + 0.5f) / kPoints, 1));
    for (int i = 0; i < kPetals; ++i) {
        const float turn = 2 * kPi * static_cast<float>(i) / kPetals;
        shape.veins.push_back({at(turn, 0.15f), at(turn, 0.55f), at(turn, 0.92f)});
    }
    return shape;
}

// Blades side by side, one outline from the right to the left.
LeafShape tuftShape() {
    constexpr int kBlades = 7;
    LeafShape shape;
    shape.base = 0.02f;
    shape.outline.push_back({0.30f, 0.0f});
    for (int i = 0; i < kBlades; ++i) {
        const uint32_t blade = static_cast<uint32_t>(i);
        const float x = 0.20f - 0.40f * static_cast<float>(i) / (kBlades - 1),
                    lean = 2.1f + 0.5f * random01(blade, 982);
        const float high = (0.60f + 0.40f * random01(blade, 981)) * (1 - 5.0f * x * x);
        const glm::vec2 foot(x, 0), tip(x * lean + 0.10f * (random01(blade, 983) - 0.5f), high);
        const glm::vec2 bow(0.35f * (tip.x - x), -0.06f * std::abs(tip.x));
        for (float t : {0.35f, 0.7f, 1.0f}) {
            const float half = 0.034f * (1 - t * t) + 0.004f;
            shape.outline.push_back(glm::mix(foot, tip, t) - bow * (t * (1 - t)) + glm::vec2(half, 0));
        }
        for (float t : {1.0f, 0.7f, 0.35f}) {
            const float half = 0.034f * (1 - t * t) + 0.004f;
            shape.outline.push_back(glm::mix(foot, tip, t) - bow * (t * (1 - t)) - glm::vec2(half, 0));
        }
        if (i + 1 < kBlades) shape.outline.push_back({x - 0.20f / (kBlades - 1), 0.05f});
    }
    shape.outline.push_back({-0.30f, 0.0f});
    return shape;
}

}  // namespace

LeafShape leafShape(int variant) {
    if (variant == kBlossom) return blossomShape();
    if (variant == kTuft) return tuftShape();
    LeafShape shape;
    float blade = 1 - shape.base;
    auto place = [&](glm::vec2 p) { return liven(p, variant) * blade + glm::vec2(0, shape.base); };
    std::vector<glm::vec2> half{{0, 0}};
    for (const Stroke& s : halfOutline(variant)) {
        glm::vec2 from = half.back();
        for (int k = 1; k <= 10; ++k) {
            float t = static_cast<float>(k) / 10;
            half.push_back(from * (1 - t) * (1 - t) + s.control * 2.0f * t * (1 - t) + s.end * t * t);
        }
    }
    for (glm::vec2 p : half) shape.outline.push_back(place(p));
    for (size_t i = half.size() - 1; i-- > 1;) shape.outline.push_back(place({-half[i].x, half[i].y}));
    for (glm::vec2 tip : lobeTips(variant))
        for (float side : {1.0f, -1.0f}) {
            if (tip.x == 0 && side < 0) continue;
            std::vector<glm::vec2> vein;
            glm::vec2 bow = tip.y > 0.1f ? glm::vec2(0.05f * side, 0.05f) * tip.x : glm::vec2(0, -0.02f);
            for (int k = 0; k <= 12; ++k) {
                float t = static_cast<float>(k) / 12;
                vein.push_back(glm::vec2(tip.x * side, tip.y) * t * 0.97f + bow * (4 * t * (1 - t)));
            }
            glm::vec2 along = glm::normalize(glm::vec2(tip.x * side, tip.y));
            for (int k = 3; k <= 10; k += 2) {
                glm::vec2 from = vein[static_cast<size_t>(k)];
                float reach = 0.26f * (1 - static_cast<float>(k) / 13.5f);
                for (float turn : {1.0f, -1.0f}) {
                    glm::vec2 across(-along.y * turn, along.x * turn);
                    std::vector<glm::vec2> rib;
                    for (int j = 0; j <= 4; ++j) {
                        float t = static_cast<float>(j) / 4 * reach;
                        rib.push_back(place(from + along * (t * 0.75f + t * t) + across * t * 0.8f));
                    }
                    shape.ribs.push_back(std::move(rib));
                }
            }
            for (glm::vec2& p : vein) p = place(p);
            shape.veins.push_back(std::move(vein));
        }
    for (glm::vec2 p : shape.outline) shape.halfWidth = std::max(shape.halfWidth, std::abs(p.x) + 0.02f);
    return shape;
}

float leafDistance(const LeafShape& shape, glm::vec2 p) {
    bool inside = false;
    for (size_t i = 0, j = shape.outline.size() - 1; i < shape.outline.size(); j = i++) {
        glm::vec2 a = shape.outline[i], b = shape.outline[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
    }
    float blade = polylineDistance(shape.outline, p, true) * (inside ? 1.0f : -1.0f);
    float along = std::max(-p.y, p.y - shape.base - 0.03f);
    float stalk = kStalkHalfWidth * (1.25f - 0.35f * saturate(p.y / shape.base)) -
                  std::max(std::abs(p.x), along + kStalkHalfWidth);
    return std::max(blade, stalk);
}

namespace {
constexpr float kMargin = 0.008f;                // of the atlas, round each leaf
constexpr float kSpanX = 1.12f, kSpanY = 1.06f;  // flat leaf units that a cell shows
}  // namespace

namespace {
// The column of a form in its atlas: low corner and size.
struct AtlasCell {
    glm::vec2 low, size;
};
AtlasCell cellOf(int form) {
    const int column = form < kFirstOval ? form : form - kFirstOval,
              columns = form < kFirstOval ? kLeafVariants : kFloraForms;
    const glm::vec2 size(1.0f / static_cast<float>(columns), 0.5f);
    return {{static_cast<float>(column) * size.x + kMargin, kMargin}, size - 2 * kMargin};
}
}  // namespace

glm::vec2 leafUv(int variant, glm::vec2 p) {
    const AtlasCell cell = cellOf(variant);
    return cell.low + glm::vec2(p.x / kSpanX + 0.5f, 1 - p.y / kSpanY) * cell.size;
}

glm::vec2 leafPoint(int variant, glm::vec2 uv) {
    const AtlasCell cell = cellOf(variant);
    const glm::vec2 unit = (uv - cell.low) / cell.size;
    return {(unit.x - 0.5f) * kSpanX, (1 - unit.y) * kSpanY};
}

}  // namespace espalier::content
