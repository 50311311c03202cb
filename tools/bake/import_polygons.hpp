#pragma once

// What readers of polygons share: a model whose vertices and faces are collected before it is known where it lies.

#include <limits>
#include <map>
#include <unordered_map>

#include "tools/bake/import.hpp"

namespace espalier::import {

// Of a UV or a colour that a vertex doesn't have.
inline constexpr float kNotGiven = std::numeric_limits<float>::quiet_NaN();

// A face's corner: the position, UV and normal that it names, counted from 0; -1: none. Corners of unlike variants are
// different vertices though they name the same.
struct Corner {
    int64_t position = -1, uv = -1, normal = -1;
    uint32_t variant = 0;
    bool operator==(const Corner&) const = default;
};
struct CornerHash {
    size_t operator()(const Corner& c) const {
        return size_t((uint64_t(c.position) * 0x9E3779B97F4A7C15ull ^ uint64_t(c.uv)) * 0xD1B54A32D192ED03ull ^
                      uint64_t(c.normal) * 0x94D049BB133111EBull ^ uint64_t(c.variant) * 0xBF58476D1CE4E5B9ull);
    }
};
// The vertex of each combination.
using CornerVertices = std::unordered_map<Corner, uint32_t, CornerHash>;

// Faces as a file states them.
class Polygons {
  public:
    // Corners are vertices; three or more.
    void add(std::span<const uint32_t> corners, uint32_t material);
    bool empty() const { return sizes_.empty(); }
    // Each corner of each face.
    std::span<const uint32_t> corners() const { return corners_; }
    // Appends them to the model as triangles, by its positions.
    void fill(Model& model) const;

  private:
    std::vector<uint32_t> corners_, sizes_, materials_;
};

// Blemishes that a model can do without: each kind is told once, with its first place and how many there are.
class Blemishes {
  public:
    explicit Blemishes(const std::string& path) : path_(path) {}
    // line: 0 where there is none.
    void note(const std::string& what, int line = 0);
    void tell(Model& model) const;

  private:
    struct Kind {
        int line = 0;
        size_t count = 0;
    };
    std::string path_;
    std::map<std::string, Kind> kinds_;
};

constexpr double kMostMetres = 1e18;  // a position farther from the origin is none
inline bool isPlace(const glm::dvec3& p) {
    return std::abs(p.x) < kMostMetres && std::abs(p.y) < kMostMetres && std::abs(p.z) < kMostMetres;
}

// Vertex colours as files of polygons have them, 0 to 1 or 0 to 255, by sRGB's curve: makes model.colours linear.
// Vertices whose colour is not a number are white. Colours that are all white are none.
void makeColoursLinear(Model& model);

}  // namespace espalier::import
