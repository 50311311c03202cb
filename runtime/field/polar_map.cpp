// Each triangle that the front enters over an edge is laid into the plane in which the edge's two ends lie as far from
// a common source as their distances say. The straight line from that source to the third corner gives its distance,
// and the share of the edge's angle at which the line passes gives its angle.
#include "runtime/field/polar_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace espalier {
namespace {

using glm::dvec2;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTwoPi = 2 * std::numbers::pi;

double wrapped(double angle) {
    return angle - kTwoPi * std::round(angle / kTwoPi);
}

struct Arrival {
    double distance, angle;
};

class Front {
  public:
    Front(const FieldMesh& mesh, double reach, PolarMap& map)
        : mesh_(mesh), reach_(reach), map_(map), done_(mesh.positions.size(), false) {
        map_.distance.resize(mesh.positions.size(), kInfinity);
        map_.angle.resize(mesh.positions.size());
        for (const uint32_t v : map_.reached) map_.distance[v] = kInfinity;
        map_.reached.clear();
    }

    void run(uint32_t centre) {
        map_.distance[centre] = 0;
        map_.angle[centre] = 0;
        done_[centre] = true;
        map_.reached.push_back(centre);
        forEachCorner(centre, [&](uint32_t h) {
            offer(mesh_.to(h), {length(h), mesh_.angle[h]});
            // At a border one edge more arrives than leaves.
            const uint32_t before = FieldMesh::previous(h);
            if (mesh_.twin[before] == kNoIndex) offer(mesh_.from(before), {length(before), mesh_.angle[h] + tipOf(h)});
        });
        while (!open_.empty()) {
            const auto [distance, v] = open_.top();
            open_.pop();
            if (done_[v] || distance > map_.distance[v]) continue;
            done_[v] = true;
            map_.reached.push_back(v);
            forEachCorner(v, [&](uint32_t h) { spread(h); });
        }
    }

  private:
    template <class Visit>
    void forEachCorner(uint32_t v, const Visit& visit) {
        uint32_t h = mesh_.first[v];
        do {
            visit(h);
            h = mesh_.twin[FieldMesh::previous(h)];
        } while (h != kNoIndex && h != mesh_.first[v]);
    }
    double length(uint32_t h) const {
        return glm::length(mesh_.positions[mesh_.to(h)] - mesh_.positions[mesh_.from(h)]);
    }
    double tipOf(uint32_t h) const {
        const double a = length(h), b = length(FieldMesh::previous(h)), c = length(FieldMesh::next(h));
        return std::acos(std::clamp((a * a + b * b - c * c) / (2 * a * b), -1.0, 1.0));
    }
    void offer(uint32_t v, const Arrival& arrival) {
        if (done_[v] || !(arrival.distance < map_.distance[v]) || arrival.distance > reach_) return;
        map_.distance[v] = arrival.distance;
        map_.angle[v] = arrival.angle;
        open_.emplace(arrival.distance, v);
    }
    // All three edges of the corner's triangle, as far as both of their ends are done.
    void spread(uint32_t corner) {
        for (uint32_t h : {corner, FieldMesh::next(corner), FieldMesh::previous(corner)}) {
            if (!done_[mesh_.from(h)] || !done_[mesh_.to(h)]) continue;
            across(h);
            if (mesh_.twin[h] != kNoIndex) across(mesh_.twin[h]);
        }
    }
    // From the edge h into its own triangle.
    void across(uint32_t h) {
        const uint32_t a = mesh_.from(h), b = mesh_.to(h), c = mesh_.from(FieldMesh::previous(h));
        if (done_[c]) return;
        const double da = map_.distance[a], db = map_.distance[b], base = length(h);
        const double ca = length(FieldMesh::previous(h)), cb = length(FieldMesh::next(h));
        // a at the origin, b on the axis of x, c above, the source below.
        const double sx = (base * base + da * da - db * db) / (2 * base), s2 = da * da - sx * sx;
        const double cx = (base * base + ca * ca - cb * cb) / (2 * base), c2 = ca * ca - cx * cx;
        Arrival best = da + ca <= db + cb ? Arrival{da + ca, map_.angle[a]} : Arrival{db + cb, map_.angle[b]};
        if (s2 >= 0 && c2 > 0) {
            const dvec2 source(sx, -std::sqrt(s2)), at(cx, std::sqrt(c2));
            const double along = source.x + (at.x - source.x) * (-source.y) / std::max(at.y - source.y, 1e-300);
            if (along >= 0 && along <= base) best = straight(a, b, source, at, base);
        }
        offer(c, best);
    }
    Arrival straight(uint32_t a, uint32_t b, dvec2 source, dvec2 at, double base) const {
        const auto between = [&](dvec2 p, dvec2 q) {
            p -= source, q -= source;
            return std::atan2(std::abs(p.x * q.y - p.y * q.x), glm::dot(p, q));
        };
        const double whole = between({0, 0}, {base, 0}), part = between({0, 0}, at);
        const double distance = glm::length(at - source);
        if (map_.distance[a] == 0) return {distance, map_.angle[b]};
        if (map_.distance[b] == 0) return {distance, map_.angle[a]};
        const double turn = wrapped(map_.angle[b] - map_.angle[a]);
        return {distance, map_.angle[a] + (whole > 1e-12 ? turn * part / whole : 0)};
    }

    const FieldMesh& mesh_;
    const double reach_;
    PolarMap& map_;  // whatever a vertex is offered, it is done in the end
    std::vector<bool> done_;
    std::priority_queue<std::pair<double, uint32_t>, std::vector<std::pair<double, uint32_t>>, std::greater<>> open_;
};

}  // namespace

PolarMap polarMap(const FieldMesh& mesh, uint32_t centre, double reach) {
    PolarMap map;
    polarMap(mesh, centre, reach, map);
    return map;
}

void polarMap(const FieldMesh& mesh, uint32_t centre, double reach, PolarMap& map) {
    Front(mesh, reach, map).run(centre);
}

}  // namespace espalier
