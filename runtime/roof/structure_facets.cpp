// In: the skeleton's arcs. Out: facets as closed loops of sides with twins, without anything that has no length.
#include "runtime/roof/structure_facets.hpp"

#include <numeric>

namespace espalier {

uint32_t Facets::addSide(uint32_t from, uint32_t facet, bool eave) {
    sides.push_back({from, facet, kNone, kNone, kNone, eave, false});
    return uint32_t(sides.size() - 1);
}

void Facets::link(uint32_t a, uint32_t b) {
    sides[a].next = b;
    sides[b].previous = a;
}

void Facets::pair(uint32_t a, uint32_t b) {
    if (a != kNone) sides[a].twin = b;
    if (b != kNone) sides[b].twin = a;
}

uint32_t Facets::splitSide(uint32_t side, uint32_t point) {
    uint32_t twin = sides[side].twin;
    uint32_t second = addSide(point, sides[side].facet, sides[side].eave);
    link(second, sides[side].next);
    link(side, second);
    if (twin == kNone) return second;
    uint32_t twinSecond = addSide(point, sides[twin].facet, sides[twin].eave);
    link(twinSecond, sides[twin].next);
    link(twin, twinSecond);
    pair(side, twinSecond);
    pair(second, twin);
    return second;
}

bool facetsOf(const Skeleton& skeleton, const std::vector<double>& slopes, Facets& out) {
    out.points = skeleton.nodes;
    out.sides.clear();
    out.facets.clear();
    out.sides.reserve(skeleton.faces.size() + 2 * skeleton.arcs.size());
    std::vector<uint32_t> ends;  // a side each
    for (uint32_t f = 0; f < skeleton.faces.size(); f++) {
        const SkeletonFace& face = skeleton.faces[f];
        glm::dvec3 a = skeleton.nodes[face.eaveFrom], b = skeleton.nodes[face.eaveTo];
        glm::dvec2 corner = skeleton.nodes[face.edge], along(0);
        // The edge's own direction: a face above a break may begin at a point.
        const SkeletonFace& edge = skeleton.faces[face.edge];
        along = glm::normalize(glm::dvec2(skeleton.nodes[edge.eaveTo]) - corner);
        FaceKind kind = slopes[f] > 0 ? FaceKind::slope : slopes[f] < 0 ? FaceKind::gable : FaceKind::flat;
        out.facets.push_back(
            {face.edge, face.tier, kind, std::max(slopes[f], 0.0), {a, b}, along, {-along.y, along.x}, kNone});
        if (face.tier != 0) continue;
        out.facets[f].side = out.addSide(face.eaveFrom, f, true);
        ends.push_back(face.eaveTo);
    }
    for (const SkeletonArc& arc : skeleton.arcs) {
        const SkeletonFace& right = skeleton.faces[arc.right];
        bool eave = right.tier != 0 && arc.from == right.eaveTo && arc.to == right.eaveFrom;
        uint32_t a = out.addSide(arc.from, arc.left, false), b = out.addSide(arc.to, arc.right, eave);
        ends.push_back(arc.to);
        ends.push_back(arc.from);
        out.pair(a, b);
        out.facets[arc.left].side = a;
        out.facets[arc.right].side = b;
    }
    // A face has at most one side leaving each node; sorted by face they find each other by a table of nodes.
    std::vector<uint32_t> order(out.sides.size()), leaving(out.points.size()), owner(out.points.size(), kNone);
    std::vector<uint32_t> begin(out.facets.size() + 1, 0);
    for (const Facets::Side& s : out.sides) begin[s.facet + 1]++;
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<uint32_t> fill(begin.begin(), begin.end() - 1);
    for (uint32_t s = 0; s < out.sides.size(); s++) order[fill[out.sides[s].facet]++] = s;
    for (uint32_t f = 0; f < out.facets.size(); f++) {
        uint32_t count = begin[f + 1] - begin[f], walked = 0;
        if (count == 0) continue;
        for (uint32_t i = begin[f]; i < begin[f + 1]; i++) {
            uint32_t node = out.sides[order[i]].from;
            if (owner[node] == f) return false;
            owner[node] = f;
            leaving[node] = order[i];
        }
        for (uint32_t i = begin[f]; i < begin[f + 1]; i++) {
            uint32_t node = ends[order[i]];
            if (owner[node] != f) return false;
            out.link(order[i], leaving[node]);
        }
        uint32_t first = out.facets[f].side, s = first;
        do walked++, s = out.sides[s].next;
        while (s != first && walked <= count);
        if (walked != count) return false;
    }
    return true;
}

namespace {

void drop(Facets& f, uint32_t side) {
    Facets::Side& s = f.sides[side];
    f.link(s.previous, s.next);
    f.facets[s.facet].side = s.next == side ? kNone : s.next;
    s.dead = true;
}

// Two sides that go there and back: their twins meet.
void dropSpur(Facets& f, uint32_t a, uint32_t b) {
    uint32_t beyondA = f.sides[a].twin, beyondB = f.sides[b].twin;
    if (beyondA != b) {
        // Where an eave vanishes between the two, the other twin becomes the border.
        if (beyondA != kNone) f.sides[beyondA].twin = beyondB;
        if (beyondB != kNone) f.sides[beyondB].twin = beyondA;
    }
    drop(f, a);
    drop(f, b);
}

}  // namespace

void cleanFacets(Facets& f, double tolerance, uint32_t fixed) {
    std::vector<uint32_t> joined(f.points.size());
    std::iota(joined.begin(), joined.end(), 0);
    auto find = [&](uint32_t p) {
        while (joined[p] != p) p = joined[p] = joined[joined[p]];
        return p;
    };
    for (uint32_t s = 0; s < f.sides.size(); s++) {
        uint32_t a = find(f.sides[s].from), b = find(f.to(s));
        glm::dvec3 d = f.points[a] - f.points[b];
        if (a == b || glm::dot(d, d) > tolerance * tolerance || (a < fixed && b < fixed)) continue;
        joined[std::max(a, b)] = std::min(a, b);
    }
    for (Facets::Side& s : f.sides) s.from = find(s.from);

    std::vector<uint32_t> work;
    for (uint32_t s = 0; s < f.sides.size(); s++)
        if (f.to(s) == f.sides[s].from) work.push_back(s);
    for (uint32_t s : work) drop(f, s);
    // Spurs, each of which may lay open another; and corners in the middle of a straight joint.
    for (uint32_t s = 0; s < f.sides.size(); s++) work.push_back(s);
    while (!work.empty()) {
        uint32_t a = work.back();
        work.pop_back();
        if (f.sides[a].dead) continue;
        uint32_t b = f.sides[a].next;
        if (a != b && f.sides[f.sides[b].next].from == f.sides[a].from) {
            uint32_t before = f.sides[a].previous;
            dropSpur(f, a, b);
            if (!f.sides[before].dead) work.push_back(before);
            continue;
        }
        uint32_t ta = f.sides[a].twin, tb = f.sides[b].twin;
        if (ta == kNone || tb == kNone || f.sides[tb].next != ta || f.sides[a].eave || f.sides[b].eave) continue;
        if (f.sides[ta].eave || f.sides[tb].eave) continue;
        drop(f, b);
        f.sides[ta].from = f.sides[tb].from;
        drop(f, tb);
        f.pair(a, ta);
        work.push_back(a);
    }
}

}  // namespace espalier
