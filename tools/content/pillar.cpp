// Profiles swept round an axis. In: rings, whose section passes between square and circle. Out: a chart for each band
// and for the top, and the footprint.

#include "tools/content/pillar.hpp"

#include <algorithm>
#include <cmath>

#include "tools/content/masonry.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

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
glm::vec2 sectionPoint(const Ring& ring, float u) {
    float w = u >= 1 ? 0 : u;
    glm::vec2 round(std::sin(2 * kPi * w), std::cos(2 * kPi * w));
    return glm::mix(round, squareAt(w), ring.square) * ring.r;
}

glm::vec3 ringPoint(const Pillar& p, const Ring& ring, float u) {
    glm::vec2 q = sectionPoint(ring, u);
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
    look.aboveGround = y + p.dry;
    look.upward = upward;
    look.roughness = upward > 0.5f ? 1.0f + p.topBulge : p.roughness;
    look.belowCrest = std::abs(topOf(p) - y);
    look.shift = 0.25f;
    return stoneDetail(place, look);
}

// Carved work stands out of the stone, and its depths are dark.
void carve(const Pillar& p, glm::vec2 section, float y, Detail& d) {
    if (!p.relief) return;
    float relief = p.relief(section, y);
    (p.shallow ? d.bump : d.height) += relief;
    d.albedo *= glm::clamp(1 + 16 * relief, 0.45f, 1.15f);
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
        u -= std::floor(u);
        glm::vec3 block = ringPoint(p, ring, u);
        // Noise that depends on st must close round the axis: only the block position does.
        Detail d = pillarDetail(p, block, {block.x + block.z, block.y}, ring.y, 0);
        carve(p, sectionPoint(ring, u), ring.y, d);
        return d;
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

Detail soil(glm::vec3 block) {
    float clods = fractal(block * 14.0f, 621, 3);
    return {0.012f * clods, glm::vec3(0.075f, 0.052f, 0.033f) * (1 + 0.5f * clods)};
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
        if (p.earthTop) return soil(block(st));
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

}  // namespace

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

}  // namespace espalier::content
