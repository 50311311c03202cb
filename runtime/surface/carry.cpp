// In: two surfaces, and layers over the first or places on it. Out: the layers over the second, texel by texel from the
// nearest place of the first's mesh, and what found no place.
#include "runtime/surface/carry.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "runtime/surface/box_tree.hpp"

namespace espalier {
namespace {

constexpr double kAgreeing = 0.5;  // cosine between the outsides of what is one place
constexpr double kRadiusShare = 0.01;
constexpr double kTexels = 2;

double texelOf(const SurfaceData& surface) {
    double area = 0, uv = 0;
    for (const Chart& c : surface.charts) area += c.area, uv += c.area / (double(c.metresPerUv) * c.metresPerUv);
    return uv > 0 ? std::sqrt(area / uv) / surface.levels[0].size : 0;
}

double usualReach(const SurfaceData& from, const SurfaceData& to) {
    return std::max(kRadiusShare * double(glm::length(to.boundsMax - to.boundsMin)) / 2,
                    kTexels * std::max(texelOf(from), texelOf(to)));
}

// The mesh of a surface to look up nearest places on, all of them in the space of a surface with another origin.
class Target {
  public:
    Target(const SurfaceData& surface, glm::dvec3 origin) : surface_(surface), shift_(surface.origin - origin) {
        std::vector<Box> boxes(surface.indices.size() / 3);
        for (uint32_t t = 0; t < boxes.size(); ++t)
            for (uint32_t k = 0; k < 3; ++k) boxes[t].add(placeOf(vertex(t, k)));
        tree_ = BoxTree(std::move(boxes), {});
    }

    struct Place {
        glm::vec2 uv{-1};  // x < 0: none is near
        glm::dvec3 position{0}, outside{0};
    };
    // The nearest place whose outside points the way of `normal`; a normal of 0: any.
    Place nearest(glm::dvec3 p, glm::dvec3 normal, double within) const {
        Place found;
        if (tree_.empty()) return found;
        double best = within * within;
        tree_.nearestSquare(
            p,
            [&](uint32_t t) {
                const DrawVertex &a = vertex(t, 0), &b = vertex(t, 1), &c = vertex(t, 2);
                const glm::dvec3 outside(a.normal + b.normal + c.normal);
                const bool faces = glm::dot(outside, normal) > kAgreeing * glm::length(outside);
                if (!faces && normal != glm::dvec3(0)) return 1e300;
                const glm::dvec3 w = weights(p, placeOf(a), placeOf(b), placeOf(c));
                const glm::dvec3 at = placeOf(a) * w.x + placeOf(b) * w.y + placeOf(c) * w.z;
                const double far = glm::dot(at - p, at - p);
                if (far >= best) return far;
                best = far;
                found = {a.walkUv * float(w.x) + b.walkUv * float(w.y) + c.walkUv * float(w.z), at,
                         outside / std::max(glm::length(outside), 1e-30)};
                return far;
            },
            best);
        return found;
    }

  private:
    glm::dvec3 placeOf(const DrawVertex& v) const { return glm::dvec3(v.position) + shift_; }
    const DrawVertex& vertex(uint32_t t, uint32_t k) const { return surface_.vertices[surface_.indices[t * 3 + k]]; }

    // Of the corners, at the point of the triangle that is nearest to p.
    static glm::dvec3 weights(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
        const glm::dvec3 corner[3] = {a, b, c}, n = glm::cross(b - a, c - a);
        const double area2 = glm::dot(n, n);
        glm::dvec3 w(glm::dot(glm::cross(c - b, p - b), n), glm::dot(glm::cross(a - c, p - c), n), 0);
        w.z = area2 - w.x - w.y;
        if (area2 > 0 && w.x >= 0 && w.y >= 0 && w.z >= 0) return w / area2;
        glm::dvec3 best(1, 0, 0);
        double least = 1e300;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 from = corner[k], e = corner[(k + 1) % 3] - from;
            const double t = std::clamp(glm::dot(p - from, e) / std::max(glm::dot(e, e), 1e-300), 0.0, 1.0);
            const double far = glm::length(from + e * t - p);
            if (far >= least) continue;
            least = far;
            best = glm::dvec3(0);
            best[k] = 1 - t, best[(k + 1) % 3] = t;
        }
        return best;
    }

    const SurfaceData& surface_;
    const glm::dvec3 shift_;
    BoxTree tree_;
};

}  // namespace

std::vector<SurfaceMatch::Ground> SurfaceMatch::match(const SurfaceData& here, const SurfaceData& there,
                                                      double within) {
    const SurfaceLevelData& level = here.levels[0];
    std::vector<Ground> ground;  // and gutters, which reads at a border take in
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x)
            if (texelClass(level.texels[texelIndex(level.size, x, y)].bits) != kTexelEmpty)
                ground.push_back({x, y, 0, glm::vec2(-1)});
    const Target target(there, here.origin);
    parallelFor(ground.size(), 4096, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            Ground& g = ground[i];
            const uint32_t at = texelIndex(level.size, g.x, g.y);
            const TrianglePlane& plane = here.triangles[level.aux[at].triangle];
            const glm::dvec3 across = glm::cross(glm::dvec3(plane.du), glm::dvec3(plane.dv));
            if (texelClass(level.texels[at].bits) == kTexelInner)
                g.area = float(glm::length(across) / (double(level.size) * level.size));
            const glm::dvec3 outside = glm::normalize(across) * double(here.charts[plane.chart].orientation);
            g.other = target.nearest(glm::dvec3(level.texels[at].position), outside, within).uv;
        }
    });
    return ground;
}

SurfaceMatch::SurfaceMatch(const SurfaceData& from, const SurfaceData& to, double within)
    : size_(to.levels[0].size), oldSize_(from.levels[0].size) {
    if (!(within > 0)) within = usualReach(from, to);
    new_ = match(to, from, within);
    old_ = match(from, to, within);
}

CarriedLayer SurfaceMatch::carry(const UvPicture& layer, float fresh) const {
    CarriedLayer out;
    out.layer = {size_, size_, std::vector<float>(size_t(size_) * size_, 0.0f)};
    for (const Ground& g : new_) {
        const bool isFresh = g.other.x < 0;
        if (isFresh) out.fresh += g.area;
        out.layer.texels[size_t(g.y) * size_ + g.x] = isFresh ? fresh : layer.at(g.other);
    }
    for (const Ground& g : old_)
        if (g.other.x < 0 && layer.at((glm::vec2(g.x, g.y) + 0.5f) / float(oldSize_)) > 0) out.lost += g.area;
    return out;
}

std::vector<CarriedPlace> carryPlaces(const SurfaceData& from, const SurfaceData& to, std::span<const glm::vec3> places,
                                      double within) {
    if (!(within > 0)) within = usualReach(from, to);
    const Target before(from, from.origin), after(to, from.origin);
    std::vector<CarriedPlace> out;
    for (const glm::vec3& place : places) {
        const Target::Place stood = before.nearest(glm::dvec3(place), glm::dvec3(0), 1e30);
        const bool lost = stood.uv.x < 0 || after.nearest(stood.position, stood.outside, within).uv.x < 0;
        out.push_back({float(glm::length(stood.position - glm::dvec3(place))), lost});
    }
    return out;
}

}  // namespace espalier
