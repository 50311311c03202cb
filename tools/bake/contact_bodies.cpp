// In: the mesh and how its borders are linked. Out: shells and bodies, which bodies are solid, the contacts between
// shells. A body is solid when it encloses room, open undersides closed by fans: kits leave out what stands on the
// ground.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBorderShift = 0.02;  // texels
constexpr double kMostCap = 0.4;       // of a body's area: what is more open is a sheet

struct Sets {
    std::vector<uint32_t> parent;
    explicit Sets(size_t n) : parent(n) { std::iota(parent.begin(), parent.end(), 0u); }
    uint32_t find(uint32_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parent[std::max(a, b)] = std::min(a, b);
    }
    // Numbers the sets by their first member.
    uint32_t number(std::vector<uint32_t>& out) {
        uint32_t count = 0;
        out.assign(parent.size(), kNone);
        for (uint32_t i = 0; i < parent.size(); ++i) {
            uint32_t root = find(i);
            out[i] = root == i ? count++ : out[root];
        }
        return count;
    }
};

}  // namespace

Contacts::Contacts(const BakeMesh& mesh, const std::vector<Link>& links, double tolerance, double texel)
    : tolerance_(tolerance) {
    findShells(mesh, links);
    if (shells_ < 2) return;
    setReach(mesh_, tolerance);
    closeBodies(links);
    tree_ = mesh_.tree();
    list_ = contactsWithin(mesh_, tree_, {tolerance, kBorderShift * texel, glm::dmat4(1)});
}

void Contacts::findShells(const BakeMesh& mesh, const std::vector<Link>& links) {
    size_t count = mesh.triangles.size();
    Sets shells(count);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone && mesh.twin[h] > h) shells.join(h / 3, mesh.twin[h] / 3);
    std::vector<uint32_t> shell, body;
    shells_ = shells.number(shell);
    if (shells_ < 2) return;
    Sets bodies = shells;
    for (const Link& link : links)
        if (link.to != kNone) bodies.join(link.from / 3, link.to / 3);
    uint32_t bodyCount = bodies.number(body);
    mesh_.points = mesh.points;
    mesh_.twin = mesh.twin;
    mesh_.orientation = mesh.orientation;
    mesh_.solid.assign(bodyCount, 0);
    mesh_.chartBorder.resize(mesh.joined.size());
    for (size_t h = 0; h < mesh.joined.size(); ++h) mesh_.chartBorder[h] = !mesh.joined[h];
    mesh_.triangles.resize(count);
    normals_.resize(count);
    for (uint32_t t = 0; t < count; ++t) {
        const Triangle& tri = mesh.triangles[t];
        mesh_.triangles[t] = {tri.point, tri.uv, tri.chart, shell[t], body[t]};
        glm::dvec3 a = mesh_.at(t, 0), n = glm::cross(mesh_.at(t, 1) - a, mesh_.at(t, 2) - a);
        normals_[t] = n / std::max(glm::length(n), 1e-300);
    }
}

void Contacts::closeBodies(const std::vector<Link>& links) {
    size_t bodies = mesh_.solid.size();
    std::vector<double> area(bodies, 0), capArea(bodies, 0), volume(bodies, 0);
    auto add = [&](const Cap& c, bool cap) {
        glm::dvec3 n = glm::cross(c.b - c.a, c.c - c.a);
        (cap ? capArea : area)[c.body] += glm::length(n) / 2;
        volume[c.body] += glm::dot(c.a - mesh_.points[0], n) / 6;
        walls_.push_back(c);
    };
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t)
        add({mesh_.at(t, 0), mesh_.at(t, 1), mesh_.at(t, 2), mesh_.triangles[t].body}, false);

    // Each hole is closed by a fan around its middle; holes that share a point count as one.
    std::vector<double> open(mesh_.twin.size(), 0);
    for (const Link& link : links)
        if (link.to == kNone) open[link.from] += link.from1 - link.from0;
    Sets holes(mesh_.points.size());
    std::vector<uint32_t> rim;
    auto start = [&](uint32_t h) { return mesh_.triangles[h / 3].point[h % 3]; };
    for (uint32_t h = 0; h < open.size(); ++h)
        if (open[h] > 0.5) {
            rim.push_back(h);
            holes.join(start(h), start(BakeMesh::next(h)));
        }
    std::vector<glm::dvec3> middle(rim.empty() ? 0 : mesh_.points.size(), glm::dvec3(0));
    std::vector<double> weight(middle.size(), 0);
    for (uint32_t h : rim) {
        glm::dvec3 a = mesh_.points[start(h)], b = mesh_.points[start(BakeMesh::next(h))];
        middle[holes.find(start(h))] += (a + b) * (glm::length(b - a) / 2);
        weight[holes.find(start(h))] += glm::length(b - a);
    }
    for (uint32_t h : rim) {
        uint32_t hole = holes.find(start(h));
        add({mesh_.points[start(BakeMesh::next(h))], mesh_.points[start(h)], middle[hole] / weight[hole],
             mesh_.triangles[h / 3].body},
            true);
    }
    for (size_t b = 0; b < bodies; ++b) mesh_.solid[b] = volume[b] > 0 && capArea[b] < kMostCap * area[b];
    std::erase_if(walls_, [&](const Cap& c) { return !mesh_.solid[c.body]; });
    std::vector<Box> boxes(walls_.size());
    for (size_t i = 0; i < boxes.size(); ++i)
        boxes[i].add(walls_[i].a), boxes[i].add(walls_[i].b), boxes[i].add(walls_[i].c);
    wallTree_ = BoxTree(std::move(boxes), {});
}

}  // namespace espalier::bakery
