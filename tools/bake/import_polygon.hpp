#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace espalier::import {

// A set of numbers below a fixed count, which can be counted and picked by rank in about log n steps (a Fenwick tree).
class RankedSet {
  public:
    // All numbers below `count`.
    void fill(size_t count);
    void insert(uint32_t number);
    void erase(uint32_t number);
    bool has(uint32_t number) const { return has_[number] != 0; }
    uint32_t size() const { return size_; }
    uint32_t below(uint32_t number) const;  // how many there are below it
    uint32_t at(uint32_t rank) const;       // the one that has so many below it

  private:
    void add(uint32_t number, uint32_t by);
    std::vector<uint32_t> sums_;
    std::vector<uint8_t> has_;
    uint32_t size_ = 0;
};

// Points of the plane that are taken away one by one, in a balanced tree of boxes.
class PointTree {
  public:
    void build(const std::vector<glm::dvec2>& points);
    void erase(uint32_t point);
    // A point that lies in the triangle or on its border and isn't in the place of one of its corners; kNone: there is
    // none. Corners are counter-clockwise.
    uint32_t findIn(const glm::dvec2 (&corners)[3]) const;
    static constexpr uint32_t kNone = ~0u;

  private:
    struct Node {
        glm::dvec2 low{1e300}, high{-1e300};
        uint32_t first = 0, last = 0, left = 0;  // of order_; how many of these points are left
    };
    void build(size_t node, uint32_t first, uint32_t last);
    uint32_t findIn(size_t node, const glm::dvec2 (&corners)[3]) const;
    const std::vector<glm::dvec2>* points_ = nullptr;
    std::vector<Node> nodes_;  // the children of i are 2 i + 1 and 2 i + 2
    std::vector<uint32_t> order_, leafOf_;
    std::vector<uint8_t> gone_;
};

// Fills polygons with triangles: cuts ears in the polygon's mean plane (Newell's normal), so that concave ones are
// filled right. Of any number of corners, in about n log n steps. A polygon that crosses itself gets n - 2 triangles,
// too.
class Triangulator {
  public:
    // Appends the triangles of a polygon of three corners or more, which are indices of `positions`.
    void fill(const std::vector<glm::vec3>& positions, std::span<const uint32_t> polygon,
              std::vector<uint32_t>& triangles);

  private:
    void flatten(const std::vector<glm::vec3>& positions, std::span<const uint32_t> polygon);
    void begin();
    uint32_t nextEar(size_t& at);
    bool isEar(uint32_t corner);
    void cut(uint32_t corner);

    // Kept from one polygon to the next: most are small.
    std::vector<glm::dvec2> flat_;
    std::vector<uint32_t> before_, after_;
    RankedSet left_, doubtful_;  // corners that are left; those of them that may be ears or are
    PointTree points_;           // of the corners that are left
    std::vector<uint8_t> isEar_;
    // Corner v waits for waitsFor[v] to go: until then that one lies in its ear.
    struct Waiting {
        uint32_t corner, next;
    };
    std::vector<uint32_t> firstWaiting_;
    std::vector<Waiting> waiting_;
};

}  // namespace espalier::import
