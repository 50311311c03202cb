// A z-buffer rasteriser with one shadow map. In: meshes with textures and a view. Out: a picture, four samples a
// pixel.

#include "tools/content/preview.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "runtime/core/srgb.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

glm::vec4 sample(const Picture& picture, glm::vec2 uv, bool repeat) {
    glm::vec2 p = uv * glm::vec2(picture.width, picture.height) - 0.5f;
    glm::vec2 base = glm::floor(p), f = p - base;
    auto fetch = [&](int dx, int dy) {
        int x = static_cast<int>(base.x) + dx, y = static_cast<int>(base.y) + dy;
        if (repeat) {
            x = ((x % picture.width) + picture.width) % picture.width;
            y = ((y % picture.height) + picture.height) % picture.height;
        }
        const uint8_t* c = picture.at(std::clamp(x, 0, picture.width - 1), std::clamp(y, 0, picture.height - 1));
        return glm::vec4(c[0], c[1], c[2], c[3]) / 255.0f;
    };
    return glm::mix(glm::mix(fetch(0, 0), fetch(1, 0), f.x), glm::mix(fetch(0, 1), fetch(1, 1), f.x), f.y);
}

struct Corner {
    glm::vec4 clip;
    glm::vec3 world, normal, tangent, bitangent;
    glm::vec2 uv;
};

// Calls pixel(x, y, depth, weights with perspective) for each covered sample of a triangle.
template <class Pixel>
void rasterise(const Corner* c, int width, int height, Pixel&& pixel) {
    glm::vec3 p[3];
    for (int k = 0; k < 3; ++k) {
        if (c[k].clip.w < 0.05f) return;
        p[k] = {(c[k].clip.x / c[k].clip.w * 0.5f + 0.5f) * static_cast<float>(width),
                (0.5f - c[k].clip.y / c[k].clip.w * 0.5f) * static_cast<float>(height), c[k].clip.z / c[k].clip.w};
    }
    float area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[1].y - p[0].y) * (p[2].x - p[0].x);
    if (area == 0) return;
    int x0 = std::max(0, static_cast<int>(std::min({p[0].x, p[1].x, p[2].x}))),
        x1 = std::min(width - 1, static_cast<int>(std::max({p[0].x, p[1].x, p[2].x})));
    int y0 = std::max(0, static_cast<int>(std::min({p[0].y, p[1].y, p[2].y}))),
        y1 = std::min(height - 1, static_cast<int>(std::max({p[0].y, p[1].y, p[2].y})));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            float qx = static_cast<float>(x) + 0.5f, qy = static_cast<float>(y) + 0.5f;
            float w1 = ((qx - p[0].x) * (p[2].y - p[0].y) - (qy - p[0].y) * (p[2].x - p[0].x)) / area;
            float w2 = ((p[1].x - p[0].x) * (qy - p[0].y) - (p[1].y - p[0].y) * (qx - p[0].x)) / area;
            float w0 = 1 - w1 - w2;
            if (w0 < 0 || w1 < 0 || w2 < 0) continue;
            glm::vec3 w(w0 / c[0].clip.w, w1 / c[1].clip.w, w2 / c[2].clip.w);
            pixel(x, y, p[0].z * w0 + p[1].z * w1 + p[2].z * w2, w / (w.x + w.y + w.z));
        }
}

template <class Triangle>
void eachTriangle(const std::vector<PreviewItem>& items, const glm::mat4& toClip, Triangle&& triangle) {
    for (auto& item : items) {
        const Mesh& m = *item.mesh;
        for (size_t i = 0; i + 2 < m.indices.size(); i += 3) {
            Corner c[3];
            for (size_t k = 0; k < 3; ++k) {
                uint32_t v = m.indices[i + k];
                glm::vec4 world = item.place * glm::vec4(m.positions[v], 1);
                c[k].world = world;
                c[k].clip = toClip * world;
                c[k].normal = glm::mat3(item.place) * m.normals[v];
                c[k].uv = m.uvs[v];
            }
            glm::vec3 e1 = c[1].world - c[0].world, e2 = c[2].world - c[0].world;
            glm::vec2 d1 = c[1].uv - c[0].uv, d2 = c[2].uv - c[0].uv;
            float det = d1.x * d2.y - d2.x * d1.y;
            float r = std::abs(det) > 1e-12f ? 1 / det : 0;
            for (auto& corner : c) {
                corner.tangent = (e1 * d2.y - e2 * d1.y) * r;
                corner.bitangent = -(e2 * d1.x - e1 * d2.x) * r;  // up in the picture
            }
            triangle(item, c);
        }
    }
}

}  // namespace

Picture preview(const std::vector<PreviewItem>& items, const PreviewView& view) {
    constexpr int kShadow = 2048;
    glm::vec3 sun = glm::normalize(view.toSun);
    float reach = glm::distance(view.eye, view.target) * 1.2f;
    glm::mat4 toSun = glm::ortho(-reach, reach, -reach, reach, -3 * reach, 3 * reach) *
                      glm::lookAt(view.target + sun, view.target, glm::vec3(0.01f, 1, 0.02f));
    std::vector<float> shadow(static_cast<size_t>(kShadow) * kShadow, 1e9f);
    if (view.shadows)
        eachTriangle(items, toSun, [&](const PreviewItem& item, const Corner* c) {
            rasterise(c, kShadow, kShadow, [&](int x, int y, float depth, glm::vec3 w) {
                if (sample(*item.color, c[0].uv * w.x + c[1].uv * w.y + c[2].uv * w.z, item.repeat).a < 0.5f) return;
                float& s = shadow[static_cast<size_t>(y) * kShadow + static_cast<size_t>(x)];
                s = std::min(s, depth);
            });
        });
    int width = view.width * 2, height = view.height * 2;
    std::vector<float> depths(static_cast<size_t>(width) * static_cast<size_t>(height), 1e9f);
    std::vector<glm::vec3> colors(depths.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            colors[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
                glm::mix(glm::vec3(0.42f, 0.55f, 0.72f), glm::vec3(0.75f, 0.80f, 0.84f),
                         static_cast<float>(y) / static_cast<float>(height));
    glm::mat4 toClip =
        glm::perspective(glm::radians(view.fovDegrees),
                         static_cast<float>(view.width) / static_cast<float>(view.height), 0.05f, 100.0f) *
        glm::lookAt(view.eye, view.target, glm::vec3(0, 1, 0));
    eachTriangle(items, toClip, [&](const PreviewItem& item, const Corner* c) {
        rasterise(c, width, height, [&](int x, int y, float depth, glm::vec3 w) {
            size_t at = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
            if (depth >= depths[at]) return;
            glm::vec2 uv = c[0].uv * w.x + c[1].uv * w.y + c[2].uv * w.z;
            glm::vec4 texel = sample(*item.color, uv, item.repeat);
            if (texel.a < 0.5f) return;
            depths[at] = depth;
            glm::vec3 world = c[0].world * w.x + c[1].world * w.y + c[2].world * w.z;
            glm::vec3 n = glm::normalize(c[0].normal * w.x + c[1].normal * w.y + c[2].normal * w.z);
            glm::vec3 flat = glm::cross(c[1].world - c[0].world, c[2].world - c[0].world);
            float facing = glm::dot(flat, view.eye - world) < 0 ? -1.0f : 1.0f;
            if (item.normal != nullptr && glm::length(c[0].tangent) > 0) {
                glm::vec3 d = glm::vec3(sample(*item.normal, uv, item.repeat)) * 2.0f - 1.0f;
                glm::vec3 t = glm::normalize(c[0].tangent - n * glm::dot(n, c[0].tangent));
                glm::vec3 b = glm::cross(n, t);
                if (glm::dot(b, c[0].bitangent) < 0) b = -b;
                n = glm::normalize(t * d.x + b * d.y + n * d.z);
            }
            n *= facing;
            glm::vec4 s = toSun * glm::vec4(world + n * 0.02f, 1);
            int sx = static_cast<int>((s.x * 0.5f + 0.5f) * kShadow),
                sy = static_cast<int>((0.5f - s.y * 0.5f) * kShadow);
            bool inMap = view.shadows && sx >= 0 && sy >= 0 && sx < kShadow && sy < kShadow;
            float lit = inMap && shadow[static_cast<size_t>(sy) * kShadow + static_cast<size_t>(sx)] < s.z - 0.002f
                            ? 0.0f
                            : 1.0f;
            glm::vec3 light =
                glm::vec3(2.0f, 1.8f, 1.5f) * std::max(glm::dot(n, sun), 0.0f) * lit +
                glm::mix(glm::vec3(0.16f, 0.14f, 0.12f), glm::vec3(0.38f, 0.45f, 0.56f), n.y * 0.5f + 0.5f);
            glm::vec3 color = glm::pow(glm::vec3(texel), glm::vec3(2.2f)) * light;
            colors[at] = color / (color + 0.65f) * 1.35f;
        });
    });
    Picture out(view.width, view.height);
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            glm::vec3 sum(0);
            for (int k = 0; k < 4; ++k)
                sum += colors[static_cast<size_t>(2 * y + k / 2) * static_cast<size_t>(width) +
                              static_cast<size_t>(2 * x + k % 2)];
            for (int k = 0; k < 3; ++k)
                out.at(x, y)[k] =
                    static_cast<uint8_t>(saturate(srgbOfLinear(saturate(sum[k] * 0.25f))) * 255.0f + 0.5f);
            out.at(x, y)[3] = 255;
        }
    return out;
}

}  // namespace espalier::content
