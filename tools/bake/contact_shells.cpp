// In: the mesh and how its borders are linked. Out: shells, bodies and the contacts between shells.
#include "runtime/core/disjoint_sets.hpp"
#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBorderShift = 0.02;  // texels

}  // namespace

Contacts::Contacts(const BakeMesh& mesh, const std::vector<Link>& links, const Options& options)
    : tolerance_(options.tolerance) {
    if (!options.wanted) return;
    size_t count = mesh.triangles.size();
    DisjointSets shells(count);
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone && mesh.twin[h] > h) shells.join(h / 3, mesh.twin[h] / 3);
    std::vector<uint32_t> shell, body;
    shells_ = shells.number(shell);
    if (shells_ < 2) return;
    DisjointSets bodies = shells;
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
