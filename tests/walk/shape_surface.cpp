// A shape as a mesh for the baker, and as a geometry image straight from its formulas, which tests the walk
// without the baker.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "shaders/shared/exact.h"
#include "tests/walk/shapes.hpp"

namespace espalier::walktest {
namespace {

using Key = std::array<long long, 3>;

Key keyOf(Vec3 p) {
    return {std::llround(p.x * 1e6), std::llround(p.y * 1e6), std::llround(p.z * 1e6)};
}

// Does the segment a-b meet the square of half side h around c? (Separating axes, in texels.)
bool meets(Vec2 a, Vec2 b, Vec2 c, double h) {
    Vec2 low = glm::min(a, b), high = glm::max(a, b);
    if (low.x > c.x + h || high.x < c.x - h || low.y > c.y + h || high.y < c.y - h) return false;
    Vec2 e = b - a, n(-e.y, e.x);
    return std::abs(glm::dot(n, c - a)) <= h * (std::abs(n.x) + std::abs(n.y));
}

// A texel's distance in kings' moves to the nearest texel with crossings, less one, is never more than the room
// around its square.
void setClearance(SurfaceLevelData& level) {
    int size = int(level.size);
    std::vector<int> moves(size_t(size * size), 64);
    auto at = [&](int x, int y) -> int& { return moves[size_t(y * size + x)]; };
    auto relax = [&](int x, int y, int dx, int dy) {
        int nx = x + dx, ny = y + dy;
        if (nx >= 0 && ny >= 0 && nx < size && ny < size) at(x, y) = std::min(at(x, y), at(nx, ny) + 1);
    };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            if (level.crossingHead[texelIndex(level.size, uint(x), uint(y))] & 0xFF) at(x, y) = 0;
            relax(x, y, -1, 0), relax(x, y, -1, -1), relax(x, y, 0, -1), relax(x, y, 1, -1);
        }
    for (int y = size - 1; y >= 0; --y)
        for (int x = size - 1; x >= 0; --x) {
            relax(x, y, 1, 0), relax(x, y, 1, 1), relax(x, y, 0, 1), relax(x, y, -1, 1);
            uint& bits = level.texels[texelIndex(level.size, uint(x), uint(y))].bits;
            bits |= uint(std::clamp(at(x, y) - 1, 0, 31)) << 19;
        }
}

void rasterise(const Shape& shape, const std::vector<Crossing>& crossings, SurfaceLevelData& level) {
    uint size = level.size;
    size_t count = size_t(size) * size;
    level.texels.assign(count, Texel{vec3(0), 0});
    level.aux.assign(count, TexelAux{0, kNoIndex});
    for (size_t i = 0; i < shape.charts.size(); ++i) {
        const AtlasCell& cell = shape.charts[i].cell;
        for (uint y = 0; y < size; ++y)
            for (uint x = 0; x < size; ++x) {
                Vec2 q = cell.toParameter(Vec2(x + 0.5, y + 0.5) / double(size));
                Vec2 past = glm::max(Vec2(0), glm::max(-q, q - 1.0)) * cell.extent * double(size);
                if (std::max(past.x, past.y) > 3) continue;
                bool inner = past.x == 0 && past.y == 0;
                uint index = texelIndex(size, x, y);
                if (!inner && texelClass(level.texels[index].bits) != kTexelEmpty) continue;
                Vec3 p = shape.charts[i].at(q);
                level.texels[index].position = vec3(p);
                level.texels[index].bits = packTexelBits(uint(i), inner ? kTexelInner : kTexelLink, 0, 0, 0);
                level.aux[index].normal = packOct(vec3(shape.normal(p)));
            }
    }
    std::vector<std::vector<uint>> lists(count);
    for (size_t i = 0; i < crossings.size(); ++i) {
        Vec2 a = Vec2(crossings[i].a) * double(size), b = Vec2(crossings[i].b) * double(size);
        Vec2 low = glm::floor(glm::min(a, b)) - 1.0, high = glm::floor(glm::max(a, b)) + 1.0;
        for (int y = std::max(0, int(low.y)); y <= std::min(int(size) - 1, int(high.y)); ++y)
            for (int x = std::max(0, int(low.x)); x <= std::min(int(size) - 1, int(high.x)); ++x)
                if (meets(a, b, Vec2(x + 0.5, y + 0.5), 0.51))
                    lists[texelIndex(size, uint(x), uint(y))].push_back(uint(i));
    }
    level.crossingHead.assign(count, 0);
    for (size_t i = 0; i < count; ++i) {
        level.crossingHead[i] = uint(level.crossingRefs.size()) << 8 | uint(lists[i].size());
        level.crossingRefs.insert(level.crossingRefs.end(), lists[i].begin(), lists[i].end());
    }
    setClearance(level);
}

std::vector<Crossing> sideCrossings(const Shape& shape) {
    struct Side {
        Vec3 p0, p1;
        Vec2 uv0, uv1;
        int chart;
    };
    std::vector<Side> sides;
    const Vec2 corners[5] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    for (size_t i = 0; i < shape.charts.size(); ++i) {
        const ChartPatch& c = shape.charts[i];
        for (int k = 0; k < 4; ++k) {
            int n = k % 2 == 0 ? c.na : c.nb;
            for (int j = 0; j < n; ++j) {
                Vec2 q0 = glm::mix(corners[k], corners[k + 1], double(j) / n);
                Vec2 q1 = glm::mix(corners[k], corners[k + 1], double(j + 1) / n);
                sides.push_back({c.at(q0), c.at(q1), c.cell.toUv(q0), c.cell.toUv(q1), int(i)});
            }
        }
    }
    std::multimap<std::pair<Key, Key>, size_t> byEnds;
    for (size_t i = 0; i < sides.size(); ++i) byEnds.insert({{keyOf(sides[i].p0), keyOf(sides[i].p1)}, i});
    std::vector<Crossing> crossings;
    for (const Side& s : sides) {
        Crossing c{};
        c.a = vec2(s.uv0);
        c.b = vec2(s.uv1);
        c.edge = c.targetEdge = packOct(vec3(glm::normalize(s.p1 - s.p0)));
        bool left = !shape.charts[size_t(s.chart)].cell.mirror;
        c.flags = kCrossingOpen | (left ? 4u : 0u) | uint(s.chart) << 16;
        auto mate = byEnds.find({keyOf(s.p1), keyOf(s.p0)});  // coherent charts pass an edge in opposite senses
        if (mate != byEnds.end()) {
            const Side& m = sides[mate->second];
            c.ta = vec2(m.uv1);
            c.tb = vec2(m.uv0);
            c.target = 0xFFFF0000u | uint(m.chart);
            c.flags = (c.flags & ~3u) | kCrossingSeam;
        }
        crossings.push_back(c);
    }
    return crossings;
}

}  // namespace

Model toModel(const Shape& shape) {
    Model model;
    model.name = shape.name;
    for (const ChartPatch& c : shape.charts) {
        uint32_t first = uint32_t(model.positions.size());
        for (int j = 0; j <= c.nb; ++j)
            for (int i = 0; i <= c.na; ++i) {
                Vec2 q(double(i) / c.na, double(j) / c.nb);
                Vec3 p = c.at(q);
                // Rounded, so that charts' vertices on a common edge are the same to the bit.
                model.positions.push_back(vec3(glm::round(p * 1048576.0) / 1048576.0));
                model.normals.push_back(vec3(shape.normal(p)));
                model.uvs.push_back(vec2(c.cell.toUv(q)));
            }
        for (int j = 0; j < c.nb; ++j)
            for (int i = 0; i < c.na; ++i) {
                uint32_t v = first + uint32_t(j * (c.na + 1) + i), w = v + uint32_t(c.na + 1);
                for (uint32_t k : {v, v + 1, w + 1, v, w + 1, w}) model.indices.push_back(k);
            }
    }
    return model;
}

SurfaceData toSurface(const Shape& shape, uint32_t resolution, uint32_t levels) {
    SurfaceData data;
    data.source = shape.name;
    data.crossings = sideCrossings(shape);
    data.boundsMin = vec3(1e9f);
    data.boundsMax = vec3(-1e9f);
    for (uint32_t l = 0; l < levels; ++l) {
        data.levels.emplace_back();
        data.levels.back().size = resolution >> l;
        rasterise(shape, data.crossings, data.levels.back());
    }
    for (const ChartPatch& c : shape.charts) {
        Chart chart{};
        chart.uvMin = vec2(1);
        chart.uvMax = vec2(0);
        Vec2 q;
        double area = 0;
        for (q.y = 0; q.y <= 1; q.y += 0.0625)
            for (q.x = 0; q.x <= 1; q.x += 0.0625) {
                chart.uvMin = glm::min(chart.uvMin, vec2(c.cell.toUv(q)));
                chart.uvMax = glm::max(chart.uvMax, vec2(c.cell.toUv(q)));
                data.boundsMin = glm::min(data.boundsMin, vec3(c.at(q)));
                data.boundsMax = glm::max(data.boundsMax, vec3(c.at(q)));
                Vec3 da = c.at(q + Vec2(1e-4, 0)) - c.at(q), db = c.at(q + Vec2(0, 1e-4)) - c.at(q);
                area += glm::length(glm::cross(da, db)) * 1e8 / 289;
            }
        chart.orientation = c.cell.mirror ? -1.0f : 1.0f;
        chart.coarsestLevel = levels - 1;
        chart.area = float(area);
        chart.metresPerUv = float(std::sqrt(area / (c.cell.extent.x * c.cell.extent.y)));
        data.charts.push_back(chart);
    }
    return data;
}

}  // namespace espalier::walktest
