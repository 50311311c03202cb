// In: a model's triangle list. Out: welded points, the triangles that have area, and edges with their twins, from
// positions alone: what the surface is doesn't depend on anybody's UVs.
#include "tools/bake/bake_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tools/bake/sort_buckets.hpp"

namespace espalier::bakery {
namespace {

constexpr double kWeldRadius = 1e-6;  // of the bounding radius
constexpr double kFinShare = 5e-5;    // of the area: fins smaller than that are left out
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

void warn(std::vector<Diagnostic>& warnings, const Model& model, std::string text) {
    warnings.push_back({model.name, 0, 0, {}, std::move(text), true});
}

Status checkModel(const Model& model) {
    const std::string& name = model.name;
    size_t n = model.positions.size();
    if (model.indices.size() < 3 || model.indices.size() % 3 != 0) return Failure(name, "the model has no triangles");
    if (model.indices.size() / 3 > kMaxTriangles) return Failure(name, "more than 67 million triangles");
    if ((!model.uvs.empty() && model.uvs.size() != n) || (!model.normals.empty() && model.normals.size() != n) ||
        (!model.materialUvs.empty() && model.materialUvs.size() != n) ||
        (!model.colours.empty() && model.colours.size() != n) ||
        (!model.otherUvs.empty() && model.otherUvs.size() != n) ||
        (!model.triangleMaterial.empty() && model.triangleMaterial.size() != model.indices.size() / 3))
        return Failure(name, "vertex arrays of unlike lengths");
    for (uint32_t i : model.indices)
        if (i >= n) return Failure(name, "index " + std::to_string(i) + " of " + std::to_string(n) + " vertices");
    for (const glm::vec3& p : model.positions)
        for (int k = 0; k < 3; ++k)
            if (!(std::abs(p[k]) < 1e18f)) return Failure(name, "a position is not a number or beyond 1e18 metres");
    return Done{};
}

struct Edge {
    uint64_t key;
    uint32_t half;
};

glm::dvec3 normalOf(const BakeMesh& mesh, const Triangle& t) {
    glm::dvec3 n = glm::cross(mesh.points[t.point[1]] - mesh.points[t.point[0]],
                              mesh.points[t.point[2]] - mesh.points[t.point[0]]);
    double length = glm::length(n);
    return length > 0 ? n / length : glm::dvec3(0);
}

// Pairs half-edges that run along one edge in opposite directions. Of more than two, those go together whose outsides
// face each other most closely: a walk goes on along the outside.
void pairEdges(BakeMesh& mesh, size_t& unlike) {
    size_t count = mesh.triangles.size() * 3;
    std::vector<Edge> edges(count);
    for (uint32_t h = 0; h < count; ++h) {
        uint32_t a = mesh.triangles[h / 3].point[h % 3];
        uint32_t b = mesh.triangles[h / 3].point[(h + 1) % 3];
        edges[h] = {uint64_t(std::min(a, b)) << 32 | std::max(a, b), h};
    }
    sortBuckets(
        edges, mesh.points.size(), [](const Edge& e) { return e.key >> 32; },
        [](const Edge& a, const Edge& b) { return std::tie(a.key, a.half) < std::tie(b.key, b.half); });
    mesh.twin.assign(count, kNone);
    auto startOf = [&](uint32_t h) { return mesh.triangles[h / 3].point[h % 3]; };
    struct Pair {
        double angle;
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
            ++mesh.crowdedEdges;
            pairs.clear();
            for (size_t p = i; p < j; ++p)
                for (size_t q = p + 1; q < j; ++q) {
                    uint32_t a = edges[p].half, b = edges[q].half;
                    if (startOf(a) == startOf(b)) continue;
                    pairs.push_back({outsideAngle(mesh, a, b), a, b});
                }
            std::stable_sort(pairs.begin(), pairs.end(),
                             [](const Pair& x, const Pair& y) { return x.angle < y.angle; });
            for (const Pair& p : pairs)
                if (mesh.twin[p.a] == kNone && mesh.twin[p.b] == kNone) mesh.twin[p.a] = p.b, mesh.twin[p.b] = p.a;
        }
        i = j;
    }
}

// Reads the triangles that have area; returns how many have none.
size_t collectTriangles(const Model& model, const std::vector<uint32_t>& point, BakeMesh& mesh) {
    size_t count = model.indices.size() / 3, degenerate = 0;
    mesh.triangles.reserve(count);
    for (size_t t = 0; t < count; ++t) {
        Triangle triangle{};
        triangle.source = uint32_t(t);
        if (const size_t m = model.triangleMaterial.empty() ? 0 : model.triangleMaterial[t]; m < model.materials.size())
            triangle.bare = model.materials[m].bare;
        for (size_t k = 0; k < 3; ++k) triangle.point[k] = point[model.indices[t * 3 + k]];
        double area = area3(mesh, triangle), longest = 0;
        mesh.area += area;
        for (size_t k = 0; k < 3; ++k)
            longest = std::max(longest,
                               glm::length(mesh.points[triangle.point[k]] - mesh.points[triangle.point[(k + 1) % 3]]));
        if (area <= 1e-7 * longest * longest || area <= 0)
            ++degenerate;
        else
            mesh.triangles.push_back(triangle);
    }
    return degenerate;
}

}  // namespace

double outsideAngle(const BakeMesh& mesh, uint32_t a, uint32_t b) {
    glm::dvec3 na = normalOf(mesh, mesh.triangles[a / 3]), nb = normalOf(mesh, mesh.triangles[b / 3]);
    glm::dvec3 along = glm::normalize(mesh.pointAt(BakeMesh::next(a)) - mesh.pointAt(a));
    glm::dvec3 intoA = glm::cross(na, along), intoB = glm::cross(along, nb);
    double angle = std::atan2(glm::dot(intoB, na), glm::dot(intoB, intoA));
    return angle < 1e-6 ? angle + 6.283185307179586 : angle;
}

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
    size_t degenerate = collectTriangles(model, point, mesh);
    if (mesh.triangles.empty()) return Failure(model.name, "no triangle can be baked: all lack area");
    size_t copies = dropCopies(mesh, kFinShare * mesh.area), unlike = 0;
    pairEdges(mesh, unlike);
    if (copies > 0)
        warn(warnings, model,
             std::to_string(copies) + " triangles that others cover exactly, or of small fins, left out");
    if (degenerate > 0) warn(warnings, model, std::to_string(degenerate) + " triangles without area left out");
    if (mesh.crowdedEdges > 0)
        warn(warnings, model,
             std::to_string(mesh.crowdedEdges) + " edges with more than two triangles: paired by direction");
    if (unlike > 0)
        warn(warnings, model,
             std::to_string(unlike) + " edges whose two triangles face opposite ways: walks go over to the back there");
    return mesh;
}

}  // namespace espalier::bakery
