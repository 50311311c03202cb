// Charts from flat regions and from grids. In: border loops with candidate points, or a grid's points.
// Out: a chart's vertices and counter-clockwise triangles in st; block and normal of planar charts are
// filled by the caller.

#include <cmath>
#include <unordered_map>

#include "tools/content/delaunay.hpp"
#include "tools/content/model.hpp"

namespace espalier::content {
namespace {

// Accepted points by cells of a grid.
class Neighbours {
  public:
    explicit Neighbours(float cell) : cell_(cell) {}

    void add(glm::vec2 p, int rank) { cells_[key(p, 0, 0)].push_back({p, rank}); }

    bool free(glm::vec2 p, int rank, float spacing, float clear) const {
        int reach = static_cast<int>(std::ceil(std::max(spacing, clear) / cell_));
        for (int dy = -reach; dy <= reach; ++dy)
            for (int dx = -reach; dx <= reach; ++dx) {
                auto found = cells_.find(key(p, dx, dy));
                if (found == cells_.end()) continue;
                for (auto& e : found->second)
                    if (glm::distance(e.p, p) < (e.rank == rank ? spacing : clear)) return false;
            }
        return true;
    }

  private:
    struct Entry {
        glm::vec2 p;
        int rank;
    };
    uint64_t key(glm::vec2 p, int dx, int dy) const {
        auto x = static_cast<int32_t>(std::floor(p.x / cell_)) + dx,
             y = static_cast<int32_t>(std::floor(p.y / cell_)) + dy;
        return (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(y);
    }
    float cell_;
    std::unordered_map<uint64_t, std::vector<Entry>> cells_;
};

// Border edges stay edges of the triangulation when no point is inside their circle.
class BorderCircles {
  public:
    void add(glm::vec2 a, glm::vec2 b) {
        float r = glm::distance(a, b) * 0.5f;
        circles_.push_back({(a + b) * 0.5f, r * 1.02f + 1e-4f});
        largest_ = std::max(largest_, circles_.back().radius);
    }
    void index() {
        for (size_t i = 0; i < circles_.size(); ++i) grid_[key(circles_[i].centre, 0, 0)].push_back(i);
    }
    bool contain(glm::vec2 p) const {
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                auto found = grid_.find(key(p, dx, dy));
                if (found == grid_.end()) continue;
                for (size_t i : found->second)
                    if (glm::distance(circles_[i].centre, p) < circles_[i].radius) return true;
            }
        return false;
    }

  private:
    struct Circle {
        glm::vec2 centre;
        float radius;
    };
    uint64_t key(glm::vec2 p, int dx, int dy) const {
        auto x = static_cast<int32_t>(std::floor(p.x / largest_)) + dx,
             y = static_cast<int32_t>(std::floor(p.y / largest_)) + dy;
        return (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(y);
    }
    std::vector<Circle> circles_;
    std::unordered_map<uint64_t, std::vector<size_t>> grid_;
    float largest_ = 1e-3f;
};

}  // namespace

void triangulate(Chart& chart, const std::vector<std::vector<glm::vec2>>& loops,
                 const std::vector<Candidates>& candidates) {
    std::vector<std::vector<glm::dvec2>> exact;
    Neighbours neighbours(0.04f);
    BorderCircles circles;
    for (auto& loop : loops) {
        exact.emplace_back(loop.begin(), loop.end());
        for (size_t i = 0; i < loop.size(); ++i) {
            chart.st.push_back(loop[i]);
            neighbours.add(loop[i], -1);
            circles.add(loop[i], loop[(i + 1) % loop.size()]);
        }
    }
    circles.index();
    for (size_t rank = 0; rank < candidates.size(); ++rank)
        for (glm::vec2 p : candidates[rank].points) {
            if (!neighbours.free(p, static_cast<int>(rank), candidates[rank].spacing, candidates[rank].clear)) continue;
            if (circles.contain(p) || !insideLoops(exact, p)) continue;
            chart.st.push_back(p);
            neighbours.add(p, static_cast<int>(rank));
        }
    std::vector<glm::dvec2> points(chart.st.begin(), chart.st.end());
    for (auto& t : delaunay(points)) {
        glm::dvec2 a = points[t[0]], b = points[t[1]], c = points[t[2]];
        double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        if (area < 1e-8 || !insideLoops(exact, (a + b + c) / 3.0)) continue;
        chart.triangles.push_back(t);
    }
}

void gridChart(Chart& chart, uint32_t columns, uint32_t rows,
               const std::function<GridPoint(uint32_t column, uint32_t row)>& at) {
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) {
            GridPoint p = at(c, r);
            chart.st.push_back(p.st);
            chart.block.push_back(p.block);
            chart.normal.push_back(p.normal);
        }
    for (uint32_t r = 0; r + 1 < rows; ++r)
        for (uint32_t c = 0; c + 1 < columns; ++c) {
            uint32_t a = r * columns + c, b = a + 1, d = a + columns, e = d + 1;
            if (((c + r) & 1) != 0) {
                chart.triangles.push_back({a, b, e});
                chart.triangles.push_back({a, e, d});
            } else {
                chart.triangles.push_back({a, b, d});
                chart.triangles.push_back({b, e, d});
            }
        }
}

}  // namespace espalier::content
