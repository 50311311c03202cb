// In: facets of any outline, with holes. Out: facets of one loop each, monotone along their eave: what weights and
// courtyards make non-monotone is cut plumb to the eave where its outline turns back (Buron 2013 §5 asks for local
// pieces; a tile then meets only the chain above its own interval of the eave).
#include <cmath>

#include "runtime/roof/structure_facets.hpp"

namespace espalier {

namespace {

constexpr double kLevel = 1e-5;  // metres along the eave that count as plumb

class Cutter {
  public:
    Cutter(Facets& facets, uint32_t facet) : f_(facets), facet_(facet) {}

    // All sides of the facet, before the first cut. Returns whether a cut was made.
    void run(std::vector<uint32_t>& sides) {
        sides_ = &sides;
        // Each cut removes a place where the outline turns back.
        for (size_t i = 0; i < sides.size();) {
            if (f_.sides.size() < kMostSides && cutAfter(sides[i]))
                i = 0;
            else
                i++;
        }
    }

  private:
    static constexpr size_t kMostSides = 1u << 22;

    glm::dvec2 local(uint32_t point) const {
        const Facets::Facet& facet = f_.facets[facet_];
        glm::dvec2 p = glm::dvec2(f_.points[point]) - glm::dvec2(facet.eave[0]);
        return {glm::dot(p, facet.along), glm::dot(p, facet.uphill)};
    }
    double advance(uint32_t side) const { return local(f_.to(side)).x - local(f_.sides[side].from).x; }

    // Cuts at the end of this side if the outline turns back there around a reflex corner or plumb run.
    bool cutAfter(uint32_t side) {
        double in = advance(side);
        if (std::abs(in) <= kLevel) return false;
        uint32_t first = f_.sides[side].next, last = first;
        while (std::abs(advance(last)) <= kLevel) {
            last = f_.sides[last].next;
            if (last == side) return false;
        }
        double out = advance(last);
        if (in * out > 0) return false;
        glm::dvec2 a = local(f_.sides[side].from), b = local(f_.sides[first].from), c = local(f_.sides[last].from),
                   d = local(f_.to(last));
        double rise = c.y - b.y;
        bool reflex = std::abs(rise) > kLevel ? (in > 0) == (rise < 0)
                                              : (b.x - a.x) * (d.y - c.y) - (b.y - a.y) * (d.x - c.x) < 0;
        if (!reflex) return false;
        // Into the facet from either end of the run; the shorter cut is made.
        bool firstUp = in > 0;
        Hit one = shoot(first, firstUp), two = shoot(last, !firstUp);
        if (one.side == kNone && two.side == kNone) return false;
        cut(one.distance <= two.distance ? first : last, one.distance <= two.distance ? one : two);
        return true;
    }

    struct Hit {
        uint32_t side = kNone;
        double distance = INFINITY, fraction = 0;
    };
    Hit shoot(uint32_t from, bool up) const {
        glm::dvec2 p = local(f_.sides[from].from);
        Hit best;
        for (uint32_t s : *sides_) {
            glm::dvec2 a = local(f_.sides[s].from), b = local(f_.to(s));
            // The roof is below a side that runs back and above one that runs on.
            if (up ? b.x >= a.x : b.x <= a.x) continue;
            double low = std::min(a.x, b.x), high = std::max(a.x, b.x);
            if (p.x < low || p.x > high || high - low <= kLevel) continue;
            double t = (p.x - a.x) / (b.x - a.x), y = a.y + t * (b.y - a.y);
            double distance = up ? y - p.y : p.y - y;
            if (distance <= kLevel || distance >= best.distance) continue;
            best = {s, distance, t};
        }
        return best;
    }

    void cut(uint32_t from, Hit hit) {
        glm::dvec3 a = f_.points[f_.sides[hit.side].from], b = f_.points[f_.to(hit.side)];
        double length = glm::length(b - a);
        uint32_t target;
        if (hit.fraction * length <= kLevel) {
            target = hit.side;
        } else if ((1 - hit.fraction) * length <= kLevel) {
            target = f_.sides[hit.side].next;
        } else {
            f_.points.push_back(a + hit.fraction * (b - a));
            target = f_.splitSide(hit.side, uint32_t(f_.points.size() - 1));
            sides_->push_back(target);
        }
        uint32_t fromBefore = f_.sides[from].previous, targetBefore = f_.sides[target].previous;
        uint32_t there = f_.addSide(f_.sides[from].from, facet_, false);
        uint32_t back = f_.addSide(f_.sides[target].from, facet_, false);
        f_.pair(there, back);
        f_.link(fromBefore, there);
        f_.link(there, target);
        f_.link(targetBefore, back);
        f_.link(back, from);
        sides_->push_back(there);
        sides_->push_back(back);
    }

    Facets& f_;
    const uint32_t facet_;
    std::vector<uint32_t>* sides_ = nullptr;
};

}  // namespace

void cutFacets(Facets& f) {
    // One side of each loop, by facet: cuts of other facets only put points into loops.
    std::vector<std::vector<uint32_t>> loops(f.facets.size());
    std::vector<bool> seen(f.sides.size());
    for (uint32_t s = 0; s < seen.size(); s++) {
        if (seen[s] || f.sides[s].dead) continue;
        loops[f.sides[s].facet].push_back(s);
        for (uint32_t t = s; !seen[t]; t = f.sides[t].next) seen[t] = true;
    }
    for (uint32_t facet = 0; facet < loops.size(); facet++) {
        if (loops[facet].empty() || f.facets[facet].kind == FaceKind::gable) continue;
        std::vector<uint32_t> sides;
        for (uint32_t first : loops[facet]) {
            uint32_t s = first;
            do sides.push_back(s), s = f.sides[s].next;
            while (s != first);
        }
        size_t before = sides.size();
        Cutter(f, facet).run(sides);
        if (sides.size() == before) continue;
        // Loops become facets of their own.
        uint32_t piece = facet;
        for (uint32_t s : sides) f.sides[s].facet = kNone;
        for (uint32_t s : sides) {
            if (f.sides[s].facet != kNone) continue;
            if (piece == kNone) {
                piece = uint32_t(f.facets.size());
                f.facets.push_back(Facets::Facet(f.facets[facet]));
            }
            f.facets[piece].side = s;
            for (uint32_t t = s; f.sides[t].facet == kNone; t = f.sides[t].next) f.sides[t].facet = piece;
            piece = kNone;
        }
    }
}

}  // namespace espalier
