// Straightest geodesics (unfolding triangle by triangle) and random walks on a mesh.
#include "tests/walk/mesh_tracer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace espalier::walktest {

MeshTracer::MeshTracer(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices) {
    std::map<std::array<float, 3>, uint32_t> ids;
    auto weld = [&](uint32_t vertex) {
        vec3 p = vertices[vertex].position;
        auto [at, fresh] = ids.try_emplace({p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}, uint32_t(positions_.size()));
        if (fresh) positions_.push_back(Vec3(p));
        return at->second;
    };
    std::map<std::pair<uint32_t, uint32_t>, std::vector<int64_t>> edges;
    double sum = 0;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        uint32_t w[3];
        for (size_t k = 0; k < 3; ++k) {
            w[k] = weld(indices[i + k]);
            welded_.push_back(w[k]);
            uvs_.push_back(Vec2(vertices[indices[i + k]].walkUv));
        }
        for (size_t k = 0; k < 3; ++k) {
            uint32_t a = w[k], b = w[(k + 1) % 3];
            if (a != b) edges[{std::min(a, b), std::max(a, b)}].push_back(int64_t(i + k));
        }
        sum += glm::length(glm::cross(positions_[w[1]] - positions_[w[0]], positions_[w[2]] - positions_[w[0]])) / 2;
        area_.push_back(sum);
    }
    mates_.assign(welded_.size(), -1);
    for (auto& [ends, halves] : edges)
        if (halves.size() == 2) {
            mates_[size_t(halves[0])] = halves[1];
            mates_[size_t(halves[1])] = halves[0];
        }
}

std::optional<Vec3> MeshTracer::trace(uint32_t triangle, Vec3 at, Vec3 direction, double length) const {
    Vec3 p = corner(triangle, 0) * at.x + corner(triangle, 1) * at.y + corner(triangle, 2) * at.z;
    auto normalOf = [&](uint32_t t) {
        return glm::normalize(glm::cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)));
    };
    Vec3 n = normalOf(triangle);
    Vec3 d = glm::normalize(direction - n * glm::dot(n, direction));
    int entered = -1;
    for (int guard = 0; guard < 1000000; ++guard) {
        if (!std::isfinite(n.x) || !std::isfinite(d.x)) return std::nullopt;
        double reach = 1e300, along = 0;
        int out = -1;
        for (int k = 0; k < 3; ++k) {
            if (k == entered) continue;
            Vec3 a = corner(triangle, k), e = corner(triangle, (k + 1) % 3) - a;
            Vec3 outward = glm::cross(e, n);
            double speed = glm::dot(outward, d);
            if (speed <= 0) continue;
            double t = std::max(0.0, glm::dot(outward, a - p) / speed);
            if (t < reach) {
                reach = t;
                out = k;
                along = glm::dot(p + d * t - a, e) / glm::dot(e, e);
            }
        }
        if (out < 0) return std::nullopt;
        if (reach >= length) return p + d * length;
        if (along < 1e-9 || along > 1 - 1e-9) return std::nullopt;
        int64_t mate = mates_[triangle * 3 + uint32_t(out)];
        if (mate < 0) return std::nullopt;
        p += d * reach;
        length -= reach;
        Vec3 e = glm::normalize(corner(triangle, (out + 1) % 3) - corner(triangle, out));
        double parallel = glm::dot(d, e), across = glm::dot(d, glm::cross(e, n));
        uint32_t next = uint32_t(mate / 3);
        int edge = int(mate % 3);
        n = normalOf(next);
        // Neighbours of opposite winding: their edge runs the same way, and inward is on the other hand.
        Vec3 f = glm::normalize(corner(next, (edge + 1) % 3) - corner(next, edge));
        d = e * parallel + glm::cross(n, f) * across;
        d = glm::normalize(d - n * glm::dot(n, d));
        triangle = next;
        entered = edge;
    }
    return std::nullopt;
}

std::vector<Trial> MeshTracer::trials(const SurfaceData& surface, int count, double length, uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    double texel = 2.0 / surface.levels[0].size;
    std::vector<Trial> found;
    for (int tries = 0; int(found.size()) < count && tries < count * 50; ++tries) {
        double pick = unit(random) * area_.back();
        uint32_t t = uint32_t(std::lower_bound(area_.begin(), area_.end(), pick) - area_.begin());
        t = std::min(t, uint32_t(area_.size() - 1));
        double r = std::sqrt(unit(random)), s = unit(random);
        Vec3 at(1 - r, r * (1 - s), r * s);
        Vec3 p = corner(t, 0) * at.x + corner(t, 1) * at.y + corner(t, 2) * at.z;
        Vec3 a = corner(t, 1) - corner(t, 0), n = glm::normalize(glm::cross(a, corner(t, 2) - corner(t, 0)));
        a = glm::normalize(a);
        double angle = 2 * std::numbers::pi * unit(random);
        Vec3 d = a * std::cos(angle) + glm::cross(n, a) * std::sin(angle);
        if (!std::isfinite(d.x)) continue;
        Trial trial;
        trial.uv = vec2(uvs_[t * 3] * at.x + uvs_[t * 3 + 1] * at.y + uvs_[t * 3 + 2] * at.z);
        uint chart = chartAt(surface, trial.uv, p);
        if (chart == kNoIndex) continue;
        SurfaceRef ref = surfaceRef(surface);
        vec3 position, du, dv;
        if (!surfaceAt(SurfaceBuf{&ref}, 0, 0, chart, trial.uv, position, du, dv)) continue;
        if (glm::length(Vec3(position) - p) > texel * surface.charts[chart].metresPerUv) continue;
        auto end = trace(t, at, d, length);
        if (!end) continue;
        trial.place = chart;
        trial.direction = vec3(d);
        trial.length = float(length);
        trial.end = *end;
        found.push_back(trial);
    }
    return found;
}

}  // namespace espalier::walktest
