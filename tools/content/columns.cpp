// What stands freely on the ground: columns, a statue and fallen stones, as profiles swept round an axis whose section
// passes between square and circle. In: profiles. Out: charts and footprints.

#include <algorithm>
#include <cmath>

#include "tools/content/masonry.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/ruin.hpp"

namespace espalier::content {
namespace {

constexpr float kPi = 3.14159265f;

// A ring of the profile. square: 1 a square of half width r, 0 a circle of radius r.
struct Ring {
    float y, r, square;
};

struct Pillar {
    std::string name;
    glm::vec2 foot;                        // (x, z)
    float turn = 0;                        // radians about the axis
    std::vector<std::vector<Ring>> bands;  // a chart each, from the ground up; consecutive ones share a ring
    float topTilt = 0;                     // slope of the broken top
    float topBulge = 0;                    // relief of the top
    std::vector<float> joints;             // heights of joints between drums
    std::vector<float> edges;              // heights of worn edges
    uint32_t pieces = 48;                  // round the axis, a multiple of 8
    uint32_t salt = 1;
    bool spiralMask = false;
    float ringDistance = 0.055f;                         // metres along the profile, at most
    glm::vec2 (*carve)(glm::vec2 q, float y) = nullptr;  // from the profile's section to the sculpture's
    float roughness = 0.8f;
};

glm::vec2 squareAt(float u) {
    float w = u * 8;
    if (w < 1) return {w, 1};
    if (w < 3) return {1, 2 - w};
    if (w < 5) return {4 - w, -1};
    if (w < 7) return {-1, w - 6};
    return {w - 8, 1};
}

float topOf(const Pillar& p) {
    return p.bands.back().back().y;
}

// How far a broken top rises at q, relative to the axis.
float breakAt(const Pillar& p, glm::vec2 q) {
    return p.topTilt * (q.x * 0.8f + q.y * 0.6f) + 0.032f * p.topBulge * fractal(q * 6.0f, p.salt, 3);
}

// u in [0, 1] round the axis, from +z towards +x.
glm::vec3 ringPoint(const Pillar& p, const Ring& ring, float u) {
    float w = u >= 1 ? 0 : u;
    glm::vec2 round(std::sin(2 * kPi * w), std::cos(2 * kPi * w));
    glm::vec2 q = glm::mix(round, squareAt(w), ring.square) * ring.r;
    if (p.carve) q = p.carve(q, ring.y);
    float c = std::cos(p.turn), s = std::sin(p.turn);
    q = {q.x * c + q.y * s, q.y * c - q.x * s};
    float above = ring.y / topOf(p);
    float tilt = breakAt(p, q) * above * above;
    return {p.foot.x + q.x, ring.y + tilt, p.foot.y + q.y};
}

float girth(const Ring& ring) {
    return ring.r * glm::mix(2 * kPi, 8.0f, ring.square);
}

std::vector<Ring> refine(const std::vector<Ring>& band, float distance) {
    std::vector<Ring> out{band.front()};
    for (size_t i = 1; i < band.size(); ++i) {
        const Ring &a = band[i - 1], &b = band[i];
        int pieces = std::max(1, static_cast<int>(std::ceil(std::hypot(b.y - a.y, b.r - a.r) / distance)));
        for (int k = 1; k <= pieces; ++k) {
            float f = static_cast<float>(k) / static_cast<float>(pieces);
            out.push_back({glm::mix(a.y, b.y, f), glm::mix(a.r, b.r, f), glm::mix(a.square, b.square, f)});
        }
    }
    return out;
}

Detail pillarDetail(const Pillar& p, glm::vec3 block, glm::vec2 st, float y, float upward) {
    StonePlace place;
    uint32_t drum = 0;
    for (float j : p.joints) {
        float wavy = j + 0.006f * fractal(glm::vec2(st.x * 2.0f, j), 611, 2);
        place.joint = std::min(place.joint, std::abs(y - wavy));
        if (y > wavy) ++drum;
    }
    for (float e : p.edges) place.edge = std::min(place.edge, std::abs(y - e));
    place.id = hash32(p.salt, drum, 41);
    StoneLook look;
    look.block = block;
    look.st = st + glm::vec2(static_cast<float>(p.salt) * 3.7f, 0);
    look.aboveGround = y;
    look.upward = upward;
    look.roughness = upward > 0.5f ? 1.0f + p.topBulge : p.roughness;
    look.belowCrest = topOf(p) - y;
    look.shift = 0.25f;
    Detail d = stoneDetail(place, look);
    return d;
}

void addBand(std::vector<Chart>& charts, const Pillar& p, const std::vector<Ring>& coarse, size_t index) {
    std::vector<Ring> rings = refine(coarse, p.ringDistance);
    Chart chart;
    chart.name = p.name + " band " + std::to_string(index);
    float width = 0;
    std::vector<float> length{0};
    for (size_t i = 0; i < rings.size(); ++i) {
        width += girth(rings[i]) / static_cast<float>(rings.size());
        if (i > 0)
            length.push_back(length.back() + std::hypot(rings[i].y - rings[i - 1].y, rings[i].r - rings[i - 1].r));
    }
    auto uAt = [&](uint32_t c) { return static_cast<float>(c) / static_cast<float>(p.pieces); };
    gridChart(chart, p.pieces + 1, static_cast<uint32_t>(rings.size()), [&](uint32_t c, uint32_t r) {
        float u = uAt(c);
        size_t below = r > 0 ? r - 1 : r, above = r + 1 < rings.size() ? r + 1 : r;
        glm::vec3 up = ringPoint(p, rings[above], u) - ringPoint(p, rings[below], u);
        glm::vec3 round = ringPoint(p, rings[r], uAt((c + 1) % p.pieces)) -
                          ringPoint(p, rings[r], uAt((c + p.pieces - 1) % p.pieces));
        return GridPoint{{u * width, length[r]}, ringPoint(p, rings[r], u), glm::normalize(glm::cross(round, up))};
    });
    chart.detail = [p, rings, length, width](glm::vec2 st) {
        size_t i = 1;
        while (i + 1 < length.size() && st.y > length[i]) ++i;
        float f = saturate((st.y - length[i - 1]) / (length[i] - length[i - 1]));
        const Ring &a = rings[i - 1], &b = rings[i];
        Ring ring{glm::mix(a.y, b.y, f), glm::mix(a.r, b.r, f), glm::mix(a.square, b.square, f)};
        float u = st.x / width;
        glm::vec3 block = ringPoint(p, ring, u - std::floor(u));
        // Noise that depends on st must close round the axis: only the block position does.
        return pillarDetail(p, block, {block.x + block.z, block.y}, ring.y, 0);
    };
    if (p.spiralMask)
        chart.mask = [rings, length, width](glm::vec2 st) {
            size_t i = 1;
            while (i + 1 < length.size() && st.y > length[i]) ++i;
            float y = rings[i - 1].y + (st.y - length[i - 1]);
            float turn = st.x / width - (y * 0.42f + 0.5f);
            float d = std::abs(turn - std::floor(turn) - 0.5f) * width;
            return ramp(0.20f, 0.15f, d);
        };
    charts.push_back(std::move(chart));
}

void addTop(std::vector<Chart>& charts, const Pillar& p) {
    const Ring& ring = p.bands.back().back();
    Chart chart;
    chart.name = p.name + " top";
    std::vector<glm::vec2> loop;
    for (uint32_t c = 0; c < p.pieces; ++c) {
        glm::vec3 q = ringPoint(p, ring, static_cast<float>(c) / static_cast<float>(p.pieces));
        loop.push_back({q.x, -q.z});
    }
    Candidates fill{{}, 0.05f, 0.03f};
    glm::vec2 middle(p.foot.x, -p.foot.y);
    for (float y = -ring.r * 1.5f; y < ring.r * 1.5f; y += 0.045f)
        for (float x = -ring.r * 1.5f; x < ring.r * 1.5f; x += 0.052f) fill.points.push_back(middle + glm::vec2(x, y));
    triangulate(chart, {loop}, {fill});
    auto block = [p, ring](glm::vec2 st) {
        glm::vec2 q(st.x - p.foot.x, -st.y - p.foot.y);
        return glm::vec3(st.x, ring.y + breakAt(p, q), -st.y);
    };
    for (glm::vec2 st : chart.st) {
        chart.block.push_back(block(st));
        chart.normal.push_back({0, 1, 0});
    }
    float square = ring.square, r = ring.r, turn = p.turn;
    chart.detail = [p, block, square, r, turn](glm::vec2 st) {
        Detail d = pillarDetail(p, block(st), st, topOf(p) - 0.05f, 1);
        glm::vec2 q(st.x - p.foot.x, -st.y - p.foot.y);
        float c = std::cos(turn), s = std::sin(turn);
        q = {std::abs(q.x * c - q.y * s), std::abs(q.y * c + q.x * s)};
        float reach = glm::mix(glm::length(q), std::max(q.x, q.y), square);
        // The relief of the break ends before the rim, where the sides begin.
        float rim = ramp(r - 0.09f, r, reach);
        d.height = (1 - rim) * (d.height + p.topBulge * 0.025f * fractal(block(st) * 5.0f, 617, 3)) - 0.015f * rim;
        return d;
    };
    charts.push_back(std::move(chart));
}

void addPillar(std::vector<Chart>& charts, std::vector<Loop>& footprints, const Pillar& p) {
    for (size_t i = 0; i < p.bands.size(); ++i) addBand(charts, p, p.bands[i], i);
    addTop(charts, p);
    Loop loop;
    for (uint32_t c = 0; c < p.pieces; ++c) {
        glm::vec3 q = ringPoint(p, p.bands[0][0], static_cast<float>(c) / static_cast<float>(p.pieces));
        loop.push_back({q.x, q.z});
    }
    footprints.push_back(std::move(loop));
}

// An Attic base on a plinth: plinth, then torus, scotia and torus up to the shaft.
std::vector<std::vector<Ring>> baseBands() {
    return {{{0, 0.44f, 1}, {0.20f, 0.44f, 1}, {0.24f, 0.425f, 1}},
            {{0.24f, 0.425f, 1},
             {0.27f, 0.385f, 0.25f},
             {0.30f, 0.388f, 0},
             {0.34f, 0.40f, 0},
             {0.385f, 0.388f, 0},
             {0.41f, 0.35f, 0},
             {0.45f, 0.325f, 0},
             {0.49f, 0.33f, 0},
             {0.51f, 0.345f, 0},
             {0.545f, 0.345f, 0},
             {0.57f, 0.315f, 0},
             {0.62f, 0.295f, 0}}};
}

Pillar standingColumn() {
    Pillar p{"column", {2.3f, 1.95f}, 0.06f, baseBands(), 0, 0.4f, {0.24f, 1.22f, 1.83f, 2.44f}, {0.23f, 2.97f}, 48,
             31,       true};
    p.bands.push_back({{0.62f, 0.295f, 0}, {1.2f, 0.29f, 0}, {1.8f, 0.275f, 0}, {2.44f, 0.25f, 0}});
    p.bands.push_back({{2.44f, 0.25f, 0},
                       {2.46f, 0.28f, 0},
                       {2.50f, 0.285f, 0},
                       {2.53f, 0.255f, 0},
                       {2.60f, 0.255f, 0},
                       {2.64f, 0.285f, 0},
                       {2.70f, 0.345f, 0},
                       {2.76f, 0.375f, 0.25f},
                       {2.79f, 0.395f, 1}});
    p.bands.push_back({{2.79f, 0.395f, 1}, {2.81f, 0.41f, 1}, {2.97f, 0.41f, 1}});
    return p;
}

Pillar brokenColumn() {
    Pillar p{"stump", {-1.2f, 1.95f}, -0.05f, baseBands(), 0.55f, 2.5f, {0.24f}, {0.23f}, 48, 53, false};
    p.bands.push_back({{0.62f, 0.295f, 0}, {1.0f, 0.29f, 0}, {1.42f, 0.27f, 0}});
    return p;
}

Pillar lowStump() {
    Pillar p{"low stump", {2.75f, 4.15f}, 0.1f, baseBands(), 0.4f, 2.5f, {0.24f}, {0.23f}, 48, 57, false};
    p.bands.push_back({{0.62f, 0.295f, 0}, {0.88f, 0.29f, 0}});
    return p;
}

float bump(float x, float width) {
    return std::exp(-x * x / (width * width));
}

// A veiled figure, its hands folded: shoulders wider than deep, folds that run out towards the chest, a shaded face.
// Heights are of the whole statue; the figure begins at kHem.
constexpr float kHem = 1.02f;
glm::vec2 veiledFigure(glm::vec2 q, float y) {
    float up = y - kHem;
    if (up <= 0) return q;
    float angle = std::atan2(q.x, q.y);  // 0 in front
    float front = std::abs(angle);
    float begins = ramp(0.0f, 0.12f, up);
    float folds = begins * (0.3f + 0.7f * ramp(1.05f, 0.1f, up)) * ramp(1.36f, 1.15f, up);
    float grow = 0.12f * std::sin(9 * angle + 2.1f * std::sin(2.3f * up + 0.7f)) +
                 0.06f * std::sin(15 * angle - 3.0f * up + 1.9f) + 0.03f * std::sin(23 * angle + 5 * up);
    float r = 1 + folds * grow;
    r += 0.22f * bump(front - 1.4f, 0.36f) * ramp(0.70f, 0.84f, up) * ramp(1.24f, 1.05f, up);  // upper arms
    float lower = 0.80f + 0.06f * saturate(1 - front / 1.3f);
    r += 0.34f * bump(up - lower, 0.075f) * ramp(1.75f, 1.15f, front);  // fore arms, hands folded in front
    // The face lies deep in the veil.
    r -= 0.33f * ramp(0.92f, 0.40f, front) * ramp(0.115f, 0.05f, std::abs(up - 1.455f));
    r += 0.20f * bump(front, 0.34f) * bump(up - 1.455f, 0.075f) + 0.10f * bump(front, 0.09f) * bump(up - 1.455f, 0.03f);
    r += 0.06f * bump(front - 0.9f, 0.2f) * bump(up - 1.40f, 0.2f);
    float wide = 1 + 0.30f * bump(up - 1.16f, 0.16f), deep = 1 - 0.22f * bump(up - 1.1f, 0.3f);
    q = glm::vec2(q.x * wide, q.y * deep) * r;
    q.y += 0.05f * ramp(1.15f, 1.5f, up) - 0.03f * bump(up - 0.5f, 0.3f);  // the head is bowed, the knees lean back
    return q;
}

Pillar statue() {
    Pillar p{"statue", {-0.75f, 3.55f}, 0.62f,  {},          0, 0, {0.20f, 0.84f}, {0.17f, 0.97f}, 56,
             63,       false,           0.034f, veiledFigure};
    p.roughness = 0.42f;
    p.bands = {{{0, 0.46f, 1}, {0.17f, 0.46f, 1}, {0.20f, 0.42f, 1}, {0.25f, 0.345f, 1}},
               {{0.25f, 0.345f, 1}, {0.78f, 0.335f, 1}},
               {{0.78f, 0.335f, 1},
                {0.83f, 0.36f, 1},
                {0.88f, 0.41f, 1},
                {0.97f, 0.415f, 1},
                {0.985f, 0.32f, 0.8f},
                {kHem, 0.285f, 0}},
               {{kHem, 0.285f, 0}, {1.10f, 0.285f, 0}, {1.45f, 0.245f, 0}, {1.70f, 0.235f, 0}},
               {{1.70f, 0.235f, 0}, {1.86f, 0.20f, 0}, {2.04f, 0.215f, 0}, {2.18f, 0.205f, 0}, {2.28f, 0.165f, 0}},
               {{2.28f, 0.165f, 0},
                {2.36f, 0.142f, 0},
                {2.48f, 0.148f, 0},
                {2.57f, 0.135f, 0},
                {2.63f, 0.105f, 0},
                {2.665f, 0.062f, 0}}};
    return p;
}

Pillar fallenStone(const char* name, glm::vec2 foot, float turn, float halfWidth, float height, float tilt,
                   uint32_t salt) {
    return {
        name, foot,
        turn, {{{0, halfWidth * 1.04f, 0.9f}, {height * 0.8f, halfWidth, 0.9f}, {height, halfWidth * 0.93f, 0.85f}}},
        tilt, 0.6f,
        {},   {},
        32,   salt,
        false};
}

}  // namespace

void addColumns(std::vector<Chart>& charts, std::vector<Loop>& footprints) {
    addPillar(charts, footprints, standingColumn());
    addPillar(charts, footprints, brokenColumn());
    addPillar(charts, footprints, lowStump());
    addPillar(charts, footprints, statue());
    addPillar(charts, footprints, fallenStone("fallen stone 0", {3.45f, 1.0f}, 0.5f, 0.24f, 0.30f, 0.25f, 71));
    addPillar(charts, footprints, fallenStone("fallen stone 1", {-2.2f, 2.75f}, -0.35f, 0.27f, 0.26f, -0.20f, 72));
    addPillar(charts, footprints, fallenStone("fallen stone 2", {0.15f, 2.95f}, 0.9f, 0.20f, 0.20f, 0.3f, 73));
}

}  // namespace espalier::content
