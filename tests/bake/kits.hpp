#pragma once

// Models put together from boxes and sheets, each face a chart of its own, and walks over what is baked of them.

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "shaders/shared/walk.h"
#include "tools/bake/bake.hpp"

namespace espalier::test {

// A rectangle: corner, and its two sides; outward is right × up.
struct Panel {
    glm::dvec3 corner, right, up;
    glm::dvec3 at(double s, double t) const { return corner + right * s + up * t; }
    glm::dvec3 normal() const { return glm::normalize(glm::cross(right, up)); }
};

class Kit {
  public:
    // Returns the panel's number.
    int panel(glm::dvec3 corner, glm::dvec3 right, glm::dvec3 up) {
        panels_.push_back({corner, right, up});
        return int(panels_.size()) - 1;
    }
    // Around `middle`, half-sides along the columns of `axes` (right-handed). Returns the first of its panels: +x, -x,
    // +y, -y, +z, -z; without its floor, -y is missing.
    int box(glm::dvec3 middle, glm::dmat3 axes, bool floor = true) {
        int first = int(panels_.size());
        for (int k = 0; k < 3; ++k)
            for (double sign : {1.0, -1.0}) {
                if (k == 1 && sign < 0 && !floor) continue;
                glm::dvec3 n = axes[k] * sign, a = axes[(k + 1) % 3], b = axes[(k + 2) % 3];
                if (sign < 0) std::swap(a, b);
                panel(middle + n - a - b, a * 2.0, b * 2.0);
            }
        return first;
    }
    int box(glm::dvec3 middle, glm::dvec3 half, bool floor = true) {
        return box(middle, glm::dmat3(half.x, 0, 0, 0, half.y, 0, 0, 0, half.z), floor);
    }

    const Panel& operator[](int i) const { return panels_[size_t(i)]; }
    int count() const { return int(panels_.size()); }

    glm::dvec2 uv(int i, double s, double t) const {
        int side = cells();
        const Panel& p = panels_[size_t(i)];
        double size = 0;
        for (const Panel& q : panels_) size = std::max({size, glm::length(q.right), glm::length(q.up)});
        glm::dvec2 corner(double(i % side) + 0.06, double(i / side) + 0.06);
        return (corner + glm::dvec2(s * glm::length(p.right), t * glm::length(p.up)) * (0.88 / size)) / double(side);
    }

    // Each panel of two triangles; `flipped`: panels wound the other way.
    Model model(const std::vector<int>& flipped = {}) const {
        Model m;
        m.name = "kit";
        for (int i = 0; i < count(); ++i) {
            uint32_t base = uint32_t(m.positions.size());
            for (int k = 0; k < 4; ++k) {
                double s = k & 1, t = k >> 1;
                m.positions.push_back(glm::vec3(panels_[size_t(i)].at(s, t)));
                m.uvs.push_back(glm::vec2(uv(i, s, t)));
            }
            bool flip = std::find(flipped.begin(), flipped.end(), i) != flipped.end();
            for (uint32_t v : {0u, 1u, 3u, 0u, 3u, 2u}) m.indices.push_back(base + v);
            if (flip)
                for (size_t k = m.indices.size() - 6; k < m.indices.size(); k += 3)
                    std::swap(m.indices[k], m.indices[k + 1]);
        }
        return m;
    }

    Baked bake(uint32_t resolution = 512, const std::vector<int>& flipped = {}) const {
        BakeOptions options;
        options.resolution = resolution;
        options.levels = 2;
        options.keepLayout = true;
        auto result = espalier::bake(model(flipped), options);
        if (!result) throw std::runtime_error(result.failure().text());
        return std::move(*result);
    }

  private:
    int cells() const { return int(std::ceil(std::sqrt(double(panels_.size())))); }
    std::vector<Panel> panels_;
};

// m² of a model's ground, in all of its pieces.
inline double groundOf(const BakeReport& report) {
    double sum = 0;
    for (const PieceReach& p : report.pieces) sum += p.area;
    return sum;
}

// A walk over a baked kit.
class Stroll {
  public:
    explicit Stroll(const SurfaceData& data) : ref_(surfaceRef(data)) {}
    Stroll(const Stroll&) = delete;

    bool start(const Kit& kit, int panel, double s, double t, glm::dvec3 direction, uint32_t level = 0) {
        level_ = level;
        const SurfaceBuf surfaces{&ref_};
        return startWalk(surfaces, level, chartOf(kit, panel, s, t), glm::vec2(kit.uv(panel, s, t)),
                         glm::vec3(direction), w);
    }
    // Records samples; returns the last event.
    uint32_t go(double length) {
        float remaining = float(length);
        uint32_t event = kWalkRetry;
        const SurfaceBuf surfaces{&ref_};
        while (walkGoesOn(event)) {
            glm::vec3 jointNormal;
            event = walkAdvance(surfaces, level_, w, remaining, jointNormal);
            if (walkHasSample(event)) samples.push_back(w.position);
        }
        return event;
    }
    void turnBack() { w.walk.direction = -w.walk.direction; }

    WalkState w{};
    std::vector<glm::vec3> samples;

  private:
    uint32_t chartOf(const Kit& kit, int panel, double s, double t) const {
        const SurfaceLevel& level = ref_.levels[0];
        return texelChart(level.texels.v[texelAt(level.size, glm::vec2(kit.uv(panel, s, t)))].bits);
    }
    SurfaceRef ref_;
    uint32_t level_ = 0;
};

}  // namespace espalier::test
