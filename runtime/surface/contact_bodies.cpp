// In: a mesh. Out: its solid bodies, and answers to whether a place is hidden by them. Rays count how often they leave
// a solid body more than they enter it.
#include "runtime/surface/contact_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/core/disjoint_sets.hpp"
#include "runtime/surface/triangle_distance.hpp"

namespace espalier {
namespace {

constexpr double kMostCap = 0.4;      // of a body's area: what is more open is a sheet
constexpr double kClosed = 0.95;      // of the rims of a body's holes: so much must lie against others to close them
constexpr double kFacing = 0.95;      // cosine: faces that cover one another
constexpr double kAbove = 0.1;        // of the tolerance: how far over a face its outside is looked at
constexpr double kSkin = 0.5;         // of the tolerance: how far before a face a skin still lies against it
constexpr double kSeenShare = 0.02;   // of a body's area: a lining shows no more
constexpr double kLevelShare = 0.02;  // of the tolerance: faces nearer to each other lie at one height
// Where on a triangle it is looked at, by the weights of its corners.
constexpr std::array<glm::dvec3, 7> kProbes = {{{0.34, 0.33, 0.33},
                                                {0.9, 0.05, 0.05},
                                                {0.05, 0.9, 0.05},
                                                {0.05, 0.05, 0.9},
                                                {0.475, 0.475, 0.05},
                                                {0.05, 0.475, 0.475},
                                                {0.475, 0.05, 0.475}}};
const glm::dvec3 kRays[3] = {{0.5377, 0.7483, 0.3883}, {-0.6157, 0.4621, -0.6382}, {0.2113, -0.8341, 0.5094}};

// 1 or -1 where the ray leaves or enters through a-b-c, else 0.
int passage(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c, glm::dvec3 origin, glm::dvec3 direction) {
    glm::dvec3 e1 = b - a, e2 = c - a, h = glm::cross(direction, e2);
    double det = glm::dot(e1, h);  // negative: the ray goes the way of the normal
    if (det == 0) return 0;
    glm::dvec3 s = origin - a, q = glm::cross(s, e1);
    double u = glm::dot(s, h) / det, v = glm::dot(direction, q) / det, t = glm::dot(e2, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t < 0) return 0;
    return det < 0 ? 1 : -1;
}

}  // namespace

Bodies::Bodies(ContactMesh& mesh, std::span<const float> open) : mesh_(&mesh), tree_(mesh.tree()) {
    uint32_t bodies = 0;
    for (const auto& t : mesh.triangles) bodies = std::max(bodies, t.body + 1);
    std::vector<double> area(bodies, 0), capArea(bodies, 0), volume(bodies, 0);
    std::vector<Wall> walls;
    auto add = [&](const Wall& w, bool cap) {
        glm::dvec3 n = glm::cross(w.b - w.a, w.c - w.a);
        (cap ? capArea : area)[w.body] += glm::length(n) / 2;
        volume[w.body] += glm::dot(w.a - mesh.points[0], n) / 6;
        walls.push_back(w);
    };
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
        add({mesh.at(t, 0), mesh.at(t, 1), mesh.at(t, 2), mesh.triangles[t].body}, false);

    // Each hole is closed by a fan around its middle; holes that share a point count as one.
    DisjointSets holes(mesh.points.size());
    std::vector<uint32_t> rim;
    auto start = [&](uint32_t h) { return mesh.triangles[h / 3].point[h % 3]; };
    auto end = [&](uint32_t h) { return mesh.triangles[h / 3].point[(h + 1) % 3]; };
    for (uint32_t h = 0; h < open.size(); ++h)
        if (open[h] > 0.5f) {
            rim.push_back(h);
            holes.join(start(h), end(h));
        }
    std::vector<glm::dvec4> middle(rim.empty() ? 0 : mesh.points.size(), glm::dvec4(0));
    for (uint32_t h : rim) {
        glm::dvec3 a = mesh.points[start(h)], b = mesh.points[end(h)];
        middle[holes.find(start(h))] += glm::dvec4((a + b) / 2.0, 1) * glm::length(b - a);
    }
    for (uint32_t h : rim) {
        glm::dvec4 m = middle[holes.find(start(h))];
        add({mesh.points[end(h)], mesh.points[start(h)], glm::dvec3(m) / m.w, mesh.triangles[h / 3].body}, true);
    }
    mesh.solid.resize(bodies);
    for (size_t b = 0; b < bodies; ++b) mesh.solid[b] = volume[b] > 0 && capArea[b] < kMostCap * area[b];
    buildSolids(walls);

    // What is flatter than the tolerance is a sheet that lies on another.
    const double tolerance = mesh.reach.empty() ? 0 : *std::max_element(mesh.reach.begin(), mesh.reach.end());
    std::vector<double> length(bodies, 0), closed(bodies, 0);
    for (uint32_t h : rim) {
        const uint32_t body = mesh.triangles[h / 3].body;
        if (mesh.solid[body] || volume[body] <= tolerance * capArea[body]) continue;
        const glm::dvec3 a = mesh.points[start(h)], b = mesh.points[end(h)];
        for (double t : {0.1, 0.5, 0.9}) {
            length[body] += glm::length(b - a);
            if (touched(a + (b - a) * t, body, tolerance)) closed[body] += glm::length(b - a);
        }
    }
    bool more = false;
    for (size_t b = 0; b < bodies; ++b)
        if (length[b] > 0 && closed[b] >= kClosed * length[b]) mesh.solid[b] = 1, more = true;
    if (more) buildSolids(walls);
    mesh.lining = findLinings(tolerance);
}

// A skin may lie a hair before the face that it lies against: its outside is looked at from two heights.
std::vector<uint8_t> Bodies::findLinings(double tolerance) const {
    const ContactMesh& mesh = *mesh_;
    const size_t bodies = mesh.solid.size();
    std::vector<double> area(bodies, 0), outside(bodies, 0);
    const auto normalOf = [&](uint32_t t) {
        return glm::cross(mesh.at(t, 1) - mesh.at(t, 0), mesh.at(t, 2) - mesh.at(t, 0));
    };
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) area[mesh.triangles[t].body] += glm::length(normalOf(t)) / 2;
    // Most bodies are seen at their first faces, and not asked further.
    for (uint32_t t = 0; t < mesh.triangles.size() && !solids_.empty(); ++t) {
        const uint32_t body = mesh.triangles[t].body;
        const glm::dvec3 n = normalOf(t);
        const double size = glm::length(n), share = size / 2 / double(kProbes.size());
        for (const glm::dvec3& at : kProbes) {
            if (!(size > 0) || outside[body] > kSeenShare * area[body]) break;
            const HiddenQuery query{mesh.at(t, 0) * at.x + mesh.at(t, 1) * at.y + mesh.at(t, 2) * at.z, n / size, body};
            if (!inside(query, kAbove * tolerance) && !inside(query, kSkin * tolerance)) outside[body] += share;
        }
    }
    std::vector<uint8_t> lining(bodies);
    for (size_t b = 0; b < bodies; ++b) lining[b] = !solids_.empty() && outside[b] <= kSeenShare * area[b];
    return lining;
}

void Bodies::buildSolids(const std::vector<Wall>& all) {
    solids_.clear();
    std::vector<uint32_t> place(mesh_->solid.size(), kNoIndex);
    for (const Wall& w : all) {
        if (!mesh_->solid[w.body]) continue;
        if (place[w.body] == kNoIndex) {
            place[w.body] = uint32_t(solids_.size());
            solids_.push_back({w.body, {}, {}});
        }
        solids_[place[w.body]].walls.push_back(w);
    }
    std::vector<Box> bounds;
    for (Solid& solid : solids_) {
        std::vector<Box> boxes(solid.walls.size());
        for (size_t i = 0; i < boxes.size(); ++i)
            boxes[i].add(solid.walls[i].a), boxes[i].add(solid.walls[i].b), boxes[i].add(solid.walls[i].c);
        solid.tree = BoxTree(std::move(boxes), {});
        bounds.push_back(solid.tree.bounds());
    }
    solidTree_ = BoxTree(std::move(bounds), {});
}

bool Bodies::meets(const Box& box) const {
    if (tree_.meets(box)) return true;
    bool met = false;
    solidTree_.near(box, [&](uint32_t i) { met = met || solids_[i].tree.meets(box); });
    return met;
}

bool Bodies::touched(glm::dvec3 p, uint32_t body, double tolerance) const {
    Box around;
    around.add(p);
    bool found = false;
    tree_.near(around.grown(tolerance), [&](uint32_t t) {
        if (!found && mesh_->triangles[t].body != body)
            found = distanceToTriangle(p, {mesh_->at(t, 0), mesh_->at(t, 1), mesh_->at(t, 2)}) <= tolerance;
    });
    return found || inside({p, glm::dvec3(0), body}, 0);
}

bool Bodies::Solid::encloses(glm::dvec3 p, glm::dvec3 ray) const {
    int count = 0;
    tree.along(p, ray, [&](uint32_t i) { count += passage(walls[i].a, walls[i].b, walls[i].c, p, ray); });
    return count > 0;
}

// Two rays that agree decide; a ray along an edge may err.
bool Bodies::Solid::encloses(glm::dvec3 p) const {
    const bool first = encloses(p, kRays[0]);
    return encloses(p, kRays[1]) == first ? first : encloses(p, kRays[2]);
}

bool Bodies::inside(const HiddenQuery& q, double above) const {
    const glm::dvec3 p = q.position + q.normal * above;
    Box place;
    place.add(p);
    bool found = false;
    solidTree_.near(place, [&](uint32_t i) {
        const Solid& s = solids_[i];
        found = found || (s.body != q.body && s.body != q.except && s.encloses(p));
    });
    return found;
}

bool Bodies::covered(const HiddenQuery& q, double tolerance) const {
    Box around;
    around.add(q.position);
    bool found = false;
    tree_.near(around.grown(tolerance), [&](uint32_t t) {
        const auto& other = mesh_->triangles[t];
        if (found || other.body == q.body || other.body == q.except || mesh_->lining[other.body]) return;
        glm::dvec3 a = mesh_->at(t, 0), n = glm::cross(mesh_->at(t, 1) - a, mesh_->at(t, 2) - a);
        n /= std::max(glm::length(n), 1e-300);
        double facing = glm::dot(q.normal, n);
        if (std::abs(facing) < kFacing) return;
        // Sheets back to back, as double-sided ones are made, hide nothing; nor does a solid's face what stands off it.
        if (facing < 0 && (!q.solid || mesh_->solid[other.body])) return;
        double above = glm::dot(n, a - q.position) * (facing > 0 ? 1 : -1);
        if (std::abs(above) > tolerance) return;
        for (uint32_t k = 0; k < 3; ++k) {
            glm::dvec3 corner = mesh_->at(t, k), e = mesh_->at(t, (k + 1) % 3) - corner;
            if (glm::dot(glm::cross(n, e), q.position - corner) < 0) return;
        }
        double level = kLevelShare * tolerance;
        bool first = q.body == kNoIndex ? q.yields : other.body < q.body;
        found = facing < 0 || above > level || (above > -level && first);
    });
    return found;
}

bool Bodies::hide(const HiddenQuery& q, double tolerance, bool crevices) const {
    if (tree_.empty()) return false;
    if (!crevices) return inside(q, kAbove * tolerance) || covered(q, kAbove * tolerance);
    return inside(q, kAbove * tolerance) || inside(q, 1.5 * tolerance) || covered(q, tolerance);
}

}  // namespace espalier
