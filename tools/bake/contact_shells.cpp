// In: the mesh and how its borders are linked. Out: shells, bodies and the contacts between shells.
#include <algorithm>
#include <numeric>

#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBorderShift = 0.02;  // texels

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

Contacts::Contacts(const BakeMesh& mesh, const std::vector<Link>& links, const Options& options)
    : tolerance_(options.tolerance) {
    if (!options.wanted) return;
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
    bodies.number(body);
    mesh_.points = mesh.points;
    mesh_.twin = mesh.twin;
    mesh_.orientation = mesh.orientation;
    mesh_.chartBorder.resize(mesh.joined.size());
    for (size_t h = 0; h < mesh.joined.size(); ++h) mesh_.chartBorder[h] = !mesh.joined[h];
    mesh_.triangles.resize(count);
    for (uint32_t t = 0; t < count; ++t) {
        const Triangle& tri = mesh.triangles[t];
        mesh_.triangles[t] = {tri.point, tri.uv, tri.chart, shell[t], body[t]};
    }
    setReach(mesh_, tolerance_);
    std::vector<float> open(mesh_.twin.size(), 0);
    for (const Link& link : links)
        if (link.to == kNone) open[link.from] += float(link.from1 - link.from0);
    bodies_ = Bodies(mesh_, open);
    list_ = contactsWithin(mesh_, bodies_.tree(), {tolerance_, kBorderShift * options.texel});
    dropHidden();
}

}  // namespace espalier::bakery
