#pragma once

// Around a stretch of contact the surfaces stand as half-planes, here called flaps. A walk that comes along a flap goes
// on along the one that it meets first when it turns from there towards its own outside: so it leaves the floor for the
// wall, and what lies within a solid leads nowhere.

#include <array>
#include <vector>

#include "runtime/surface/contact_stretches.hpp"

namespace espalier {

// A half-plane at a stretch of contact.
struct Flap {
    int side;
    uint32_t triangle;
    glm::dvec3 away, normal;  // unit; away from the stretch, within the surface
    uint32_t half;            // half-edge that it ends at there; kNoIndex: it goes on as another flap
    bool atBorder;            // along a border of its chart
};

// Those of one stretch after another.
class Flaps {
  public:
    // a and b: the same for the shells of one mesh. tolerance: as ContactOptions. The views have to outlive it.
    Flaps(const ContactView& a, const ContactView& b, double tolerance) : view_{&a, &b}, tolerance_(tolerance) {}

    void standAround(const ContactStretch& stretch);

    const std::vector<Flap>& all() const { return flaps_; }
    const ContactStretch& stretch() const { return *stretch_; }
    const ContactView& viewOf(const Flap& f) const { return *view_[f.side]; }
    bool ofOneMesh() const { return view_[0] == view_[1]; }
    // Borders that run along each other and are joined as borders.
    bool areBorders() const;
    // Where a walk along f is led over the stretch. Null: nowhere, or a seam leads there.
    const Flap* leadsTo(const Flap& f) const;
    // The angle by which a walk along f turns to its outside until it stands on g.
    double angle(const Flap& f, const Flap& g) const;

  private:
    void addFlaps(int s);
    void addFlap(int s, uint32_t triangle, glm::dvec3 towards, uint32_t half);
    const Flap* goesOn(const Flap& f) const;
    const Flap* leadsOut(const Flap& f) const;
    bool before(const Flap& g, const Flap& h, const Flap& f) const;
    bool hides(const Flap& g, const Flap& f) const;
    bool seamLeads(const Flap& f, const Flap& g) const;

    uint32_t body(const Flap& f) const { return viewOf(f).mesh.triangles[f.triangle].body; }
    bool solid(const Flap& f) const { return viewOf(f).mesh.solid[body(f)] != 0; }
    bool lining(const Flap& f) const { return viewOf(f).mesh.lining[body(f)] != 0; }
    // The way around the stretch in which a flap's outside lies: +1 or -1.
    double sideOf(const Flap& f) const { return glm::dot(f.normal, glm::cross(direction_, f.away)) > 0 ? 1 : -1; }
    // Does g turn its outside to a walk that comes from f's outside?
    bool faces(const Flap& g, const Flap& f) const { return sideOf(g) != sideOf(f); }

    std::array<const ContactView*, 2> view_;
    double tolerance_;
    const ContactStretch* stretch_ = nullptr;
    glm::dvec3 direction_{0};
    std::vector<Flap> flaps_;
};

}  // namespace espalier
