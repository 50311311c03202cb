#pragma once

// A picture to draw on, for tools/bake/pictures.cpp: smooth lines, words and patches of colour over a dark ground.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"

namespace espalier {

class Canvas {
  public:
    explicit Canvas(uint32_t size) : width_(size), height_(size), pixels_(size_t(size) * size, kGround) {}
    uint32_t size() const { return width_; }
    glm::vec3& at(uint32_t x, uint32_t y) { return pixels_[size_t(y) * width_ + x]; }
    void blend(int x, int y, glm::vec3 color, float alpha);
    // A smooth line; a and b in pixels.
    void line(glm::vec2 a, glm::vec2 b, glm::vec3 color, float width, float alpha);
    void fill(int x, int y, int width, int height, glm::vec3 color);
    // Letters are 14 pixels high.
    void text(int x, int y, const char* words, glm::vec3 color);
    static int textWidth(const char* words);
    // Makes room below; returns the row where it begins.
    int extend(uint32_t rows);
    Status write(const std::string& path) const;

  private:
    static constexpr glm::vec3 kGround{0.11f, 0.115f, 0.13f};
    uint32_t width_, height_;
    std::vector<glm::vec3> pixels_;
};

}  // namespace espalier
