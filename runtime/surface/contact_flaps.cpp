#include "runtime/surface/contact_flaps.hpp"

#include <cmath>
#include <utility>

namespace espalier {

using glm::dvec3;

namespace {

constexpr double kTurn = 6.283185307179586;
constexpr double kSameAngle = 0.06;       // radians: flaps nearer to each other coincide
constexpr double kCrossingAngle = 0.004;  // radians: and those that do so in truth

}  // namespace

void Flaps::standAround(const ContactStretch& stretch) {
    stretch_ = &stretch;
    flaps_.clear();
    direction_ = stretch.segment.side[0].b - stretch.segment.side[0].a;
    const double length = glm::length(direction_);
    if (!(length > 0)) return;
    direction_ /= length;
    for (int s = 0; s < 2; ++s) addFlaps(s);
}

bool Flaps::areBorders() const {
    return flaps_.size() == 2 && sideOf(flaps_[0]) != sideOf(flaps_[1]) && ofOneMesh();
}

const Flap* Flaps::leadsTo(const Flap& f) const {
    if (lining(f)) return leadsOut(f);
    const Flap* g = goesOn(f);
    if (!g || g->side == f.side || seamLeads(f, *g)) return nullptr;
    return faces(*g, f) || !solid(*g) ? g : nullptr;
}

// From a lining to what is seen, rather over its edge than onto a back.
const Flap* Flaps::leadsOut(const Flap& f) const {
    const Flap* best = nullptr;
    for (const Flap& g : flaps_) {
        if (g.side == f.side || lining(g)) continue;
        const auto order = [&](const Flap& h) { return std::pair(!faces(h, f), angle(f, h)); };
        if (!best || order(g) < order(*best)) best = &g;
    }
    return best;
}

void Flaps::addFlaps(int s) {
    const ContactView& view = *view_[s];
    const auto& side = stretch_->segment.side[s];
    const uint32_t t = stretch_->triangle[size_t(s)];
    if (side.edge < 0) {
        const dvec3 w = glm::cross(view.normal(t), direction_);
        addFlap(s, t, w, kNoIndex);
        addFlap(s, t, -w, kNoIndex);
        return;
    }
    const uint32_t h = t * 3 + uint32_t(side.edge);
    for (uint32_t half : {h, view.mesh.twin[h]}) {
        if (half == kNoIndex) continue;
        const dvec3 tip = view.at(half / 3, (half + 2) % 3) - view.at(half / 3, half % 3);
        addFlap(s, half / 3, tip, half);
    }
}

void Flaps::addFlap(int s, uint32_t triangle, dvec3 towards, uint32_t half) {
    const ContactView& view = *view_[s];
    const dvec3 n = view.normal(triangle);
    dvec3 w = glm::cross(n, direction_);
    const double length = glm::length(w);
    if (!(length > 0.1)) return;
    w /= length;
    const bool atBorder = half != kNoIndex && view.mesh.chartBorder[half] != 0;
    flaps_.push_back({s, triangle, glm::dot(w, towards) < 0 ? -w : w, n, half, atBorder});
}

double Flaps::angle(const Flap& f, const Flap& g) const {
    double cosine = glm::dot(f.away, g.away), sine = glm::dot(glm::cross(f.away, g.away), direction_) * sideOf(f);
    double a = std::atan2(sine, cosine);
    if (std::abs(a) < kSameAngle) a = 0;
    return a < 0 ? a + kTurn : a;
}

// What a walk from f meets first. Null: f is covered, or alone.
const Flap* Flaps::goesOn(const Flap& f) const {
    const Flap* best = nullptr;
    double least = 0;
    for (const Flap& g : flaps_) {
        if (&g == &f || lining(g)) continue;
        double a = angle(f, g);
        if (a == 0 && g.side != f.side) {
            if (!faces(g, f)) {
                if (hides(g, f)) return nullptr;
                continue;
            }
            // Face to face where one is a solid's, else back to back.
            if (solid(f) || solid(g)) return nullptr;
            a = kTurn;
        }
        if (!best || a < least - kSameAngle || (a < least + kSameAngle && before(g, *best, f))) best = &g, least = a;
    }
    return best;
}

// Which of two flaps at one angle a walk from f meets.
bool Flaps::before(const Flap& g, const Flap& h, const Flap& f) const {
    if (g.side == h.side) return false;
    if (faces(g, f) == faces(h, f)) return hides(g, h);
    bool faceToFace = solid(g) || solid(h);
    return faces(g, f) != faceToFace;
}

// Of two faces of one outside that coincide: does g hide f?
bool Flaps::hides(const Flap& g, const Flap& f) const {
    const auto &a = stretch_->segment.side[f.side], &b = stretch_->segment.side[g.side];
    double above = glm::dot(f.normal, (b.a + b.b - a.a - a.b) * 0.5);
    if (std::abs(above) > 0.02 * tolerance_) return above > 0;
    // Where they cross at a small angle, the one that rises from the stretch.
    const double rise = glm::dot(glm::cross(f.away, g.away), direction_) * sideOf(f);
    if (std::abs(rise) > kCrossingAngle) return rise > 0;
    return std::make_pair(g.side == 1 && !ofOneMesh(), body(g)) < std::make_pair(f.side == 1 && !ofOneMesh(), body(f));
}

// Does a seam along the stretch lead from f to g?
bool Flaps::seamLeads(const Flap& f, const Flap& g) const {
    if (f.half == kNoIndex || g.half == kNoIndex || !ofOneMesh()) return false;
    const auto& seam = viewOf(f).mesh.seam;
    return !seam.empty() && seam[f.half] == g.half;
}

}  // namespace espalier
