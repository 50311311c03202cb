// In: lines, words, patches of colour. Out: a PNG of them.
#include "tools/bake/canvas.hpp"

#include <stb_easy_font.h>
#include <stb_image_write.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "runtime/core/file.hpp"

namespace espalier {
namespace {

constexpr int kLetter = 2;  // pixels of a stroke of the font

}  // namespace

void Canvas::blend(int x, int y, glm::vec3 color, float alpha) {
    if (x < 0 || y < 0 || x >= int(width_) || y >= int(height_)) return;
    glm::vec3& p = at(uint32_t(x), uint32_t(y));
    p = p * (1 - alpha) + color * alpha;
}

void Canvas::line(glm::vec2 a, glm::vec2 b, glm::vec3 color, float width, float alpha) {
    glm::vec2 low = glm::min(a, b) - glm::vec2(width + 1), high = glm::max(a, b) + glm::vec2(width + 1), d = b - a;
    float length2 = std::max(glm::dot(d, d), 1e-12f);
    bool steep = std::abs(d.y) > std::abs(d.x);
    const int end = int(steep ? height_ : width_) - 1;
    int i0 = std::max(0, int(steep ? low.y : low.x)), i1 = std::min(end, int(steep ? high.y : high.x));
    for (int i = i0; i <= i1; ++i) {
        float t = steep ? (float(i) + 0.5f - a.y) / d.y : (float(i) + 0.5f - a.x) / (d.x == 0 ? 1e-6f : d.x);
        glm::vec2 p = a + d * std::clamp(t, 0.0f, 1.0f);
        int middle = int(steep ? p.x : p.y), reach = int(width * 1.5f) + 2;
        for (int j = middle - reach; j <= middle + reach; ++j) {
            glm::vec2 c =
                steep ? glm::vec2(float(j) + 0.5f, float(i) + 0.5f) : glm::vec2(float(i) + 0.5f, float(j) + 0.5f);
            glm::vec2 away = c - a - d * std::clamp(glm::dot(c - a, d) / length2, 0.0f, 1.0f);
            float cover = std::clamp(width / 2 + 0.5f - glm::length(away), 0.0f, 1.0f);
            if (cover > 0) blend(steep ? j : i, steep ? i : j, color, cover * alpha);
        }
    }
}

void Canvas::fill(int x, int y, int width, int height, glm::vec3 color) {
    for (int j = y; j < y + height; ++j)
        for (int i = x; i < x + width; ++i) blend(i, j, color, 1);
}

void Canvas::text(int x, int y, const char* words, glm::vec3 color) {
    struct Corner {
        float x, y, z;
        uint8_t color[4];
    };
    std::string letters = words;  // the font's interface isn't const
    std::vector<Corner> corners(letters.size() * 80 + 4);
    const int strokes =
        stb_easy_font_print(0, 0, letters.data(), nullptr, corners.data(), int(corners.size() * sizeof(Corner)));
    for (int i = 0; i < strokes; ++i) {
        const Corner &low = corners[size_t(i) * 4], &high = corners[size_t(i) * 4 + 2];
        fill(x + int(low.x) * kLetter, y + int(low.y) * kLetter, int(high.x - low.x) * kLetter,
             int(high.y - low.y) * kLetter, color);
    }
}

int Canvas::textWidth(const char* words) {
    std::string letters = words;
    return stb_easy_font_width(letters.data()) * kLetter;
}

int Canvas::extend(uint32_t rows) {
    const uint32_t before = height_;
    height_ += rows;
    pixels_.resize(size_t(width_) * height_, kGround * 0.6f);
    return int(before);
}

Status Canvas::write(const std::string& path) const {
    std::vector<uint8_t> rgb;
    rgb.reserve(pixels_.size() * 3);
    for (const glm::vec3& p : pixels_)
        for (int k = 0; k < 3; ++k) rgb.push_back(uint8_t(std::clamp(p[k], 0.0f, 1.0f) * 255.0f + 0.5f));
    std::vector<std::byte> file;
    stbi_write_png_to_func(
        [](void* out, void* data, int bytes) {
            auto* from = static_cast<std::byte*>(data);
            auto& to = *static_cast<std::vector<std::byte>*>(out);
            to.insert(to.end(), from, from + bytes);
        },
        &file, int(width_), int(height_), 3, rgb.data(), int(width_) * 3);
    return writeFile(path, file);
}

}  // namespace espalier
