// Paints an atlas. In: charts with their detail functions, the assembly. Out: colour, the part of the relief that
// the mesh leaves out as normals, and the layers, all carried on into the gutters.

#include <algorithm>
#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/model.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

// Per texel of the atlas: the chart and the mesh's height there.
struct Coverage {
    std::vector<int> chart;
    std::vector<float> meshHeight;
};

Coverage rasterise(const std::vector<Chart>& charts, const Assembly& assembly, int size) {
    Coverage out;
    size_t texels = static_cast<size_t>(size) * static_cast<size_t>(size);
    out.chart.assign(texels, -1);
    out.meshHeight.assign(texels, 0);
    float scale = static_cast<float>(size);
    for (size_t c = 0; c < charts.size(); ++c)
        for (auto& t : charts[c].triangles) {
            glm::vec2 p[3];
            float h[3];
            for (size_t k = 0; k < 3; ++k) {
                p[k] = assembly.mesh.uvs[assembly.firstVertex[c] + t[k]] * scale - 0.5f;
                h[k] = assembly.meshHeight[assembly.firstVertex[c] + t[k]];
            }
            glm::vec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
            float area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
            for (int y = std::max(0, static_cast<int>(std::ceil(low.y)));
                 y <= std::min(size - 1, static_cast<int>(high.y)); ++y)
                for (int x = std::max(0, static_cast<int>(std::ceil(low.x)));
                     x <= std::min(size - 1, static_cast<int>(high.x)); ++x) {
                    glm::vec2 q(x, y);
                    float w1 = ((q.x - p[0].x) * (p[2].y - p[0].y) - (q.y - p[0].y) * (p[2].x - p[0].x)) / area;
                    float w2 = ((p[1].x - p[0].x) * (q.y - p[0].y) - (p[1].y - p[0].y) * (q.x - p[0].x)) / area;
                    if (w1 < -1e-3f || w2 < -1e-3f || w1 + w2 > 1.001f) continue;
                    size_t at = static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x);
                    out.chart[at] = static_cast<int>(c);
                    out.meshHeight[at] = h[0] * (1 - w1 - w2) + h[1] * w1 + h[2] * w2;
                }
        }
    return out;
}

glm::vec2 uvOf(int x, int y, int side) {
    return (glm::vec2(x, y) + 0.5f) / static_cast<float>(side);
}

}  // namespace

void dilate(Picture& picture, std::vector<uint8_t> filled, int rounds) {
    std::vector<size_t> fresh;
    for (int round = 0; round < rounds; ++round) {
        fresh.clear();
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                size_t at = static_cast<size_t>(y) * static_cast<size_t>(picture.width) + static_cast<size_t>(x);
                if (filled[at] != 0) continue;
                int sum[3] = {0, 0, 0}, count = 0;
                for (int dy = -1; dy <= 1; ++dy)
                    for (int dx = -1; dx <= 1; ++dx) {
                        int nx = x + dx, ny = y + dy;
                        if (nx < 0 || ny < 0 || nx >= picture.width || ny >= picture.height) continue;
                        if (filled[static_cast<size_t>(ny) * static_cast<size_t>(picture.width) +
                                   static_cast<size_t>(nx)] == 0)
                            continue;
                        const uint8_t* c = picture.at(nx, ny);
                        for (int k = 0; k < 3; ++k) sum[k] += c[k];
                        ++count;
                    }
                if (count == 0) continue;
                for (int k = 0; k < 3; ++k) picture.at(x, y)[k] = static_cast<uint8_t>((sum[k] + count / 2) / count);
                fresh.push_back(at);
            }
        for (size_t at : fresh) filled[at] = 1;
    }
}

Picture paintLayer(const std::vector<Chart>& charts, const Assembly& assembly, const Coverage& cover, int size,
                   std::function<float(glm::vec2)> Chart::*layer, float otherwise) {
    Picture out(size, size);
    std::vector<uint8_t> filled(cover.chart.size(), 0);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            size_t at = static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x);
            uint8_t* texel = out.at(x, y);
            texel[0] = texel[1] = texel[2] = toByte(otherwise);
            texel[3] = 255;
            if (cover.chart[at] < 0) continue;
            filled[at] = 1;
            size_t c = static_cast<size_t>(cover.chart[at]);
            if (auto& value = charts[c].*layer)
                texel[0] = texel[1] = texel[2] = toByte(value(assembly.toSt(c, uvOf(x, y, size))));
        }
    dilate(out, filled, 4);
    return out;
}

Painted paint(const std::vector<Chart>& charts, const Assembly& assembly, int size, int layerSize) {
    Coverage cover = rasterise(charts, assembly, size);
    Painted out{Picture(size, size), Picture(size, size), {}, {}};
    std::vector<float> relief(cover.chart.size(), 0);
    std::vector<uint8_t> filled(cover.chart.size(), 0);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            size_t at = static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x);
            uint8_t* color = out.color.at(x, y);
            color[3] = 255;
            if (cover.chart[at] < 0) continue;
            size_t c = static_cast<size_t>(cover.chart[at]);
            Detail d = charts[c].detail(assembly.toSt(c, uvOf(x, y, size)));
            for (int k = 0; k < 3; ++k) color[k] = toByte(srgbOfLinear(saturate(d.albedo[k])));
            relief[at] = d.height + d.bump - cover.meshHeight[at];
            filled[at] = 1;
        }
    float texel = assembly.atlasMetres / static_cast<float>(size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            size_t at = static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x);
            auto slope = [&](int dx, int dy) {
                float ends[2], steps = 0;
                for (int side = 0; side < 2; ++side) {
                    int sign = side != 0 ? 1 : -1, nx = x + sign * dx, ny = y + sign * dy;
                    bool inside = nx >= 0 && ny >= 0 && nx < size && ny < size;
                    size_t n =
                        inside ? static_cast<size_t>(ny) * static_cast<size_t>(size) + static_cast<size_t>(nx) : at;
                    bool same = cover.chart[n] == cover.chart[at] && n != at;
                    ends[side] = relief[same ? n : at];
                    steps += same ? 1.0f : 0.0f;
                }
                return steps > 0 ? glm::clamp((ends[1] - ends[0]) / (steps * texel), -1.5f, 1.5f) : 0.0f;
            };
            glm::vec3 n =
                filled[at] != 0 ? glm::normalize(glm::vec3(-slope(1, 0), slope(0, 1), 1)) : glm::vec3(0, 0, 1);
            uint8_t* texelOut = out.normal.at(x, y);
            for (int k = 0; k < 3; ++k) texelOut[k] = toByte(n[k] * 0.5f + 0.5f);
            texelOut[3] = 255;
        }
    dilate(out.color, filled, size / 100);
    dilate(out.normal, filled, size / 100);
    const Coverage layerCover = rasterise(charts, assembly, layerSize);
    out.mask = paintLayer(charts, assembly, layerCover, layerSize, &Chart::mask, 0);
    out.ivy = paintLayer(charts, assembly, layerCover, layerSize, &Chart::ivy, 0.5f);
    return out;
}

}  // namespace espalier::content
