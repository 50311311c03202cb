// In: a baked surface. Out: pictures of its finest level to judge an atlas by.
#include "tools/bake/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "shaders/shared/exact.h"
#include "tools/bake/canvas.hpp"

namespace espalier {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kLinkLines = 90;        // that links.png draws at most: more would hide the atlas
constexpr uint32_t kLegible = 512;      // pixels: narrower pictures have no legend
constexpr int kRow = 26, kSwatch = 34;  // pixels of a legend's line, and of what stands before its words
const vec3 kWords(0.86f, 0.87f, 0.88f);
const vec3 kSeam(0.95f), kNear(1.0f, 0.75f, 0.1f), kOpen(0.95f, 0.25f, 0.2f);

vec3 fromHue(float hue, float saturation, float value) {
    vec3 k(5, 3, 1), out;
    for (int i = 0; i < 3; ++i) {
        float m = std::fmod(k[i] + hue * 6, 6.0f);
        out[i] = value - value * saturation * std::clamp(std::min(m, 4 - m), 0.0f, 1.0f);
    }
    return out;
}

// Golden-ratio steps keep the colours of neighbouring numbers apart.
vec3 chartColor(uint32_t chart) {
    float hue = std::fmod(float(chart) * 0.61803399f, 1.0f),
          value = 0.68f + 0.22f * std::fmod(float(chart) * 0.3819f, 1.0f);
    return fromHue(hue, 0.45f, value);
}

// Light from the upper left of the model's front.
float shade(vec3 normal) {
    return 0.62f + 0.38f * glm::dot(normal, glm::normalize(vec3(-0.4f, 0.75f, 0.55f)));
}

// What a picture's colours and lines mean. draw: into a box of kSwatch by 14 pixels whose corner it is given.
struct Meaning {
    std::function<void(Canvas&, vec2)> draw;
    const char* words;
};

void addLegend(Canvas& canvas, const std::vector<Meaning>& meanings) {
    if (canvas.size() < kLegible) return;
    int x = 12, y = canvas.extend(kRow + 8) + 10;
    for (const Meaning& m : meanings) {
        const int wide = kSwatch + 8 + Canvas::textWidth(m.words);
        if (x + wide > int(canvas.size()) - 12) x = 12, y = canvas.extend(kRow) + 2;
        m.draw(canvas, vec2(x, y));
        canvas.text(x + kSwatch + 8, y, m.words, kWords);
        x += wide + 24;
    }
}

Meaning patch(vec3 color, const char* words) {
    return {[=](Canvas& canvas, vec2 at) { canvas.fill(int(at.x), int(at.y), kSwatch, 14, color); }, words};
}
Meaning line(vec3 color, const char* words) {
    return {[=](Canvas& canvas, vec2 at) { canvas.line(at + vec2(0, 7), at + vec2(kSwatch, 7), color, 2, 1); }, words};
}
const Meaning kBorderMeanings[] = {line(kSeam, "border that leads on"), line(kNear, "to a near border"),
                                   line(kOpen, "open")};

template <class Color>
void paint(const SurfaceData& surface, Canvas& canvas, Color&& color) {
    const SurfaceLevelData& level = surface.levels[0];
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            uint32_t i = texelIndex(level.size, x, y), kind = texelClass(level.texels[i].bits);
            if (kind == kTexelEmpty) continue;
            vec3 c = color(level.texels[i], level.aux[i]);
            if (kind != kTexelInner) c = c * 0.35f + vec3(0.08f);
            canvas.at(x, y) = c;
        }
}

void drawBorders(const SurfaceData& surface, Canvas& canvas) {
    float size = float(canvas.size());
    for (const Crossing& c : surface.crossings) {
        if ((c.flags & 3u) == kCrossingContact) continue;
        vec3 color = (c.flags & 3u) == kCrossingOpen ? kOpen : (c.flags & 3u) == kCrossingNearest ? kNear : kSeam;
        canvas.line(c.a * size, c.b * size, color, 1.3f, 0.9f);
    }
}

// Two charts that lead to each other have one colour for it.
vec3 pairColor(const Crossing& c) {
    return fromHue(std::fmod(float((c.flags >> 16) + (c.target & 0xFFFFu)) * 0.61803399f, 1.0f), 0.7f, 1.0f);
}

// Borders in the colour of their pair. A line is drawn where it stands for a stretch of border, so that long borders
// show few; dots mark its ends.
void drawLinks(const SurfaceData& surface, Canvas& canvas) {
    float size = float(canvas.size()), since = 1e9f, total = 0;
    for (const Crossing& c : surface.crossings)
        if ((c.flags & 3u) != kCrossingOpen) total += glm::length(c.b - c.a) * size;
    float spacing = total / kLinkLines;
    for (const Crossing& c : surface.crossings) {
        if ((c.flags & 3u) == kCrossingOpen) {
            canvas.line(c.a * size, c.b * size, vec3(0.5f), 1.3f, 1);
            continue;
        }
        canvas.line(c.a * size, c.b * size, pairColor(c), 2, 1);
        since += glm::length(c.b - c.a) * size;
        if (since < spacing) continue;
        since = 0;
        vec2 from = (c.a + c.b) * (size / 2), to = (c.ta + c.tb) * (size / 2);
        canvas.line(from, to, pairColor(c), 1, 0.45f);
        for (vec2 end : {from, to}) canvas.line(end - vec2(1, 0), end + vec2(1, 0), pairColor(c), 6, 1);
    }
}

// Which texels lie within a chart: gutters are link texels too, buried ones lie inside.
std::vector<uint8_t> insideCharts(const SurfaceData& surface) {
    int size = int(surface.levels[0].size);
    std::vector<uint8_t> inside(size_t(size) * size_t(size), 0);
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
        vec2 p[3], low(1e30f), high(-1e30f);
        for (size_t k = 0; k < 3; ++k) {
            p[k] = surface.vertices[surface.indices[i + k]].walkUv * float(size) - 0.5f;
            low = glm::min(low, p[k]), high = glm::max(high, p[k]);
        }
        auto cross = [](vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; };
        float turn = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1.0f : 1.0f;
        for (int y = std::max(0, int(std::ceil(low.y))); y <= std::min(size - 1, int(high.y)); ++y)
            for (int x = std::max(0, int(std::ceil(low.x))); x <= std::min(size - 1, int(high.x)); ++x) {
                vec2 q = vec2(float(x), float(y));
                bool in = true;
                for (int k = 0; k < 3; ++k) in = in && turn * cross(p[(k + 1) % 3] - p[k], q - p[k]) >= 0;
                if (in) inside[size_t(y) * size_t(size) + size_t(x)] = 1;
            }
    }
    return inside;
}

const vec3 kBare(0.62f, 0.63f, 0.6f);
vec3 buriedColor(uint32_t x, uint32_t y) {
    return (x + y) % 8 < 3 ? vec3(0.72f, 0.2f, 0.16f) : vec3(0.3f, 0.13f, 0.12f);
}

std::vector<Meaning> contactMeanings() {
    const vec3 color = fromHue(0.45f, 0.7f, 1.0f);
    auto buried = [](Canvas& canvas, vec2 at) {
        for (uint32_t y = uint32_t(at.y); y < uint32_t(at.y) + 14; ++y)
            for (uint32_t x = uint32_t(at.x); x < uint32_t(at.x) + kSwatch; ++x) canvas.at(x, y) = buriedColor(x, y);
    };
    auto contact = [=](Canvas& canvas, vec2 at) {
        canvas.line(at + vec2(0, 11), at + vec2(kSwatch, 11), color, 1.6f, 1);
        for (float x = 3; x < kSwatch; x += 6) canvas.line(at + vec2(x, 11), at + vec2(x, 5), color, 1, 0.8f);
    };
    auto back = [=](Canvas& canvas, vec2 at) {
        for (float x = 0; x < kSwatch; x += 8)
            canvas.line(at + vec2(x, 7), at + vec2(std::min(x + 4, float(kSwatch)), 7), color, 1.6f, 1);
    };
    return {patch(kBare, "ground"),
            {buried, "buried or bare: no ground"},
            {contact, "contact, walks come from its feathers"},
            {back, "to a sheet's back"},
            kBorderMeanings[0],
            kBorderMeanings[1],
            kBorderMeanings[2]};
}

// Ground in grey, buried texels hatched in red, contacts in the colour of their pair: a line with feathers on the side
// from which a walk may come; dashed where they lead to the back of a sheet.
Status writeContacts(const SurfaceData& surface, const std::string& path) {
    uint32_t size = surface.levels[0].size;
    Canvas canvas(size);
    std::vector<uint8_t> inside = insideCharts(surface);
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) {
            uint32_t at = texelIndex(size, x, y), kind = texelClass(surface.levels[0].texels[at].bits);
            if (kind == kTexelEmpty || !inside[size_t(y) * size + x]) continue;
            float light = shade(unpackOct(surface.levels[0].aux[at].normal));
            canvas.at(x, y) = (kind == kTexelInner ? kBare : buriedColor(x, y)) * light;
        }
    drawBorders(surface, canvas);
    float scale = float(size), since = 0;
    for (const Crossing& c : surface.crossings) {
        if ((c.flags & 3u) != kCrossingContact) continue;
        const vec3 color = pairColor(c);
        vec2 a = c.a * scale, b = c.b * scale, d = b - a;
        float length = glm::length(d);
        if (!(length > 0)) continue;
        vec2 side = vec2(-d.y, d.x) * ((c.flags & kCrossingInsideLeft) != 0 ? 1.0f : -1.0f) / length;
        float step = (c.flags & kCrossingTurned) != 0 ? 4.0f : length;
        for (float t = 0; t < length; t += 2 * step)
            canvas.line(a + d * (t / length), a + d * (std::min(t + step, length) / length), color, 1.6f, 1.0f);
        for (float t = 6 - since; t < length; t += 6)
            canvas.line(a + d * (std::max(t, 0.0f) / length), a + d * (std::max(t, 0.0f) / length) + side * 4.0f, color,
                        1.0f, 0.8f);
        since = std::fmod(since + length, 6.0f);
    }
    addLegend(canvas, contactMeanings());
    return canvas.write(path);
}

constexpr float kOctaves = 1.585f;  // of stretch, to a colour's end: a factor of 3

// Longer texels than the mean are red, shorter ones blue.
vec3 stretchColor(float octaves) {
    const float k = std::clamp(std::abs(octaves) / kOctaves, 0.0f, 1.0f);
    return vec3(0.93f) * (1 - k) + (octaves > 0 ? vec3(0.86f, 0.16f, 0.12f) : vec3(0.12f, 0.35f, 0.85f)) * k;
}

}  // namespace

Status writePictures(const SurfaceData& surface, const std::string& folder) {
    uint32_t size = surface.levels[0].size;
    auto charts = [&](const Texel& t, const TexelAux& aux) {
        return chartColor(texelChart(t.bits)) * shade(unpackOct(aux.normal));
    };
    Canvas canvas(size);
    paint(surface, canvas, charts);
    Canvas links = canvas;
    drawBorders(surface, canvas);
    addLegend(canvas,
              {patch(chartColor(6), "chart"), patch(chartColor(6) * 0.35f + vec3(0.08f), "buried, or around a chart"),
               kBorderMeanings[0], kBorderMeanings[1], kBorderMeanings[2]});
    Status done = canvas.write(folder + "/charts.png");
    if (!done) return done;

    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            links.at(x, y) = vec3(glm::dot(links.at(x, y), vec3(0.3f, 0.5f, 0.2f))) * 0.55f;
    drawLinks(surface, links);
    auto pair = [](Canvas& to, vec2 at) {
        const vec3 color = fromHue(0.45f, 0.7f, 1.0f);
        for (float y : {2.0f, 12.0f}) to.line(at + vec2(0, y), at + vec2(kSwatch, y), color, 2, 1);
        to.line(at + vec2(10, 2), at + vec2(24, 12), color, 1, 0.6f);
    };
    addLegend(links, {{pair, "borders and contacts of one colour lead to each other; lines are samples"},
                      line(vec3(0.5f), "open")});
    done = links.write(folder + "/links.png");
    if (!done) return done;
    done = writeContacts(surface, folder + "/contacts.png");
    if (!done) return done;

    // One scale for all charts, so that charts given too little room show as well.
    double area = 0, uv = 0;
    for (const Chart& c : surface.charts)
        area += c.area, uv += double(c.area) / (double(c.metresPerUv) * c.metresPerUv);
    float mean = float(std::sqrt(area / uv));
    Canvas stretch(size);
    paint(surface, stretch, [&](const Texel&, const TexelAux& aux) {
        const TrianglePlane& t = surface.triangles[aux.triangle];
        float uu = glm::dot(t.du, t.du), vv = glm::dot(t.dv, t.dv), mixed = glm::dot(t.du, t.dv);
        float half = std::sqrt((uu - vv) * (uu - vv) / 4 + mixed * mixed), middle = (uu + vv) / 2;
        float most = std::sqrt(middle + half) / mean, least = std::sqrt(std::max(middle - half, 0.0f)) / mean;
        // What is farther from 1, on a scale of octaves.
        float high = std::log2(std::max(most, 1e-6f)), low = std::log2(std::max(least, 1e-6f));
        return stretchColor(std::abs(high) > std::abs(low) ? high : low) * (0.4f + 0.6f * shade(unpackOct(aux.normal)));
    });
    auto scale = [](Canvas& to, vec2 at) {
        for (int i = 0; i < kSwatch; ++i)
            to.fill(int(at.x) + i, int(at.y), 1, 14, stretchColor(kOctaves * (2 * float(i) / (kSwatch - 1) - 1)));
    };
    addLegend(stretch,
              {{scale, "a texel's length on the model: a third (blue), the mean (white), three times that (red)"}});
    return stretch.write(folder + "/stretch.png");
}

}  // namespace espalier
