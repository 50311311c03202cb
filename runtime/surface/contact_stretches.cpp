#include "runtime/surface/contact_stretches.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>

namespace espalier {
namespace {

using glm::dvec3;

constexpr double kOutlineCosine = 0.999;

// The parts of a stretch that come before and after another one.
void addBeside(const ContactStretch& f, const ContactStretch& other, std::vector<ContactStretch>& out) {
    const dvec3 a = f.segment.side[0].a, d = f.segment.side[0].b - a;
    const auto at = [&](dvec3 p) { return glm::dot(d, p - a) / glm::dot(d, d); };
    const double from = at(other.segment.side[0].a), to = at(other.segment.side[0].b);
    const auto addPart = [&](double low, double high) {
        if (!(low < high)) return;
        ContactStretch part = f;
        for (auto& side : part.segment.side) {
            const dvec3 start = side.a, along = side.b - side.a;
            if (low > 0) side.a = start + along * low;
            if (high < 1) side.b = start + along * high;
        }
        out.push_back(part);
    };
    addPart(0, std::min(from, 1.0));
    addPart(std::max(to, 0.0), 1);
}

// Adds what the stretches of one key make together; those that are gone come last.
void mergeKey(std::span<ContactStretch> found, std::vector<ContactStretch>& out) {
    const auto& first = found.front().segment.side[0];
    const dvec3 d = glm::normalize(first.b - first.a);
    for (ContactStretch& f : found)
        for (auto& side : f.segment.side)
            if (glm::dot(d, side.b - side.a) < 0) std::swap(side.a, side.b);
    const auto from = [&](const ContactStretch& f) { return glm::dot(d, f.segment.side[0].a); };
    const auto to = [&](const ContactStretch& f) { return glm::dot(d, f.segment.side[0].b); };
    std::stable_sort(found.begin(), found.end(), [&](const ContactStretch& x, const ContactStretch& y) {
        return std::make_pair(x.segment.gone, from(x)) < std::make_pair(y.segment.gone, from(y));
    });
    std::vector<ContactStretch> joined, left;
    for (const ContactStretch& f : found) {
        if (f.segment.gone) {
            left.clear();
            for (const ContactStretch& stretch : joined) addBeside(stretch, f, left);
            joined.swap(left);
        } else if (joined.empty() || from(f) > to(joined.back())) {
            joined.push_back(f);
        } else if (to(f) > to(joined.back())) {
            for (int s = 0; s < 2; ++s) joined.back().segment.side[s].b = f.segment.side[s].b;
        }
    }
    out.insert(out.end(), joined.begin(), joined.end());
}

// Stretches that were found by several pairs of triangles become one each.
void merge(std::vector<ContactStretch>& found) {
    std::sort(found.begin(), found.end(), [](const ContactStretch& x, const ContactStretch& y) {
        return std::tie(x.key, x.triangle) < std::tie(y.key, y.triangle);
    });
    std::vector<ContactStretch> out;
    for (size_t i = 0, j = 0; i < found.size(); i = j) {
        while (j < found.size() && found[j].key == found[i].key) ++j;
        if (j - i == 1)
            out.push_back(found[i]);
        else
            mergeKey({found.data() + i, j - i}, out);
    }
    found.swap(out);
}

void find(const ContactView& a, uint32_t i, const ContactView& b, uint32_t j, double scale,
          std::vector<ContactStretch>& found) {
    std::array<ContactSegment, 6> segments;
    int count = touch(a.shape(i, 1), b.shape(j, scale), segments);
    for (int k = 0; k < count; ++k) {
        const ContactSegment& s = segments[size_t(k)];
        found.push_back({{a.keyOf(i, s.side[0].edge), b.keyOf(j, s.side[1].edge)}, {i, j}, s});
    }
}

// A shell meets itself where one of its borders lies against the middle of its own: a wall of a welded house that ends
// at another one.
void findWithinShells(const ContactView& view, const BoxTree& tree, double tolerance,
                      std::vector<ContactStretch>& found) {
    const ContactMesh& mesh = view.mesh;
    auto shareAPoint = [&](uint32_t i, uint32_t j) {
        for (uint32_t p : mesh.triangles[i].point)
            if (std::count(mesh.triangles[j].point.begin(), mesh.triangles[j].point.end(), p) > 0) return true;
        return false;
    };
    for (uint32_t h = 0; h < mesh.twin.size(); ++h) {
        if (mesh.twin[h] != kNoIndex) continue;
        const uint32_t i = h / 3;
        Box edge;
        edge.add(mesh.at(i, h % 3)), edge.add(mesh.at(i, (h + 1) % 3));
        tree.near(edge.grown(tolerance), [&](uint32_t j) {
            if (mesh.triangles[i].shell != mesh.triangles[j].shell || shareAPoint(i, j)) return;
            std::vector<ContactStretch> all;
            find(view, i, view, j, 1, all);
            for (const ContactStretch& f : all)
                if (f.segment.side[0].edge == int(h % 3)) found.push_back(f);
        });
    }
}

}  // namespace

dvec3 ContactView::at(uint32_t triangle, uint32_t corner) const {
    dvec3 p = mesh.at(triangle, corner);
    return identity ? p : dvec3(map * glm::dvec4(p, 1));
}

dvec3 ContactView::normal(uint32_t t) const {
    return winding(t) * outward;
}

dvec3 ContactView::winding(uint32_t t) const {
    dvec3 a = at(t, 0), n = glm::cross(at(t, 1) - a, at(t, 2) - a);
    double length = glm::length(n);
    return length > 0 ? n / length : dvec3(0);
}

ContactShape ContactView::shape(uint32_t t, double scale) const {
    ContactShape s;
    s.normal = winding(t);
    for (uint32_t k = 0; k < 3; ++k) {
        s.p[k] = at(t, k);
        s.reach[k] = mesh.reach[mesh.triangles[t].point[k]] * scale;
        uint32_t twin = mesh.twin[t * 3 + k];
        s.outline[k] = twin == kNoIndex || glm::dot(s.normal, winding(twin / 3)) < kOutlineCosine;
    }
    return s;
}

uint64_t ContactView::keyOf(uint32_t t, int edge) const {
    if (edge < 0) return uint64_t(t) << 1;
    uint32_t h = t * 3 + uint32_t(edge), twin = mesh.twin[h];
    return uint64_t(std::min(h, twin)) << 1 | 1;
}

std::vector<ContactStretch> stretchesWithin(const ContactView& view, const BoxTree& tree, double tolerance) {
    const ContactMesh& mesh = view.mesh;
    std::vector<ContactStretch> found;
    tree.pairs(tolerance, [&](uint32_t i, uint32_t j) {
        if (mesh.triangles[i].shell == mesh.triangles[j].shell) return;
        if (mesh.triangles[i].shell > mesh.triangles[j].shell)
            std::swap(i, j);  // one order for all pairs of two shells
        find(view, i, view, j, 1, found);
    });
    findWithinShells(view, tree, tolerance, found);
    merge(found);
    return found;
}

std::vector<ContactStretch> stretchesBetween(const ContactView& a, const BoxTree& treeA, const ContactView& b,
                                             const BoxTree& treeB, double tolerance) {
    const double scale = std::cbrt(std::abs(glm::determinant(glm::dmat3(b.map))));
    std::vector<ContactStretch> found;
    treeA.pairs(treeB, b.map, tolerance, [&](uint32_t i, uint32_t j) { find(a, i, b, j, scale, found); });
    merge(found);
    return found;
}

}  // namespace espalier
