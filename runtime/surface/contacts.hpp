#pragma once

// Where pieces or surfaces touch or run into each other, so that plants go from one to the other. The same code serves
// the baker, for the pieces of one model, and the runtime, for surfaces that were placed against each other.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/surface/box_tree.hpp"
#include "shaders/shared/surface_records.h"

namespace espalier {

// A mesh as contacts are found on it. Half-edge 3 t + k runs from corner k to corner (k + 1) % 3 of triangle t.
struct ContactMesh {
    struct Triangle {
        std::array<uint32_t, 3> point;
        std::array<glm::dvec2, 3> uv;  // the walk's
        uint32_t chart;
        uint32_t shell;  // connected over twins; contacts are looked for between shells only
        uint32_t body;   // shells joined at their borders
        bool bare;       // nothing grows on it
    };
    std::vector<glm::dvec3> points;  // welded; object space, metres
    std::vector<Triangle> triangles;
    std::vector<uint32_t> twin;        // per half-edge, kNoIndex at borders
    std::vector<uint32_t> seam;        // per half-edge: the one that walks come to over it anyway; empty: the twin
    std::vector<uint8_t> chartBorder;  // per half-edge: the chart ends here
    std::vector<float> orientation;    // per chart, as Chart::orientation
    std::vector<uint8_t> solid;        // per body: it encloses room (Bodies); others are sheets
    std::vector<uint8_t> lining;       // per body: all of its outside lies within solid ones (Bodies)
    std::vector<double> reach;         // per point: what lies nearer touches; metres

    BoxTree tree() const;  // over the triangles, grouped by shell
    glm::dvec3 at(uint32_t triangle, uint32_t corner) const { return points[triangles[triangle].point[corner]]; }
    double reachOf(uint32_t triangle) const;  // its corners' largest
};

// Sets `reach` to `tolerance`, less at points of triangles that are not much larger than that.
void setReach(ContactMesh& mesh, double tolerance);

// A stretch of contact as one side's walk meets it: the record, and the triangles on both sides.
struct Contact {
    Crossing crossing;  // complete but for the instance in `target`
    uint32_t from, to;  // triangles
    // The stretch in space on the side that it leads to and on the one that it comes from, which are up to a reach
    // apart, and unit directions from there into either surface.
    glm::dvec3 a, b, onward;
    glm::dvec3 fromA, fromB, back;
    double turn;  // radians, (0, 2 pi]: by which a walk turns to its outside until it stands on the far side
};

// A contact with bare ground: as it was found, but it leads nowhere.
Crossing closed(Crossing contact);

// Whether what comes to the contact at `share` of its length is led on: beside it there is ground on both sides, or
// what is hidden on both. Asked a step aside, and closer, so that a slit isn't missed that is narrower than the step.
// hidden(far, p, crevices): whether p, of the side that it leads to (far) or comes from, is hidden; with crevices or
// without, since these hide texels, but no way: what comes down a wedge isn't left at its narrow end. tolerance:
// metres.
template <class Hidden>
bool leadsOn(const Contact& c, double share, double tolerance, const Hidden& hidden) {
    const glm::dvec3 to = c.a + (c.b - c.a) * share, from = c.fromA + (c.fromB - c.fromA) * share;
    for (double aside : {0.3 * tolerance, 0.05 * tolerance})
        for (bool crevices : {true, false})
            if (hidden(true, to + c.onward * aside, crevices) == hidden(false, from + c.back * aside, crevices))
                return true;
    return false;
}

struct ContactOptions {
    double tolerance;    // metres of a's object space; what is nearer touches
    double borderShift;  // UV: contacts along a chart's border are moved so far inside, before the border's own
    // With another mesh: b's object space to a's, a move, a turn and an even scale; and b's shift.
    glm::dmat4 toA{1};
    double otherBorderShift = 0;
};

// All contacts between the shells of `mesh`, both directions, in an order that depends on the input alone.
std::vector<Contact> contactsWithin(const ContactMesh& mesh, const BoxTree& tree, const ContactOptions& options);

// The contacts from a to b (fromA) and from b to a.
struct ContactsBetween {
    std::vector<Contact> fromA, fromB;
};
ContactsBetween contactsBetween(const ContactMesh& a, const BoxTree& treeA, const ContactMesh& b, const BoxTree& treeB,
                                const ContactOptions& options);

}  // namespace espalier
