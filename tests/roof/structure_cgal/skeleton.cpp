#include "tests/roof/structure_cgal/skeleton.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/create_straight_skeleton_from_polygon_with_holes_2.h>

#include <algorithm>
#include <cmath>

namespace espalier::test {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Polygon = CGAL::Polygon_2<Kernel>;
using Skeleton = CGAL::Straight_skeleton_2<Kernel>;

auto skeletonOf(const std::vector<std::vector<glm::dvec2>>& rings) {
    auto polygon = [](const std::vector<glm::dvec2>& ring) {
        Polygon p;
        for (glm::dvec2 q : ring) p.push_back({q.x, q.y});
        return p;
    };
    CGAL::Polygon_with_holes_2<Kernel> whole(polygon(rings[0]));
    for (size_t i = 1; i < rings.size(); i++) whole.add_hole(polygon(rings[i]));
    return CGAL::create_interior_straight_skeleton_2(whole);
}

bool inside(const std::vector<glm::dvec2>& ring, glm::dvec2 p) {
    bool in = false;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        glm::dvec2 a = ring[i], b = ring[j];
        if ((a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x) in = !in;
    }
    return in;
}

}  // namespace

size_t cgalFaces(const std::vector<std::vector<glm::dvec2>>& rings) {
    auto skeleton = skeletonOf(rings);
    return skeleton ? skeleton->size_of_faces() : 0;
}

CgalSkeleton cgalSkeleton(const std::vector<std::vector<glm::dvec2>>& rings) {
    CgalSkeleton out;
    auto skeleton = skeletonOf(rings);
    if (!skeleton) return out;
    for (auto f = skeleton->faces_begin(); f != skeleton->faces_end(); ++f) {
        auto first = f->halfedge(), h = first;
        CgalSkeleton::Face face{};
        auto at = [](auto vertex) { return glm::dvec2(vertex->point().x(), vertex->point().y()); };
        do {
            if (!h->is_bisector()) face.a = at(h->opposite()->vertex()), face.b = at(h->vertex());
            face.outline.push_back(at(h->vertex()));
            h = h->next();
        } while (h != first);
        out.faces.push_back(std::move(face));
    }
    return out;
}

double CgalSkeleton::heightAt(glm::dvec2 p) const {
    for (const Face& f : faces) {
        if (!inside(f.outline, p)) continue;
        glm::dvec2 d = f.b - f.a, q = p - f.a;
        return std::abs(d.x * q.y - d.y * q.x) / glm::length(d);
    }
    return NAN;
}

}  // namespace espalier::test
