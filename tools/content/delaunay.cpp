// Incremental Delaunay triangulation (Bowyer and Watson): walk to the triangle that holds the point, grow the
// cavity of circles that hold it, connect its rim. In: points. Out: counter-clockwise triangles.

#include "tools/content/delaunay.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

struct Triangle {
    std::array<uint32_t, 3> v;
    std::array<int, 3> across;  // the neighbour over the edge v[i] v[i + 1], -1: none
    bool alive = true;
};

double area2(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inCircle(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 p) {
    a -= p;
    b -= p;
    c -= p;
    double da = glm::dot(a, a), db = glm::dot(b, b), dc = glm::dot(c, c);
    return a.x * (b.y * dc - db * c.y) - a.y * (b.x * dc - db * c.x) + da * (b.x * c.y - b.y * c.x) > 0;
}

class Triangulator {
  public:
    explicit Triangulator(const std::vector<glm::dvec2>& points) : points_(points), count_(points.size()) {
        glm::dvec2 low = points[0], high = points[0];
        for (auto& p : points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        double extent = std::max(high.x - low.x, high.y - low.y);
        for (uint32_t i = 0; i < count_; ++i)
            points_[i] += (glm::dvec2(random01(i, 11), random01(i, 12)) - 0.5) * (2e-7 * extent);
        glm::dvec2 middle = (low + high) * 0.5;
        points_.push_back(middle + glm::dvec2(-30, -20) * extent);
        points_.push_back(middle + glm::dvec2(30, -20) * extent);
        points_.push_back(middle + glm::dvec2(0, 40) * extent);
        uint32_t n = static_cast<uint32_t>(count_);
        triangles_.push_back({{n, n + 1, n + 2}, {-1, -1, -1}});
        cell_ = extent / std::max(1.0, std::sqrt(static_cast<double>(count_)) / 2);
    }

    std::vector<std::array<uint32_t, 3>> run() {
        for (uint32_t i : order()) insert(i);
        std::vector<std::array<uint32_t, 3>> out;
        for (auto& t : triangles_)
            if (t.alive && t.v[0] < count_ && t.v[1] < count_ && t.v[2] < count_) out.push_back(t.v);
        return out;
    }

  private:
    // Rows of cells, back and forth, so that each walk is short.
    std::vector<uint32_t> order() const {
        std::vector<uint32_t> ids(count_);
        std::iota(ids.begin(), ids.end(), 0u);
        auto key = [&](uint32_t i) {
            long row = std::lround(std::floor(points_[i].y / cell_));
            return std::pair(row, (row & 1) != 0 ? -points_[i].x : points_[i].x);
        };
        std::stable_sort(ids.begin(), ids.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
        return ids;
    }

    int locate(glm::dvec2 p) const {
        int at = last_;
        for (size_t steps = 0; steps < triangles_.size() * 2 + 8; ++steps) {
            const Triangle& t = triangles_[static_cast<size_t>(at)];
            int next = -1;
            for (size_t e = 0; e < 3 && next < 0; ++e)
                if (area2(points_[t.v[e]], points_[t.v[(e + 1) % 3]], p) < 0) next = t.across[e];
            if (next < 0) return at;
            at = next;
        }
        assert(!"the walk to a triangle does not end");
        return at;
    }

    void insert(uint32_t i) {
        glm::dvec2 p = points_[i];
        std::vector<int> cavity{locate(p)};
        triangles_[static_cast<size_t>(cavity[0])].alive = false;
        struct Rim {
            uint32_t a, b;
            int outside;
        };
        std::vector<Rim> rim;
        for (size_t k = 0; k < cavity.size(); ++k) {
            Triangle t = triangles_[static_cast<size_t>(cavity[k])];
            for (size_t e = 0; e < 3; ++e) {
                int n = t.across[e];
                if (n >= 0 && !triangles_[static_cast<size_t>(n)].alive) continue;
                if (n >= 0) {
                    Triangle& o = triangles_[static_cast<size_t>(n)];
                    if (inCircle(points_[o.v[0]], points_[o.v[1]], points_[o.v[2]], p)) {
                        o.alive = false;
                        cavity.push_back(n);
                        continue;
                    }
                }
                rim.push_back({t.v[e], t.v[(e + 1) % 3], n});
            }
        }
        // A rim edge recorded before its neighbour joined the cavity is no rim.
        std::erase_if(
            rim, [&](const Rim& r) { return r.outside >= 0 && !triangles_[static_cast<size_t>(r.outside)].alive; });
        int first = static_cast<int>(triangles_.size());
        for (const Rim& r : rim) {
            int id = static_cast<int>(triangles_.size());
            triangles_.push_back({{r.a, r.b, i}, {r.outside, -1, -1}});
            if (r.outside < 0) continue;
            Triangle& o = triangles_[static_cast<size_t>(r.outside)];
            for (size_t e = 0; e < 3; ++e)
                if (o.v[e] == r.b && o.v[(e + 1) % 3] == r.a) o.across[e] = id;
        }
        for (size_t k = 0; k < rim.size(); ++k)
            for (size_t l = 0; l < rim.size(); ++l)
                if (rim[k].b == rim[l].a) {
                    triangles_[static_cast<size_t>(first) + k].across[1] = first + static_cast<int>(l);
                    triangles_[static_cast<size_t>(first) + l].across[2] = first + static_cast<int>(k);
                }
        last_ = first;
    }

    std::vector<glm::dvec2> points_;
    size_t count_;
    std::vector<Triangle> triangles_;
    double cell_ = 1;
    int last_ = 0;
};

}  // namespace

std::vector<std::array<uint32_t, 3>> delaunay(const std::vector<glm::dvec2>& points) {
    assert(points.size() >= 3);
    return Triangulator(points).run();
}

bool insideLoops(const std::vector<std::vector<glm::dvec2>>& loops, glm::dvec2 p) {
    bool inside = false;
    for (auto& loop : loops)
        for (size_t i = 0, j = loop.size() - 1; i < loop.size(); j = i++) {
            glm::dvec2 a = loop[i], b = loop[j];
            if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) inside = !inside;
        }
    return inside;
}

}  // namespace espalier::content
