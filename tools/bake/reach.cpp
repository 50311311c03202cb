// In: the finished surface. Out: per connected piece of the model the share of its ground that the largest part holds,
// between whose places plants can get about, there and back, by short walks over every crossing.
//
// Parts that nothing outside sees don't count; models stand on ground, so looks from below the foot are none. Ground is
// inner texels that nothing buries. Texels whose centres see each other past all contacts are one region; a walk over
// a crossing leads from a region to a region.
#include <algorithm>
#include <cmath>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/core/jobs.hpp"
#include "runtime/surface/mesh_tree.hpp"
#include "shaders/shared/walk.h"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/reach_sight.hpp"
#include "tools/bake/reach_walks.hpp"

namespace espalier::bakery {
namespace {

constexpr double kEvery = 8;     // texels of a crossing that one walk stands for
constexpr float kInside = 0.1f;  // texels: where a walk starts, beside its crossing
constexpr float kStride = 0.7f;  // texels of a walk between two looks for ground
constexpr int kStrides = 5;
constexpr size_t kWalks = 400;
constexpr size_t kProbes = 12;  // of a region, asked whether they are seen
constexpr uint32_t kRowsAtOnce = 64;
constexpr int kAround = 2;  // texels: how far from a place its region's centres are looked for

class Ground {
  public:
    explicit Ground(const SurfaceData& surface) : surface_(surface), level_(surface.levels[0]), size_(level_.size) {
        DisjointSets cells(level_.texels.size());
        parallelFor(size_, kRowsAtOnce, [&](size_t begin, size_t end) {
            for (uint32_t y = uint32_t(begin); y < end; ++y)
                for (uint32_t x = 0; x < size_; ++x) {
                    if (x + 1 < size_) joinNeighbours(cells, x, y, x + 1, y);
                    if (y + 1 < end) joinNeighbours(cells, x, y, x, y + 1);
                }
        });
        for (uint32_t y = kRowsAtOnce; y < size_; y += kRowsAtOnce)
            for (uint32_t x = 0; x < size_; ++x) joinNeighbours(cells, x, y - 1, x, y);
        region_ = std::move(cells).takeNumbers([&](uint32_t cell) { return isGround(cell); }, kNone, regions_);
    }

    uint32_t size() const { return size_; }
    bool isGround(uint32_t cell) const { return texelClass(level_.texels[cell].bits) == kTexelInner; }
    uint32_t triangle(uint32_t cell) const { return level_.aux[cell].triangle; }
    uint32_t regions() const { return regions_; }
    uint32_t region(uint32_t cell) const { return region_[cell]; }  // kNone: no ground

    // A cell of the chart whose centre can be gone to straight from uv; kNone: none is near.
    uint32_t cellAt(glm::vec2 uv, uint32_t chart) const {
        const int cx = int(uv.x * float(size_)), cy = int(uv.y * float(size_));
        uint32_t best = kNone;
        float least = 1e30f;
        for (int y = std::max(0, cy - kAround); y <= std::min(int(size_) - 1, cy + kAround); ++y)
            for (int x = std::max(0, cx - kAround); x <= std::min(int(size_) - 1, cx + kAround); ++x) {
                const uint32_t cell = texelIndex(size_, uint32_t(x), uint32_t(y));
                const glm::vec2 centre = centreOf(uint32_t(x), uint32_t(y));
                const float far = glm::length(centre - uv);
                if (!isGround(cell) || texelChart(level_.texels[cell].bits) != chart || far >= least) continue;
                if (parted(chart, uv, centre, std::min(x, cx), std::min(y, cy), std::max(x, cx), std::max(y, cy)))
                    continue;
                best = cell, least = far;
            }
        return best;
    }

  private:
    glm::vec2 centreOf(uint32_t x, uint32_t y) const {
        return glm::vec2(float(x) + 0.5f, float(y) + 0.5f) / float(size_);
    }
    uint32_t listed(uint32_t cell) const { return level_.crossingHead[cell] & 255u; }

    void joinNeighbours(DisjointSets& cells, uint32_t x0, uint32_t y0, uint32_t x1, uint32_t y1) {
        const uint32_t a = texelIndex(size_, x0, y0), b = texelIndex(size_, x1, y1);
        const uint32_t chart = texelChart(level_.texels[a].bits);
        if (!isGround(a) || !isGround(b) || texelChart(level_.texels[b].bits) != chart) return;
        const bool clear = listed(a) == 0 && listed(b) == 0;
        if (clear || !parted(chart, centreOf(x0, y0), centreOf(x1, y1), int(x0), int(y0), int(x1), int(y1)))
            cells.join(a, b);
    }

    // Does a border of the chart or a contact lie between p and q, by the lists of the texels given?
    bool parted(uint32_t chart, glm::dvec2 p, glm::dvec2 q, int x0, int y0, int x1, int y1) const {
        for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) {
                const uint32_t head = level_.crossingHead[texelIndex(size_, uint32_t(x), uint32_t(y))];
                for (uint32_t i = head >> 8; i < (head >> 8) + (head & 255u); ++i) {
                    const Crossing& c = surface_.crossings[level_.crossingRefs[i]];
                    if (c.flags >> 16 != chart) continue;
                    const glm::dvec2 a(c.a), d = glm::dvec2(c.b) - a, e = q - p;
                    const double s = cross(d, p - a), t = cross(d, q - a), u = cross(e, a - p), v = cross(e, a + d - p);
                    if ((s > 0) != (t > 0) && (u > 0) != (v > 0)) return true;
                }
            }
        return false;
    }

    const SurfaceData& surface_;
    const SurfaceLevelData& level_;
    uint32_t size_, regions_ = 0;
    std::vector<uint32_t> region_;  // per cell
};

struct Way {
    uint32_t from, to;  // cells; kNone: none
};

// A walk over a crossing, a share t along it, until it stands where ground is near.
Way walkOver(const Ground& ground, SurfaceBuf surfaces, const SurfaceData& surface, const Crossing& c, float t) {
    const float texel = 1.0f / float(ground.size());
    const uint32_t chart = c.flags >> 16;
    const glm::vec2 d = c.b - c.a;
    const glm::vec2 inward =
        glm::vec2(-d.y, d.x) * (((c.flags & kCrossingInsideLeft) != 0 ? 1.0f : -1.0f) / glm::length(d));
    const glm::vec2 start = c.a + d * t + inward * (kInside * texel);
    Way way{ground.cellAt(start, chart), kNone};
    WalkState w{};
    if (way.from == kNone || !startWalk(surfaces, 0, chart, start, glm::vec3(0), w)) return way;
    w.walk.direction = glm::normalize(w.du * -inward.x + w.dv * -inward.y);
    const float stride = kStride * texel * surface.charts[chart].metresPerUv;
    for (int i = 0; i < kStrides && way.to == kNone; ++i) {
        if (walkStep(surfaces, 0, w, stride) != kWalkDone) break;
        way.to = ground.cellAt(w.walk.uv, w.walk.place & 0xFFFFu);
    }
    return way;
}

std::vector<Way> walkOverAll(const Ground& ground, const SurfaceData& surface) {
    const SurfaceRef ref = surfaceRef(surface);
    std::vector<std::vector<Way>> ways(surface.crossings.size());
    parallelFor(ways.size(), 256, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Crossing& c = surface.crossings[i];
            const float length = glm::length(c.b - c.a);
            if ((c.flags & 3u) == kCrossingOpen || !(length > 0)) continue;
            const int parts = 1 + int(double(length) * ground.size() / kEvery);
            for (int k = 0; k < parts; ++k) {
                const SurfaceBuf surfaces{const_cast<SurfaceRef*>(&ref)};
                const Way way = walkOver(ground, surfaces, surface, c, (float(k) + 0.5f) / float(parts));
                if (way.from != kNone && way.to != kNone) ways[i].push_back(way);
            }
        }
    });
    std::vector<Way> all;
    for (const auto& some : ways) all.insert(all.end(), some.begin(), some.end());
    return all;
}

// Per region the ground's area, the piece that it belongs to, and the ways from it and to it.
struct Map {
    std::vector<double> area;
    std::vector<uint32_t> piece;
    std::vector<std::vector<uint32_t>> onward, back;
};

Map mapOut(const Ground& ground, const std::vector<Way>& ways, const SurfaceData& surface,
           const std::vector<uint32_t>& pieceOf) {
    Map map;
    map.area.resize(ground.regions(), 0);
    map.piece.resize(ground.regions());
    map.onward.resize(ground.regions());
    map.back.resize(ground.regions());
    const uint32_t cells = ground.size() * ground.size();
    for (uint32_t cell = 0; cell < cells; ++cell) {
        const uint32_t r = ground.region(cell);
        if (r == kNone) continue;
        const TrianglePlane& plane = surface.triangles[ground.triangle(cell)];
        if (map.area[r] == 0) map.piece[r] = pieceOf[ground.triangle(cell)];
        map.area[r] += double(glm::length(glm::cross(plane.du, plane.dv))) / cells;
    }
    for (const Way& way : ways) {
        const uint32_t from = ground.region(way.from), to = ground.region(way.to);
        if (from == to) continue;
        map.onward[from].push_back(to);
        map.back[to].push_back(from);
    }
    return map;
}

// Numbers regions so that two have one number if there are ways from each to the other (Kosaraju): a region's number is
// that of the first one of its part that is found.
std::vector<uint32_t> findParts(const Map& map) {
    const uint32_t count = uint32_t(map.area.size());
    std::vector<uint32_t> order, open, part(count, kNone), next(count, 0);
    std::vector<uint8_t> seen(count, 0);
    for (uint32_t start = 0; start < count; ++start) {
        if (seen[start]) continue;
        seen[start] = 1;
        open.push_back(start);
        while (!open.empty()) {
            const uint32_t r = open.back();
            if (next[r] == map.onward[r].size()) {
                order.push_back(r);
                open.pop_back();
            } else if (const uint32_t to = map.onward[r][next[r]++]; !seen[to]) {
                seen[to] = 1;
                open.push_back(to);
            }
        }
    }
    for (size_t i = order.size(); i-- > 0;) {
        if (part[order[i]] != kNone) continue;
        part[order[i]] = order[i];
        open.push_back(order[i]);
        while (!open.empty()) {
            const uint32_t r = open.back();
            open.pop_back();
            for (uint32_t from : map.back[r])
                if (part[from] == kNone) part[from] = order[i], open.push_back(from);
        }
    }
    return part;
}

// Which piece of the model each triangle belongs to: what twins or crossings join, one way or both, and bare ground
// doesn't part.
std::vector<uint32_t> findPieces(const BakeMesh& mesh, const std::vector<Sides>& sides, uint32_t& count) {
    DisjointSets sets(mesh.triangles.size());
    const auto join = [&](uint32_t a, uint32_t b) {
        if (!mesh.parted(a, b)) sets.join(a, b);
    };
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone) join(h / 3, mesh.twin[h] / 3);
    for (const Sides& s : sides)
        if (s.to != kNone) join(s.from, s.to);
    std::vector<uint32_t> piece;
    count = sets.number(piece);
    return piece;
}

// Marks those of the regions asked for of which no place is seen, of some of their texels.
std::vector<uint8_t> findEnclosed(const Ground& ground, const std::vector<uint8_t>& asked, const Sight& sight) {
    std::vector<std::vector<uint32_t>> cells(asked.size());
    for (uint32_t cell = 0; cell < ground.size() * ground.size(); ++cell)
        if (const uint32_t r = ground.region(cell); r != kNone && asked[r]) cells[r].push_back(cell);
    std::vector<uint8_t> enclosed(asked.size(), 0);
    parallelFor(cells.size(), 16, [&](size_t begin, size_t end) {
        for (size_t r = begin; r < end; ++r) {
            const size_t count = std::min(cells[r].size(), kProbes);
            bool seen = count == 0;
            for (size_t k = 0; k < count && !seen; ++k)
                seen = sight.sees(cells[r][(2 * k + 1) * cells[r].size() / (2 * count)]);
            enclosed[r] = !seen;
        }
    });
    return enclosed;
}

// Evenly spread over the ground; those that are seen.
std::vector<WalkStart> findStarts(const Ground& ground, const Map& map, const Sight& sight,
                                  const SurfaceData& surface) {
    std::vector<uint32_t> cells;
    const uint32_t size = ground.size();
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            if (ground.isGround(texelIndex(size, x, y))) cells.push_back(y * size + x);
    const size_t count = std::min(cells.size(), kWalks);
    std::vector<WalkStart> starts(count);
    std::vector<uint8_t> seen(count);
    parallelFor(count, 16, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const uint32_t at = cells[(2 * i + 1) * cells.size() / (2 * count)], y = at / size, x = at % size;
            const uint32_t cell = texelIndex(size, x, y);
            seen[i] = sight.sees(cell);
            starts[i] = {(glm::vec2(float(x), float(y)) + 0.5f) / float(size),
                         texelChart(surface.levels[0].texels[cell].bits), map.piece[ground.region(cell)]};
        }
    });
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i)
        if (seen[i]) starts[kept++] = starts[i];
    starts.resize(kept);
    return starts;
}

}  // namespace

std::vector<PieceReach> measureReach(const BakeMesh& mesh, const std::vector<Sides>& sides, const MeshTree& drawn,
                                     const SurfaceData& surface) {
    uint32_t count = 0;
    const std::vector<uint32_t> pieceOf = findPieces(mesh, sides, count);
    const Ground ground(surface);
    const Map map = mapOut(ground, walkOverAll(ground, surface), surface, pieceOf);
    const std::vector<uint32_t> part = findParts(map);
    std::vector<double> partArea(part.size(), 0);
    for (uint32_t r = 0; r < part.size(); ++r) partArea[part[r]] += map.area[r];
    std::vector<uint32_t> largest(count, kNone);
    for (uint32_t r = 0; r < part.size(); ++r) {
        uint32_t& best = largest[map.piece[r]];
        if (best == kNone || partArea[part[r]] > partArea[best]) best = part[r];
    }
    std::vector<uint8_t> unreached(part.size());
    for (size_t r = 0; r < unreached.size(); ++r) unreached[r] = part[r] != largest[map.piece[r]];
    const Sight sight(mesh, drawn, surface);
    const std::vector<uint8_t> enclosed = findEnclosed(ground, unreached, sight);
    std::vector<PieceReach> pieces(count);
    for (uint32_t r = 0; r < map.area.size(); ++r) {
        PieceReach& piece = pieces[map.piece[r]];
        (enclosed[r] ? piece.enclosed : piece.area) += map.area[r];
        if (!unreached[r]) piece.reachable += map.area[r];
    }
    const std::vector<WalkEnds> ends = walkAbout(mesh, surface, findStarts(ground, map, sight, surface), count);
    for (uint32_t p = 0; p < count; ++p) pieces[p].walks = ends[p].walks, pieces[p].ended = ends[p].ended;
    std::erase_if(pieces, [](const PieceReach& p) { return p.area <= 0; });
    std::stable_sort(pieces.begin(), pieces.end(),
                     [](const PieceReach& a, const PieceReach& b) { return a.area > b.area; });
    return pieces;
}

}  // namespace espalier::bakery
