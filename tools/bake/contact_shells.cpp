// In: the mesh and how its borders are linked. Out: shells, bodies and the contacts between shells.
#include <algorithm>
#include <tuple>

#include "runtime/core/disjoint_sets.hpp"
#include "tools/bake/contact.hpp"

namespace espalier::bakery {
namespace {

constexpr double kBorderShift = 0.02;  // texels
constexpr double kRemainder = 0.01;    // of an edge
constexpr double kConcave = 3.05;      // radians: who turns less on the way around an edge comes to another piece

// The half-edges of edges that more than two share, edge by edge, each as its edge's key and itself.
std::vector<std::pair<uint64_t, uint32_t>> crowdedHalves(const BakeMesh& mesh) {
    std::vector<std::pair<uint64_t, uint32_t>> halves(mesh.twin.size());
    for (uint32_t h = 0; h < halves.size(); ++h) {
        const auto& p = mesh.triangles[h / 3].point;
        const auto [a, b] = std::minmax(p[h % 3], p[(h + 1) % 3]);
        halves[h] = {uint64_t(a) << 32 | b, h};
    }
    std::sort(halves.begin(), halves.end());
    size_t kept = 0;
    for (size_t i = 0, j = 0; i < halves.size(); i = j) {
        while (j < halves.size() && halves[j].first == halves[i].first) ++j;
        if (j - i > 2)
            kept = size_t(std::copy(halves.begin() + long(i), halves.begin() + long(j), halves.begin() + long(kept)) -
                          halves.begin());
    }
    halves.resize(kept);
    return halves;
}

// The twins by which triangles are one piece. Where a model's author has put pieces corner to corner, so that more than
// two triangles share an edge, a piece goes on flat or around its own edge; what lies in the way is another one.
std::vector<uint32_t> pieceTwins(const BakeMesh& mesh) {
    std::vector<uint32_t> twin = mesh.twin;
    if (mesh.crowdedEdges == 0) return twin;
    const auto halves = crowdedHalves(mesh);
    std::vector<std::tuple<double, uint32_t, uint32_t>> pairs;
    for (size_t i = 0, j = 0; i < halves.size(); i = j) {
        pairs.clear();
        for (; j < halves.size() && halves[j].first == halves[i].first; ++j) twin[halves[j].second] = kNone;
        for (size_t p = i; p < j; ++p)
            for (size_t q = p + 1; q < j; ++q) {
                const uint32_t a = halves[p].second, b = halves[q].second;
                if (mesh.pointAt(a) == mesh.pointAt(b)) continue;
                const double angle = outsideAngle(mesh, a, b);
                if (angle > kConcave) pairs.emplace_back(angle, a, b);
            }
        std::sort(pairs.begin(), pairs.end());
        for (auto [angle, a, b] : pairs)
            if (twin[a] == kNone && twin[b] == kNone) twin[a] = b, twin[b] = a;
    }
    return twin;
}

// Shells that borders join have one outside: not where a walk goes over to a back, nor by a remainder of an edge that
// another border has left over.
bool makesOneBody(const Link& link) {
    return link.kind == kCrossingNearest && link.to0 > link.to1 && link.from1 - link.from0 > kRemainder;
}

}  // namespace

Contacts::Contacts(const BakeMesh& mesh, const std::vector<Link>& links, const Options& options)
    : tolerance_(options.tolerance), texel_(options.texel) {
    if (!options.wanted) return;
    size_t count = mesh.triangles.size();
    mesh_.twin = pieceTwins(mesh);
    DisjointSets shells(count);
    for (uint32_t h = 0; h < mesh_.twin.size(); ++h)
        if (mesh_.twin[h] != kNone && mesh_.twin[h] > h) shells.join(h / 3, mesh_.twin[h] / 3);
    std::vector<uint32_t> shell, body;
    shells_ = shells.number(shell);
    if (shells_ < 2) return;
    DisjointSets bodies = shells;
    for (const Link& link : links)
        if (makesOneBody(link)) bodies.join(link.from / 3, link.to / 3);
    bodies.number(body);
    mesh_.points = mesh.points;
    if (mesh.crowdedEdges > 0) mesh_.seam = mesh.twin;
    mesh_.orientation = mesh.orientation;
    mesh_.chartBorder.resize(mesh.joined.size());
    for (size_t h = 0; h < mesh.joined.size(); ++h) mesh_.chartBorder[h] = !mesh.joined[h];
    mesh_.triangles.resize(count);
    for (uint32_t t = 0; t < count; ++t) {
        const Triangle& tri = mesh.triangles[t];
        mesh_.triangles[t] = {tri.point, tri.uv, tri.chart, shell[t], body[t], tri.bare};
    }
    setReach(mesh_, tolerance_);
    std::vector<float> open(mesh_.twin.size(), 0);
    for (const Link& link : links)
        if (link.to == kNone) open[link.from] += float(link.from1 - link.from0);
    for (size_t h = 0; h < open.size(); ++h)
        if ((mesh.twin[h] == kNone) != (mesh_.twin[h] == kNone)) open[h] = mesh_.twin[h] == kNone ? 1.0f : 0.0f;
    bodies_ = Bodies(mesh_, open);
    list_ = contactsWithin(mesh_, bodies_.tree(), {tolerance_, kBorderShift * options.texel});
    dropHidden();
    dropBehindLinks(mesh, links);
    keepFirstMet();
}

}  // namespace espalier::bakery
