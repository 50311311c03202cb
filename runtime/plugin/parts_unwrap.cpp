// In: a mesh. Out: places for its vertices on a square of their own, none upon another: sides are found, laid flat
// along the axis that they face, and packed in rows.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/parts.hpp"

namespace espalier {
namespace {

using Flat = std::array<glm::vec2, 3>;

// Which of six ways a triangle faces: twice the axis, and 1 if against it.
uint32_t facingOf(glm::vec3 across) {
    const glm::vec3 size = glm::abs(across);
    const uint32_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return 2 * axis + (across[int(axis)] < 0 ? 1 : 0);
}

glm::vec2 flattened(glm::vec3 p, uint32_t facing) {
    const glm::vec2 flat = facing / 2 == 0   ? glm::vec2(-p.z, p.y)
                           : facing / 2 == 1 ? glm::vec2(p.x, -p.z)
                                             : glm::vec2(p);
    return facing % 2 ? glm::vec2(-flat.x, flat.y) : flat;
}

// Which side of the line from a to b a point is on: above 0 inside, as triangles that are laid flat turn.
double sideOf(glm::vec2 a, glm::vec2 b, glm::vec2 p) {
    const glm::dvec2 side = glm::dvec2(b) - glm::dvec2(a), to = glm::dvec2(p) - glm::dvec2(a);
    return side.x * to.y - side.y * to.x;
}

// Whether the insides of both meet: no side of either has the other beyond it.
bool overlap(const Flat& a, const Flat& b) {
    for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
        for (size_t i = 0; i < 3; ++i)
            if (std::ranges::all_of(*other, [&, &corners = *one](glm::vec2 p) {
                    return sideOf(corners[i], corners[(i + 1) % 3], p) <= 0;
                }))
                return false;
    return true;
}

class Unwrapping {
  public:
    Unwrapping(PartLevel& level, bool textured) : level_(level), textured_(textured) {}

    void run() {
        findCharts();
        for (uint32_t chart = 0, known = chartCount_; chart < known; ++chart) takeApart(chart);
        place();
    }

  private:
    size_t triangles() const { return level_.indices.size() / 3; }
    uint32_t corner(size_t t, uint32_t k) const { return level_.indices[3 * t + k]; }

    // Triangles that face one way and share places.
    void findCharts() {
        std::map<std::array<float, 3>, uint32_t> places;
        std::vector<uint32_t> placeOf(level_.vertices.size());
        for (size_t i = 0; i < placeOf.size(); ++i) {
            const auto& p = level_.vertices[i].position;
            placeOf[i] = places.try_emplace({p[0], p[1], p[2]}, uint32_t(places.size())).first->second;
        }
        DisjointSets sets(triangles());
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> seen;  // place and facing: a triangle there
        for (size_t t = 0; t < triangles(); ++t) {
            const glm::vec3 a = vec(level_.vertices[corner(t, 0)].position),
                            b = vec(level_.vertices[corner(t, 1)].position),
                            c = vec(level_.vertices[corner(t, 2)].position);
            facing_.push_back(facingOf(glm::cross(b - a, c - a)));
            for (uint32_t k = 0; k < 3; ++k) {
                const auto [known, added] = seen.try_emplace({placeOf[corner(t, k)], facing_.back()}, uint32_t(t));
                if (!added) sets.join(known->second, uint32_t(t));
            }
        }
        chartCount_ = sets.number(chartOf_);
        members_.resize(chartCount_);
        for (size_t t = 0; t < triangles(); ++t) members_[chartOf_[t]].push_back(uint32_t(t));
    }

    Flat flat(uint32_t t) const {
        Flat f;
        for (uint32_t k = 0; k < 3; ++k) f[k] = flattened(vec(level_.vertices[corner(t, k)].position), facing_[t]);
        return f;
    }

    // What would lie on other triangles of its chart becomes a chart by itself.
    void takeApart(uint32_t chart) {
        std::vector<Flat> lying;
        std::vector<uint32_t> kept;
        for (uint32_t t : members_[chart]) {
            const Flat f = flat(t);
            const bool free = std::ranges::none_of(lying, [&](const Flat& other) { return overlap(f, other); });
            if (free) {
                lying.push_back(f);
                kept.push_back(t);
            } else {
                chartOf_[t] = chartCount_++;
                members_.push_back({t});
            }
        }
        members_[chart] = std::move(kept);
    }

    void place() {
        std::vector<glm::vec2> lows(chartCount_, glm::vec2(1e30f)), highs(chartCount_, glm::vec2(-1e30f));
        for (uint32_t t = 0; t < triangles(); ++t)
            for (const glm::vec2& p : flat(t)) {
                lows[chartOf_[t]] = glm::min(lows[chartOf_[t]], p);
                highs[chartOf_[t]] = glm::max(highs[chartOf_[t]], p);
            }
        std::vector<glm::vec2> sizes(chartCount_);
        for (uint32_t i = 0; i < chartCount_; ++i) sizes[i] = highs[i] - lows[i];
        const Packing packing = packed(sizes);
        std::map<std::pair<uint32_t, uint32_t>, uint32_t> copies;  // vertex and chart
        std::vector<EspPartVertex> vertices;
        for (uint32_t t = 0; t < triangles(); ++t) {
            const Flat f = flat(t);
            for (uint32_t k = 0; k < 3; ++k) {
                uint32_t& index = level_.indices[3 * t + k];
                const auto [known, added] = copies.try_emplace({index, chartOf_[t]}, uint32_t(vertices.size()));
                if (added) {
                    EspPartVertex v = level_.vertices[index];
                    const glm::vec2 own = (packing.places[chartOf_[t]] + f[k] - lows[chartOf_[t]]) / packing.size;
                    v.uv2[0] = std::clamp(own.x, 0.0f, 1.0f);
                    v.uv2[1] = std::clamp(own.y, 0.0f, 1.0f);
                    if (!textured_) v.uv[0] = f[k].x, v.uv[1] = -f[k].y;
                    vertices.push_back(v);
                }
                index = known->second;
            }
        }
        level_.vertices = std::move(vertices);
    }

    PartLevel& level_;
    bool textured_;
    std::vector<uint32_t> facing_, chartOf_;
    uint32_t chartCount_ = 0;
    std::vector<std::vector<uint32_t>> members_;
};

}  // namespace

Packing packed(const std::vector<glm::vec2>& sizes) {
    Packing out;
    out.places.resize(sizes.size());
    double area = 0;
    glm::vec2 largest(1e-6f);
    for (const glm::vec2& s : sizes) area += double(s.x) * double(s.y), largest = glm::max(largest, s);
    const float side = std::max(float(std::sqrt(area)) * 1.1f, largest.x);
    const float gap = side / 2048;
    std::vector<uint32_t> order(sizes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(
        order, [&](uint32_t a, uint32_t b) { return sizes[a].y != sizes[b].y ? sizes[a].y > sizes[b].y : a < b; });
    glm::vec2 pen(gap);
    float row = 0;
    for (uint32_t i : order) {
        if (pen.x + sizes[i].x > side + gap && pen.x > gap) pen = {gap, pen.y + row + gap}, row = 0;
        out.places[i] = pen;
        pen.x += sizes[i].x + gap;
        row = std::max(row, sizes[i].y);
    }
    // A row's height may be nothing, yet no two pieces lie at one place.
    out.size = glm::vec2(side + 2 * gap, std::max(pen.y + row + gap, 1e-6f));
    return out;
}

void unwrap(PartLevel& level, bool textured) {
    Unwrapping(level, textured).run();
}

}  // namespace espalier
