// In: the laid-out mesh and a level's size. Out: for each texel the triangle that covers its centre, or the
// border edge whose gutter it lies in. Each level is drawn from the mesh, never filtered (Buron 2015 §4).
#include <algorithm>
#include <atomic>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/bands.hpp"

namespace espalier::bakery {
namespace {

constexpr double kGutterTexels = 2;  // the gutter's width
constexpr double kNeededTexels = 1;  // a bilinear read reaches texel centres nearer than this
constexpr float kNotNeeded = 1e6f;   // added to distances of gutter texels that no read needs

// Where the line from a to b crosses height y; the same bits for both triangles of an edge.
double crossingAt(glm::dvec2 a, glm::dvec2 b, double y) {
    if (a.y > b.y || (a.y == b.y && a.x > b.x)) std::swap(a, b);
    return a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
}

// Calls row(y, x0, x1) for the texels (x0 <= x < x1) whose centres a triangle covers; centres on a shared edge
// belong to one of its triangles.
template <class Row>
void gridTriangle(const std::array<glm::dvec2, 3>& p, int64_t size, int64_t yBegin, int64_t yEnd, Row&& row) {
    double low = std::min({p[0].y, p[1].y, p[2].y}), high = std::max({p[0].y, p[1].y, p[2].y});
    int64_t y0 = std::max(yBegin, ceilWhole(low - 0.5));
    int64_t y1 = std::min(yEnd, ceilWhole(high - 0.5));
    for (int64_t y = y0; y < y1; ++y) {
        double cy = double(y) + 0.5, x[2];
        int found = 0;
        for (int k = 0; k < 3 && found < 2; ++k) {
            glm::dvec2 a = p[size_t(k)], b = p[size_t(k + 1) % 3];
            if ((a.y <= cy) != (b.y <= cy)) x[found++] = crossingAt(a, b, cy);
        }
        if (found < 2) continue;
        int64_t x0 = std::max(int64_t(0), ceilWhole(std::min(x[0], x[1]) - 0.5));
        int64_t x1 = std::min(size, ceilWhole(std::max(x[0], x[1]) - 0.5));
        if (x0 < x1) row(y, x0, x1);
    }
}

}  // namespace

void drawTriangles(const BakeMesh& mesh, uint32_t size, IdImage& image, uint64_t* overlaps) {
    image.size = size;
    image.id.resize(size_t(size) * size);
    const Bands bands(mesh.triangles.size(), size, [&](size_t t) {
        const auto& uv = mesh.triangles[t].uv;
        return std::pair(std::min({uv[0].y, uv[1].y, uv[2].y}) * size - 0.5,
                         std::max({uv[0].y, uv[1].y, uv[2].y}) * size - 0.5);
    });
    std::atomic<uint64_t> all = 0;
    parallelFor(size, kBandRows, [&](size_t begin, size_t end) {
        uint32_t* ids = image.id.data();
        std::fill(ids + begin * size, ids + end * size, kNone);
        uint64_t again = 0;
        for (uint32_t t : bands.at(begin)) {
            const auto& uv = mesh.triangles[t].uv;
            std::array<glm::dvec2, 3> p = {uv[0] * double(size), uv[1] * double(size), uv[2] * double(size)};
            gridTriangle(p, size, int64_t(begin), int64_t(end), [&](int64_t y, int64_t x0, int64_t x1) {
                uint32_t* line = ids + size_t(y) * size;
                for (int64_t x = x0; x < x1; ++x) {
                    if (line[x] == kNone)
                        line[x] = t;
                    else
                        ++again;
                }
            });
        }
        all += again;
    });
    if (overlaps) *overlaps = all;
}

std::vector<uint32_t> borderEdges(const BakeMesh& mesh) {
    std::vector<uint32_t> borders;
    for (uint32_t h = 0; h < mesh.joined.size(); ++h)
        if (!mesh.joined[h]) borders.push_back(h);
    return borders;
}

bool drawGutters(const BakeMesh& mesh, const std::vector<uint32_t>& borders, IdImage& image,
                 std::vector<uint8_t>& walkable) {
    uint32_t size = image.size;
    std::atomic<bool> cleared = false;
    auto chartOfId = [&](uint32_t id) {
        return id == kNone ? kNone : mesh.chartOf(id & kGutterBit ? id & ~kGutterBit : id * 3);
    };
    auto clear = [&](uint32_t chart) {
        std::atomic_ref<uint8_t>(walkable[chart]).store(0, std::memory_order_relaxed);
        cleared.store(true, std::memory_order_relaxed);
    };
    const std::vector<uint8_t> drawn = walkable;
    const Bands bands(borders.size(), size, [&](size_t i) {
        const double a = mesh.uvAt(borders[i]).y * size, b = mesh.uvAt(BakeMesh::next(borders[i])).y * size;
        return std::pair(std::min(a, b) - 3, std::max(a, b) + 3);
    });
    parallelFor(size, kBandRows, [&](size_t begin, size_t end) {
        std::vector<float> distance((end - begin) * size, 3e6f);
        auto forBorders = [&](double grow, auto&& texel) {
            for (uint32_t i : bands.at(begin)) {
                const uint32_t h = borders[i];
                if (!drawn[mesh.chartOf(h)]) continue;
                glm::dvec2 a = mesh.uvAt(h) * double(size), b = mesh.uvAt(BakeMesh::next(h)) * double(size);
                gridSegment(a, b, grow, size, int64_t(begin), int64_t(end), [&](int64_t y, int64_t x0, int64_t x1) {
                    for (int64_t x = x0; x <= x1; ++x) texel(h, a, b, size_t(x), size_t(y));
                });
            }
        };
        auto claim = [&](float penalty) {
            return [&, penalty](uint32_t h, glm::dvec2 a, glm::dvec2 b, size_t x, size_t y) {
                uint32_t& id = image.id[y * size + x];
                if (id != kNone && !(id & kGutterBit)) return;
                glm::vec2 d(b - a), c(glm::dvec2(double(x) + 0.5, double(y) + 0.5) - a);
                float length2 = d.x * d.x + d.y * d.y;
                float t = length2 > 0 ? std::clamp((c.x * d.x + c.y * d.y) / length2, 0.0f, 1.0f) : 0.0f;
                glm::vec2 away = c - d * t;
                float far = away.x * away.x + away.y * away.y + penalty;
                float& best = distance[(y - begin) * size + x];
                if (far >= best) return;
                best = far;
                id = kGutterBit | h;
            };
        };
        forBorders(kNeededTexels, claim(0));
        forBorders(kGutterTexels, claim(kNotNeeded));
        forBorders(kNeededTexels - 1e-6, [&](uint32_t h, glm::dvec2, glm::dvec2, size_t x, size_t y) {
            uint32_t chart = mesh.chartOf(h);
            if (chartOfId(image.id[y * size + x]) != chart) clear(chart);
        });
    });
    // A read beside the image's own border would need texels that don't exist.
    double low = 0.5 / size, high = 1 - low;
    for (uint32_t h : borders) {
        glm::dvec2 uv = mesh.uvAt(h);
        if (walkable[mesh.chartOf(h)] && (uv.x < low || uv.y < low || uv.x > high || uv.y > high))
            clear(mesh.chartOf(h));
    }
    return cleared;
}

}  // namespace espalier::bakery
