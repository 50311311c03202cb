// In: a model's triangle list. Out: welded points, edges with their twins, and charts: sets of triangles of one
// orientation in UV that are connected across edges on whose UVs both sides agree.
#include "tools/bake/bake_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace espalier::bakery {
namespace {

constexpr double kWeldRadius = 1e-6;     // of the bounding radius
constexpr double kUvTolerance = 1e-6;    // within which two corners' UVs agree
constexpr double kMinUvArea = 1e-13;     // of a triangle; below, its map has no inverse worth the name
constexpr double kFlippedShare = 0.005;  // of the area: flipped islands up to this are left out
constexpr size_t kMaxTriangles = size_t(1) << 26;

// A hash table from 64-bit keys to small numbers, open addressing.
class Table {
  public:
    explicit Table(size_t count) {
        size_t size = 16;
        while (size < count * 2) size *= 2;
        keys_.assign(size, ~uint64_t(0));
        values_.assign(size, kNone);
    }
    uint32_t& at(uint64_t key) {
        uint64_t h = key * 0x9E3779B97F4A7C15ull;
        size_t i = size_t(h ^ (h >> 29)) & (keys_.size() - 1);
        while (values_[i] != kNone && keys_[i] != key) i = (i + 1) & (keys_.size() - 1);
        keys_[i] = key;
        return values_[i];
    }

  private:
    std::vector<uint64_t> keys_;
    std::vector<uint32_t> values_;
};

uint64_t mix(uint64_t a, uint64_t b) {
    a ^= b + 0x9E3779B97F4A7C15ull + (a << 6) + (a >> 2);
    a *= 0xFF51AFD7ED558CCDull;
    return a ^ (a >> 32);
}

// Gives every vertex the number of its point: vertices within the weld radius share one.
std::vector<uint32_t> weld(const Model& model, double tolerance, std::vector<glm::dvec3>& points) {
    size_t count = model.positions.size();
    std::vector<uint32_t> point(count);
    // A cell's key may collide with another's: chains of points per cell tell them apart by distance.
    Table cells(count);
    std::vector<uint32_t> chain;
    double cell = tolerance * 4;
    auto key = [](int64_t x, int64_t y, int64_t z) { return mix(mix(uint64_t(x), uint64_t(y)), uint64_t(z)); };
    for (size_t i = 0; i < count; ++i) {
        glm::dvec3 p(model.positions[i]);
        glm::dvec3 g = p / cell;
        glm::dvec3 f(std::floor(g.x), std::floor(g.y), std::floor(g.z));
        // Only neighbours that the tolerance reaches are looked at: mostly the cell alone.
        int64_t low[3], high[3];
        for (int k = 0; k < 3; ++k) {
            low[k] = int64_t(f[k]) - (g[k] - f[k] < 0.25 ? 1 : 0);
            high[k] = int64_t(f[k]) + (g[k] - f[k] > 0.75 ? 1 : 0);
        }
        uint32_t found = kNone;
        for (int64_t x = low[0]; x <= high[0] && found == kNone; ++x)
            for (int64_t y = low[1]; y <= high[1] && found == kNone; ++y)
                for (int64_t z = low[2]; z <= high[2] && found == kNone; ++z)
                    for (uint32_t q = cells.at(key(x, y, z)); q != kNone && found == kNone; q = chain[q])
                        if (glm::dot(points[q] - p, points[q] - p) <= tolerance * tolerance) found = q;
        if (found == kNone) {
            found = uint32_t(points.size());
            points.push_back(p);
            uint32_t& head = cells.at(key(int64_t(f.x), int64_t(f.y), int64_t(f.z)));
            chain.push_back(head);
            head = found;
        }
        point[i] = found;
    }
    return point;
}

struct UnionFind {
    std::vector<uint32_t> parent;
    explicit UnionFind(size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        if (a != b) parent[std::max(a, b)] = std::min(a, b);
    }
};

void warn(std::vector<Diagnostic>& warnings, const Model& model, std::string text) {
    warnings.push_back({model.name, 0, 0, {}, std::move(text), true});
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", share * 100);
    return text;
}

Status checkModel(const Model& model) {
    const std::string& name = model.name;
    size_t n = model.positions.size();
    if (model.indices.size() < 3 || model.indices.size() % 3 != 0) return Failure(name, "the model has no triangles");
    if (model.indices.size() / 3 > kMaxTriangles) return Failure(name, "more than 67 million triangles");
    if (model.uvs.empty())
        return Failure(name, "the model has no UVs (100 % of its area): an unwrapped UV set is needed to bake it");
    if (model.uvs.size() != n || (!model.normals.empty() && model.normals.size() != n) ||
        (!model.materialUvs.empty() && model.materialUvs.size() != n) ||
        (!model.triangleMaterial.empty() && model.triangleMaterial.size() != model.indices.size() / 3))
        return Failure(name, "vertex arrays of unlike lengths");
    for (uint32_t i : model.indices)
        if (i >= n) return Failure(name, "index " + std::to_string(i) + " of " + std::to_string(n) + " vertices");
    for (const glm::vec3& p : model.positions)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(p[k]) < 1e18f)) return Failure(name, "a position is not a number or beyond 1e18 metres");
    return Done{};
}

// What is wrong with triangles that are left out.
struct LeftOut {
    size_t degenerate = 0, degenerateUv = 0, noUv = 0, flipped = 0;
    double degenerateUvArea = 0, noUvArea = 0, flippedArea = 0;
};

Status reportLeftOut(const Model& model, const LeftOut& out, double area, std::vector<Diagnostic>& warnings) {
    if (out.noUvArea > 0.005 * area)
        return Failure(model.name, percent(out.noUvArea / area) + " of the area has no UVs (" +
                                       std::to_string(out.noUv) +
                                       " triangles): an unwrapped UV set is needed to bake it");
    if (out.degenerateUvArea > 0.05 * area)
        return Failure(model.name, "the UVs of " + percent(out.degenerateUvArea / area) +
                                       " of the area collapse to points or lines (" + std::to_string(out.degenerateUv) +
                                       " triangles): an unwrapped UV set is needed to bake it");
    if (out.flippedArea > 0.02 * area)
        return Failure(model.name, "the UVs fold over themselves: " + percent(out.flippedArea / area) +
                                       " of the area is flipped (" + std::to_string(out.flipped) +
                                       " triangles): an unwrapped UV set is needed to bake it");
    if (out.degenerate > 0) warn(warnings, model, std::to_string(out.degenerate) + " triangles without area left out");
    if (out.degenerateUv + out.noUv > 0)
        warn(warnings, model,
             std::to_string(out.degenerateUv + out.noUv) + " triangles without area in UV left out, " +
                 percent((out.degenerateUvArea + out.noUvArea) / area) + " of the area");
    if (out.flipped > 0)
        warn(warnings, model,
             std::to_string(out.flipped) + " triangles flipped in UV left out, " + percent(out.flippedArea / area) +
                 " of the area");
    return Done{};
}

struct Edge {
    uint64_t key;
    uint32_t half;
};

// Sorts by key: twice 32 bits' worth of counting passes over 11 bits at a time.
void sortEdges(std::vector<Edge>& edges, uint32_t pointCount) {
    std::vector<Edge> other(edges.size());
    int bits = 1;
    while (pointCount >> bits) ++bits;
    for (int base : {0, 32})
        for (int shift = 0; shift < bits; shift += 11) {
            std::array<uint32_t, 2049> start{};
            int at = base + shift;
            for (const Edge& e : edges) ++start[((e.key >> at) & 2047) + 1];
            for (int i = 0; i < 2048; ++i) start[size_t(i) + 1] += start[size_t(i)];
            for (const Edge& e : edges) other[start[(e.key >> at) & 2047]++] = e;
            edges.swap(other);
        }
}

glm::dvec3 normalOf(const BakeMesh& mesh, const Triangle& t) {
    glm::dvec3 n = glm::cross(mesh.points[t.point[1]] - mesh.points[t.point[0]],
                              mesh.points[t.point[2]] - mesh.points[t.point[0]]);
    double length = glm::length(n);
    return length > 0 ? n / length : glm::dvec3(0);
}

// Pairs half-edges that run along one edge in opposite directions. Of more than two, the flattest pairs go first.
void pairEdges(BakeMesh& mesh, size_t& nonManifold, size_t& unlike) {
    size_t count = mesh.triangles.size() * 3;
    std::vector<Edge> edges(count);
    for (uint32_t h = 0; h < count; ++h) {
        uint32_t a = mesh.triangles[h / 3].point[h % 3];
        uint32_t b = mesh.triangles[h / 3].point[(h + 1) % 3];
        edges[h] = {uint64_t(std::min(a, b)) << 32 | std::max(a, b), h};
    }
    sortEdges(edges, uint32_t(mesh.points.size()));
    mesh.twin.assign(count, kNone);
    auto startOf = [&](uint32_t h) { return mesh.triangles[h / 3].point[h % 3]; };
    struct Pair {
        double dot;
        uint32_t a, b;
    };
    std::vector<Pair> pairs;
    for (size_t i = 0; i < count;) {
        size_t j = i + 1;
        while (j < count && edges[j].key == edges[i].key) ++j;
        if (j - i == 2) {
            uint32_t a = edges[i].half, b = edges[i + 1].half;
            if (startOf(a) != startOf(b))
                mesh.twin[a] = b, mesh.twin[b] = a;
            else
                ++unlike;
        } else if (j - i > 2 && j - i <= 64) {
            ++nonManifold;
            pairs.clear();
            for (size_t p = i; p < j; ++p)
                for (size_t q = p + 1; q < j; ++q) {
                    uint32_t a = edges[p].half, b = edges[q].half;
                    if (startOf(a) == startOf(b)) continue;
                    pairs.push_back(
                        {glm::dot(normalOf(mesh, mesh.triangles[a / 3]), normalOf(mesh, mesh.triangles[b / 3])), a, b});
                }
            std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) { return x.dot > y.dot; });
            for (const Pair& p : pairs)
                if (mesh.twin[p.a] == kNone && mesh.twin[p.b] == kNone) mesh.twin[p.a] = p.b, mesh.twin[p.b] = p.a;
        }
        i = j;
    }
}

bool uvsAgree(const BakeMesh& mesh, uint32_t h, uint32_t twin) {
    glm::dvec2 d0 = mesh.uvAt(h) - mesh.uvAt(BakeMesh::next(twin));
    glm::dvec2 d1 = mesh.uvAt(BakeMesh::next(h)) - mesh.uvAt(twin);
    double most = std::max(std::max(std::abs(d0.x), std::abs(d0.y)), std::max(std::abs(d1.x), std::abs(d1.y)));
    return most <= kUvTolerance;
}

// Reads the triangles worth keeping.
void collectTriangles(const Model& model, const std::vector<uint32_t>& point, BakeMesh& mesh, LeftOut& out) {
    size_t count = model.indices.size() / 3;
    mesh.triangles.reserve(count);
    for (size_t t = 0; t < count; ++t) {
        Triangle triangle;
        triangle.source = uint32_t(t);
        triangle.chart = 0;
        bool finite = true;
        for (size_t k = 0; k < 3; ++k) {
            uint32_t v = model.indices[t * 3 + k];
            triangle.point[k] = point[v];
            triangle.uv[k] = glm::dvec2(model.uvs[v]);
            finite = finite && std::abs(triangle.uv[k].x) < 1e6 && std::abs(triangle.uv[k].y) < 1e6;
        }
        double area = area3(mesh, triangle);
        mesh.area += area;
        double longest = 0;
        for (size_t k = 0; k < 3; ++k)
            longest = std::max(longest,
                               glm::length(mesh.points[triangle.point[k]] - mesh.points[triangle.point[(k + 1) % 3]]));
        if (area <= 1e-7 * longest * longest || area <= 0) {
            ++out.degenerate;
        } else if (!finite) {
            ++out.noUv;
            out.noUvArea += area;
        } else if (std::abs(uvArea(triangle)) < kMinUvArea) {
            ++out.degenerateUv;
            out.degenerateUvArea += area;
        } else {
            mesh.triangles.push_back(triangle);
        }
    }
}

// Connects triangles of one orientation; returns each triangle's island, kNone where it is left out as flipped.
std::vector<uint32_t> findIslands(BakeMesh& mesh, LeftOut& out) {
    size_t count = mesh.triangles.size();
    UnionFind sets(count);
    std::vector<uint8_t> positive(count);
    for (size_t t = 0; t < count; ++t) positive[t] = uvArea(mesh.triangles[t]) > 0;
    std::vector<uint32_t> against;  // half-edges across which UVs agree but the orientation turns: folds
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t twin = mesh.twin[h];
        if (twin == kNone || twin < h || !uvsAgree(mesh, h, twin)) continue;
        if (positive[h / 3] == positive[twin / 3])
            sets.join(h / 3, twin / 3);
        else
            against.push_back(h);
    }
    std::vector<uint32_t> island(count), members(count, 0);
    std::vector<double> area(count, 0);
    for (uint32_t t = 0; t < count; ++t) {
        island[t] = sets.find(t);
        ++members[island[t]];
        area[island[t]] += area3(mesh, mesh.triangles[t]);
    }
    std::vector<uint8_t> flipped(count, 0);
    for (uint32_t h : against) {
        uint32_t a = island[h / 3], b = island[mesh.twin[h] / 3];
        uint32_t small = area[a] < area[b] ? a : b, large = area[a] < area[b] ? b : a;
        if (members[small] <= 4 && area[small] <= kFlippedShare * mesh.area && area[small] < area[large])
            flipped[small] = 1;
    }
    for (uint32_t t = 0; t < count; ++t) {
        if (!flipped[island[t]]) continue;
        ++out.flipped;
        out.flippedArea += area3(mesh, mesh.triangles[t]);
        island[t] = kNone;
    }
    return island;
}

// Numbers charts by their first triangle and sorts triangles by chart.
Status sortByChart(const Model& model, const std::vector<uint32_t>& island, BakeMesh& mesh) {
    size_t count = mesh.triangles.size();
    std::vector<uint32_t> number(count, kNone), sizes;
    for (uint32_t t = 0; t < count; ++t) {
        if (island[t] == kNone) continue;
        uint32_t& n = number[island[t]];
        if (n == kNone) {
            n = uint32_t(sizes.size());
            sizes.push_back(0);
            mesh.orientation.push_back(uvArea(mesh.triangles[t]) > 0 ? 1.0f : -1.0f);
        }
        mesh.triangles[t].chart = n;
        ++sizes[n];
    }
    if (sizes.empty()) return Failure(model.name, "no triangle can be baked: all lack area");
    if (sizes.size() > 65535)
        return Failure(model.name, "the UVs fall into " + std::to_string(sizes.size()) + " charts; 65535 is the limit");
    mesh.firstTriangle.assign(sizes.size() + 1, 0);
    for (size_t c = 0; c < sizes.size(); ++c) mesh.firstTriangle[c + 1] = mesh.firstTriangle[c] + sizes[c];
    std::vector<uint32_t> at(mesh.firstTriangle.begin(), mesh.firstTriangle.end() - 1);
    std::vector<uint32_t> moved(count, kNone);
    std::vector<Triangle> sorted(mesh.firstTriangle.back());
    for (uint32_t t = 0; t < count; ++t)
        if (island[t] != kNone) sorted[moved[t] = at[mesh.triangles[t].chart]++] = mesh.triangles[t];
    std::vector<uint32_t> twin(sorted.size() * 3, kNone);
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t other = mesh.twin[h];
        if (moved[h / 3] == kNone || other == kNone || moved[other / 3] == kNone) continue;
        twin[moved[h / 3] * 3 + h % 3] = moved[other / 3] * 3 + other % 3;
    }
    mesh.triangles.swap(sorted);
    mesh.twin.swap(twin);
    mesh.joined.assign(mesh.twin.size(), 0);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone && mesh.chartOf(h) == mesh.chartOf(mesh.twin[h]) && uvsAgree(mesh, h, mesh.twin[h]))
            mesh.joined[h] = 1;
    return Done{};
}

}  // namespace

double area3(const BakeMesh& mesh, const Triangle& t) {
    return glm::length(glm::cross(mesh.points[t.point[1]] - mesh.points[t.point[0]],
                                  mesh.points[t.point[2]] - mesh.points[t.point[0]])) /
           2;
}

Result<BakeMesh> buildMesh(const Model& model, std::vector<Diagnostic>& warnings) {
    Status valid = checkModel(model);
    if (!valid) return std::move(valid.failure());
    BakeMesh mesh;
    glm::dvec3 low(1e300), high(-1e300);
    for (uint32_t i : model.indices) {
        low = glm::min(low, glm::dvec3(model.positions[i]));
        high = glm::max(high, glm::dvec3(model.positions[i]));
    }
    mesh.boundsMin = low;
    mesh.boundsMax = high;
    mesh.radius = glm::length(high - low) / 2;
    if (!(mesh.radius > 1e-12)) return Failure(model.name, "the model has no extent");
    double magnitude = std::max(glm::length(low), glm::length(high));
    if (mesh.radius < 1e-6 * magnitude)
        return Failure(model.name, "the model lies too far from its origin for single precision");
    std::vector<uint32_t> point = weld(model, kWeldRadius * mesh.radius, mesh.points);
    LeftOut out;
    collectTriangles(model, point, mesh, out);
    if (!(mesh.area > 0)) return Failure(model.name, "the model has no area");
    size_t nonManifold = 0, unlike = 0;
    pairEdges(mesh, nonManifold, unlike);
    std::vector<uint32_t> island = findIslands(mesh, out);
    Status usable = reportLeftOut(model, out, mesh.area, warnings);
    if (!usable) return std::move(usable.failure());
    Status sorted = sortByChart(model, island, mesh);
    if (!sorted) return std::move(sorted.failure());
    if (nonManifold > 0)
        warn(warnings, model, std::to_string(nonManifold) + " edges with more than two triangles: paired by direction");
    if (unlike > 0)
        warn(warnings, model, std::to_string(unlike) + " edges whose two triangles face opposite ways: borders there");
    return mesh;
}

}  // namespace espalier::bakery
