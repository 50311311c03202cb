// A painted picture in either UV set -> values at the texels of the walk's finest level.
// Pictures in the materials' UV are resampled over the mesh, which has both UV sets at its vertices: each triangle is
// rasterised in the walk's UV, and read from a half-sized copy of the picture where it is drawn smaller there.
#include "runtime/plugin/layer_resample.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {
namespace {

constexpr float kUnset = -1;
constexpr int kGutterPasses = 16;  // as wide as any gutter that the baker fills
constexpr int kEmptyPasses = 2;    // further out only for bilinear reads

struct GreyMap {
    std::vector<float> texels;
    int width = 0, height = 0;

    float at(int x, int y, bool repeat) const {
        if (repeat) {
            x = ((x % width) + width) % width;
            y = ((y % height) + height) % height;
        }
        x = std::clamp(x, 0, width - 1);
        y = std::clamp(y, 0, height - 1);
        return texels[size_t(y) * width + x];
    }
    float sample(glm::vec2 uv, bool repeat) const {
        if (repeat) uv -= glm::floor(uv);
        uv = glm::clamp(uv, glm::vec2(0), glm::vec2(1));
        const float x = uv.x * width - .5f, y = uv.y * height - .5f;
        const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
        const float fx = x - x0, fy = y - y0;
        const float top = at(x0, y0, repeat) * (1 - fx) + at(x0 + 1, y0, repeat) * fx;
        const float bottom = at(x0, y0 + 1, repeat) * (1 - fx) + at(x0 + 1, y0 + 1, repeat) * fx;
        return top * (1 - fy) + bottom * fy;
    }
};

GreyMap copyOf(const LayerPicture& source) {
    GreyMap picture{{source.texels.begin(), source.texels.end()}, int(source.width), int(source.height)};
    for (float& value : picture.texels) value = layerValue(value);
    return picture;
}

GreyMap halved(const GreyMap& from) {
    GreyMap to{{}, std::max(1, from.width / 2), std::max(1, from.height / 2)};
    to.texels.resize(size_t(to.width) * to.height);
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x)
            to.texels[size_t(y) * to.width + x] =
                (from.at(2 * x, 2 * y, false) + from.at(2 * x + 1, 2 * y, false) + from.at(2 * x, 2 * y + 1, false) +
                 from.at(2 * x + 1, 2 * y + 1, false)) *
                .25f;
    return to;
}

float cross(glm::vec2 a, glm::vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// The copy of the picture whose texels are about as large as the walk's on this triangle.
const GreyMap& levelFor(const std::vector<GreyMap>& levels, float pictureArea, float walkArea, uint32_t size) {
    const GreyMap& finest = levels.front();
    const float ratio = pictureArea * finest.width * finest.height / std::max(walkArea * size * size, 1e-20f);
    const float level = ratio > 1 ? std::floor(.5f * std::log2(ratio) + .25f) : 0;
    return levels[size_t(std::min(level, float(levels.size() - 1)))];
}

// An atlas ends at its picture's border; only UVs beyond it say that the picture is meant to repeat.
bool repeats(const SurfaceData& surface) {
    constexpr float kSlack = 1e-3f;
    for (const DrawVertex& vertex : surface.vertices)
        if (glm::any(glm::lessThan(vertex.uv, glm::vec2(-kSlack))) ||
            glm::any(glm::greaterThan(vertex.uv, glm::vec2(1 + kSlack))))
            return true;
    return false;
}

void rasterise(const SurfaceData& surface, const std::vector<GreyMap>& levels, uint32_t size, std::vector<float>& out) {
    const bool repeat = repeats(surface);
    for (size_t i = 0; i + 2 < surface.indices.size(); i += 3) {
        const DrawVertex* v[3] = {&surface.vertices[surface.indices[i]], &surface.vertices[surface.indices[i + 1]],
                                  &surface.vertices[surface.indices[i + 2]]};
        const glm::vec2 a = v[0]->walkUv, ab = v[1]->walkUv - a, ac = v[2]->walkUv - a;
        const float area = cross(ab, ac);
        if (!(std::abs(area) > 1e-20f)) continue;
        const glm::vec2 m = v[0]->uv, mb = v[1]->uv - m, mc = v[2]->uv - m;
        const GreyMap& picture = levelFor(levels, std::abs(cross(mb, mc)), std::abs(area), size);
        const glm::vec2 low = glm::min(a, glm::min(v[1]->walkUv, v[2]->walkUv)) * float(size) - .5f;
        const glm::vec2 high = glm::max(a, glm::max(v[1]->walkUv, v[2]->walkUv)) * float(size) - .5f;
        const int last = int(size) - 1;
        const int x0 = std::clamp(int(std::ceil(low.x)), 0, last), x1 = std::clamp(int(high.x), 0, last);
        const int y0 = std::clamp(int(std::ceil(low.y)), 0, last), y1 = std::clamp(int(high.y), 0, last);
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const glm::vec2 p = (glm::vec2(x, y) + .5f) / float(size) - a;
                const float s = cross(p, ac) / area, t = cross(ab, p) / area;
                if (s < -1e-4f || t < -1e-4f || s + t > 1.0001f) continue;
                out[texelIndex(size, x, y)] = picture.sample(m + s * mb + t * mc, repeat);
            }
    }
}

// Sets unset texels from set neighbours, of the same chart or (anyChart) of whichever. False: nothing was left to do.
bool spread(const std::vector<Texel>& texels, uint32_t size, bool anyChart, std::vector<float>& values) {
    std::vector<std::pair<uint32_t, float>> found;
    for (int y = 0; y < int(size); ++y)
        for (int x = 0; x < int(size); ++x) {
            const uint32_t here = texelIndex(size, x, y);
            if (values[here] != kUnset) continue;
            const uint32_t bits = texels[here].bits;
            if (!anyChart && texelClass(bits) == kTexelEmpty) continue;
            float sum = 0;
            int count = 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    const int nx = x + dx, ny = y + dy;
                    if (nx < 0 || ny < 0 || nx >= int(size) || ny >= int(size)) continue;
                    const uint32_t there = texelIndex(size, nx, ny);
                    if (values[there] == kUnset) continue;
                    if (!anyChart && texelChart(texels[there].bits) != texelChart(bits)) continue;
                    sum += values[there];
                    ++count;
                }
            if (count) found.push_back({here, sum / count});
        }
    for (const auto& [index, value] : found) values[index] = value;
    return !found.empty();
}

}  // namespace

std::vector<float> resampleLayer(const SurfaceData& surface, const LayerPicture& source) {
    const SurfaceLevelData& level = surface.levels.front();
    const uint32_t size = level.size;
    std::vector<float> values(size_t(size) * size, kUnset);
    std::vector<GreyMap> levels{copyOf(source)};
    if (source.materialUv) {
        while (levels.back().width > 1 && levels.back().height > 1) levels.push_back(halved(levels.back()));
        rasterise(surface, levels, size, values);
    } else {
        for (uint32_t y = 0; y < size; ++y)
            for (uint32_t x = 0; x < size; ++x) {
                const uint32_t here = texelIndex(size, x, y);
                if (texelClass(level.texels[here].bits) == kTexelInner)
                    values[here] = levels.front().sample((glm::vec2(x, y) + .5f) / float(size), false);
            }
    }
    for (int pass = 0; pass < kGutterPasses; ++pass)
        if (!spread(level.texels, size, false, values)) break;
    for (int pass = 0; pass < kEmptyPasses; ++pass)
        if (!spread(level.texels, size, true, values)) break;
    for (float& value : values)
        if (value == kUnset) value = 0;
    return values;
}

}  // namespace espalier
