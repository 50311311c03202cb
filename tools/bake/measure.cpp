// In: the finished surface. Out: the report's figures. Crossings are judged by the records that a walk reads: over
// a seam, and from the texel there back by that texel's own list.
#include <algorithm>
#include <cmath>

#include "shaders/shared/surface_lookup.h"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/quantile.hpp"

namespace espalier::bakery {
namespace {

constexpr int kProbesOfCrossing = 3;  // per crossing
constexpr float kPlace = 0.03f;       // texels: a shorter target is one place, not a stretch

double percentile(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    size_t at = std::min(values.size() - 1, size_t(share * double(values.size())));
    std::nth_element(values.begin(), values.begin() + long(at), values.end());
    return values[at];
}

double fraction(uint32_t seed) {
    seed = (seed ^ 61u) ^ (seed >> 16);
    seed *= 9u;
    seed ^= seed >> 4;
    seed *= 0x27d4eb2du;
    seed ^= seed >> 15;
    return (double(seed) + 0.5) / 4294967296.0;
}

glm::dvec3 onTriangle(const TrianglePlane& t, glm::dvec2 uv) {
    glm::dvec2 d = uv - glm::dvec2(t.uv0);
    return glm::dvec3(t.position) + glm::dvec3(t.du) * d.x + glm::dvec3(t.dv) * d.y;
}

glm::dvec2 mixed(glm::vec2 a, glm::vec2 b, double t) {
    return glm::dvec2(a) + glm::dvec2(b - a) * t;
}

struct Back {
    double distance = 1e300;  // from where the walk arrives to the segment that leads back, texels
    double error = 1e300;     // texels
};

// From uv in `chart` back into `home`, by the list of the texel at uv.
Back wayBack(const SurfaceData& surface, glm::dvec2 uv, uint32_t chart, uint32_t home, glm::dvec2 from) {
    const SurfaceLevelData& level = surface.levels[0];
    uint32_t size = level.size;
    uint32_t x = uint32_t(std::clamp(uv.x * size, 0.0, size - 1.0)),
             y = uint32_t(std::clamp(uv.y * size, 0.0, size - 1.0));
    uint32_t at = texelIndex(size, x, y);
    Back best;
    if (texelClass(level.texels[at].bits) == kTexelEmpty || texelChart(level.texels[at].bits) != chart) return best;
    uint32_t head = level.crossingHead[at];
    for (uint32_t i = 0; i < (head & 255u); ++i) {
        const Crossing& c = surface.crossings[level.crossingRefs[(head >> 8) + i]];
        if ((c.flags & 3u) == kCrossingOpen || (c.target & 0xFFFFu) != home) continue;
        glm::dvec2 a(c.a), d = glm::dvec2(c.b) - a;
        double t = std::clamp(glm::dot(uv - a, d) / std::max(glm::dot(d, d), 1e-300), 0.0, 1.0);
        double distance = glm::length(uv - (a + d * t)) * size;
        double error = glm::length(mixed(c.ta, c.tb, t) - from) * size;
        // At a corner several segments are equally near: the walk's side decides, here the better.
        if (distance < best.distance - 1e-3 || (distance < best.distance + 1e-3 && error < best.error))
            best = {std::min(distance, best.distance), error};
    }
    return best;
}

// Is the texel in front of a crossing's middle ground?
bool beginsOnGround(const SurfaceData& surface, const Crossing& c) {
    const SurfaceLevelData& level = surface.levels[0];
    const glm::vec2 d = c.b - c.a,
                    inward = glm::vec2(-d.y, d.x) * ((c.flags & kCrossingInsideLeft) != 0 ? 1.0f : -1.0f);
    const glm::vec2 at = (c.a + c.b) * 0.5f + inward / (std::max(glm::length(d), 1e-30f) * float(level.size));
    return texelClass(level.texels[texelAt(level.size, at)].bits) == kTexelInner;
}

void measureCrossings(const std::vector<Sides>& sides, const SurfaceData& surface, BakeReport& report) {
    std::vector<double> trips, gaps;
    double size = surface.levels[0].size;
    for (uint32_t i = 0; i < surface.crossings.size(); ++i) {
        const Crossing& c = surface.crossings[i];
        uint32_t kind = c.flags & 3u;
        if (kind == kCrossingOpen) continue;
        (kind == kCrossingSeam      ? report.seamCrossings
         : kind == kCrossingNearest ? report.nearestCrossings
                                    : report.contactCrossings)++;
        const TrianglePlane &here = surface.triangles[sides[i].from], &there = surface.triangles[sides[i].to];
        bool dangling = false;
        for (int probe = 0; probe < kProbesOfCrossing; ++probe) {
            double t = fraction(i * kProbesOfCrossing + uint32_t(probe));
            glm::dvec2 p = mixed(c.a, c.b, t), q = mixed(c.ta, c.tb, t);
            Back back = wayBack(surface, q, c.target & 0xFFFFu, here.chart, p);
            if (back.distance > 0.5) {
                dangling = true;
                continue;
            }
            if (kind != kCrossingSeam) continue;
            trips.push_back(back.error);
            double texel = std::sqrt(glm::length(glm::cross(glm::dvec3(here.du), glm::dvec3(here.dv)))) / size;
            gaps.push_back(glm::length(onTriangle(here, p) - onTriangle(there, q)) / texel);
        }
        // From the back of a sheet no way leads back: there walks are on its outside. The end of a contact that leads
        // to one place of a border is judged with its middle. Out of what is buried ways lead, and none there.
        if (dangling && (c.flags & kCrossingTurned) == 0 && glm::length(c.tb - c.ta) * float(size) > kPlace &&
            (kind != kCrossingContact || beginsOnGround(surface, c)))
            ++(kind == kCrossingContact ? report.danglingContacts : report.danglingCrossings);
    }
    report.roundTrip50 = percentile(trips, 0.5);
    report.roundTrip999 = percentile(trips, 0.999);
    report.gap999 = percentile(gaps, 0.999);
}

struct Weighted {
    double value, area;
};

Distortion spread(std::vector<Weighted>& all, double total) {
    const auto less = [](const Weighted& a, const Weighted& b) { return a.value < b.value; };
    const double most = std::max_element(all.begin(), all.end(), less)->value;
    return {quantile(all, total * 0.5), quantile(all, total * 0.95), most};
}

void measureMaterials(const Model& model, const BakeMesh& mesh, BakeReport& report) {
    for (size_t m = 0; m < model.materials.size(); ++m)
        report.materials.push_back(
            {m < model.materialNames.size() ? model.materialNames[m] : "", 0, model.materials[m].bare});
    for (const Triangle& t : mesh.triangles) {
        const size_t m = model.triangleMaterial.empty() ? 0 : model.triangleMaterial[t.source];
        if (m < report.materials.size()) report.materials[m].area += area3(mesh, t);
    }
}

}  // namespace

void measureStretch(const BakeMesh& mesh, const SurfaceData& surface, BakeReport& report) {
    std::vector<Weighted> worst, ofArea, ofAngle;
    double total = 0;
    const auto add = [](std::vector<Weighted>& to, double more, double less, double area) {
        to.push_back({std::min(std::max(more, 1 / std::max(less, 1e-6)), 1e6), area});
    };
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
        const TrianglePlane& plane = surface.triangles[t];
        double uu = glm::dot(glm::dvec3(plane.du), glm::dvec3(plane.du)),
               vv = glm::dot(glm::dvec3(plane.dv), glm::dvec3(plane.dv));
        double uv = glm::dot(glm::dvec3(plane.du), glm::dvec3(plane.dv));
        double mean = (uu + vv) / 2, half = std::sqrt((uu - vv) * (uu - vv) / 4 + uv * uv);
        double scale = surface.charts[plane.chart].metresPerUv;
        double most = std::sqrt(mean + half) / scale, least = std::sqrt(std::max(mean - half, 0.0)) / scale;
        double area = area3(mesh, mesh.triangles[t]);
        add(worst, most, least, area);
        add(ofArea, most * least, most * least, area);
        add(ofAngle, most / std::max(least, 1e-6), 1, area);
        total += area;
    }
    const Distortion stretch = spread(worst, total);
    report.stretch50 = stretch.p50, report.stretch95 = stretch.p95, report.stretchMax = stretch.max;
    report.ofArea = spread(ofArea, total);
    report.ofAngle = spread(ofAngle, total);
    report.charted = std::min(1.0, total / (mesh.area - mesh.copied));
}

void measure(const Model& model, const BakeMesh& mesh, const std::vector<Sides>& sides, const MeshTree& drawn,
             const SurfaceData& surface, BakeReport& report) {
    report.triangles = uint32_t(mesh.triangles.size());
    report.charts = mesh.chartCount();
    for (const Texel& t : surface.levels[0].texels) {
        uint32_t kind = texelClass(t.bits);
        report.innerTexels += kind == kTexelInner;
        report.linkTexels += kind == kTexelLink;
        report.openTexels += kind == kTexelOpen;
    }
    report.linkTexels -= report.buriedTexels + report.bareTexels;
    for (const Triangle& t : mesh.triangles) report.walkableArea += t.bare ? 0 : area3(mesh, t);
    measureMaterials(model, mesh, report);
    measureCrossings(sides, surface, report);
    report.pieces = measureReach(mesh, sides, drawn, surface);
}

}  // namespace espalier::bakery
