// In: a baked surface. Out: pictures of its finest level to judge an atlas by.
#include "tools/bake/pictures.hpp"

#include <stb_image_write.h>

#include <algorithm>
#include <cmath>

#include "runtime/core/file.hpp"
#include "shaders/shared/exact.h"

namespace espalier {
namespace {

using glm::vec2;
using glm::vec3;

constexpr float kLinkLines = 220;  // that links.png draws at most: more would hide the atlas

class Canvas {
  public:
    explicit Canvas(uint32_t size) : size_(size), pixels_(size_t(size) * size, vec3(0.11f, 0.115f, 0.13f)) {}
    uint32_t size() const { return size_; }
    vec3& at(uint32_t x, uint32_t y) { return pixels_[size_t(y) * size_ + x]; }

    void blend(int x, int y, vec3 color, float alpha) {
        if (x < 0 || y < 0 || x >= int(size_) || y >= int(size_)) return;
        vec3& p = at(uint32_t(x), uint32_t(y));
        p = p * (1 - alpha) + color * alpha;
    }

    // A smooth line; a and b in pixels.
    void line(vec2 a, vec2 b, vec3 color, float width, float alpha) {
        vec2 low = glm::min(a, b) - vec2(width + 1), high = glm::max(a, b) + vec2(width + 1), d = b - a;
        float length2 = std::max(glm::dot(d, d), 1e-12f);
        bool steep = std::abs(d.y) > std::abs(d.x);
        int i0 = std::max(0, int(steep ? low.y : low.x)), i1 = std::min(int(size_) - 1, int(steep ? high.y : high.x));
        for (int i = i0; i <= i1; ++i) {
            float t = steep ? (float(i) + 0.5f - a.y) / d.y : (float(i) + 0.5f - a.x) / (d.x == 0 ? 1e-6f : d.x);
            vec2 p = a + d * std::clamp(t, 0.0f, 1.0f);
            int middle = int(steep ? p.x : p.y), reach = int(width * 1.5f) + 2;
            for (int j = middle - reach; j <= middle + reach; ++j) {
                vec2 c = steep ? vec2(float(j) + 0.5f, float(i) + 0.5f) : vec2(float(i) + 0.5f, float(j) + 0.5f);
                vec2 away = c - a - d * std::clamp(glm::dot(c - a, d) / length2, 0.0f, 1.0f);
                float cover = std::clamp(width / 2 + 0.5f - glm::length(away), 0.0f, 1.0f);
                if (cover > 0) blend(steep ? j : i, steep ? i : j, color, cover * alpha);
            }
        }
    }

    Status write(const std::string& path) const {
        std::vector<uint8_t> rgb;
        rgb.reserve(pixels_.size() * 3);
        for (const vec3& p : pixels_)
            for (int k = 0; k < 3; ++k) rgb.push_back(uint8_t(std::clamp(p[k], 0.0f, 1.0f) * 255.0f + 0.5f));
        std::vector<std::byte> file;
        stbi_write_png_to_func(
            [](void* out, void* data, int bytes) {
                auto* from = static_cast<std::byte*>(data);
                auto& to = *static_cast<std::vector<std::byte>*>(out);
                to.insert(to.end(), from, from + bytes);
            },
            &file, int(size_), int(size_), 3, rgb.data(), int(size_) * 3);
        return writeFile(path, file);
    }

  private:
    uint32_t size_;
    std::vector<vec3> pixels_;
};

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
        vec3 color(0.95f);
        if ((c.flags & 3u) == kCrossingContact) continue;
        if ((c.flags & 3u) == kCrossingOpen) color = vec3(0.95f, 0.25f, 0.2f);
        if ((c.flags & 3u) == kCrossingNearest) color = vec3(1.0f, 0.75f, 0.1f);
        canvas.line(c.a * size, c.b * size, color, 1.3f, 0.9f);
    }
}

// A seam's line is drawn where it stands for a stretch of border, so that long borders show few lines.
void drawLinks(const SurfaceData& surface, Canvas& canvas) {
    float size = float(canvas.size()), since = 1e9f, total = 0;
    for (const Crossing& c : surface.crossings) total += glm::length(c.b - c.a) * size;
    float spacing = total / kLinkLines;
    for (uint32_t i = 0; i < surface.crossings.size(); ++i) {
        const Crossing& c = surface.crossings[i];
        if ((c.flags & 3u) == kCrossingOpen) continue;
        since += glm::length(c.b - c.a) * size;
        if (since < spacing) continue;
        since = 0;
        vec2 from = (c.a + c.b) * (size / 2), to = (c.ta + c.tb) * (size / 2);
        canvas.line(from, to, fromHue(std::fmod(float(i) * 0.618f, 1.0f), 0.55f, 1.0f), 1.0f, 0.5f);
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
            bool hatch = (x + y) % 8 < 3;
            canvas.at(x, y) = kind == kTexelInner
                                  ? vec3(0.62f, 0.63f, 0.6f) * light
                                  : (hatch ? vec3(0.72f, 0.2f, 0.16f) : vec3(0.3f, 0.13f, 0.12f)) * light;
        }
    drawBorders(surface, canvas);
    float scale = float(size), since = 0;
    for (const Crossing& c : surface.crossings) {
        if ((c.flags & 3u) != kCrossingContact) continue;
        uint32_t here = c.flags >> 16, there = c.target & 0xFFFFu;
        vec3 color = fromHue(std::fmod(float(here + there) * 0.61803399f, 1.0f), 0.75f, 1.0f);
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
    return canvas.write(path);
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
    Status done = canvas.write(folder + "/charts.png");
    if (!done) return done;

    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x) links.at(x, y) = links.at(x, y) * 0.7f;
    drawLinks(surface, links);
    drawBorders(surface, links);
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
        // What is farther from 1, on a scale of octaves: metres per texel above the mean are red.
        float high = std::log2(std::max(most, 1e-6f)), low = std::log2(std::max(least, 1e-6f));
        float worst = std::abs(high) > std::abs(low) ? high : low, k = std::clamp(std::abs(worst) / 1.5f, 0.0f, 1.0f);
        vec3 end = worst > 0 ? vec3(0.86f, 0.16f, 0.12f) : vec3(0.12f, 0.35f, 0.85f);
        return (vec3(0.93f) * (1 - k) + end * k) * (0.4f + 0.6f * shade(unpackOct(aux.normal)));
    });
    return stretch.write(folder + "/stretch.png");
}

}  // namespace espalier
