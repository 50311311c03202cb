#pragma once

#include <span>
#include <vector>

#include "runtime/roof/structure.hpp"
#include "shaders/shared/roof_records.h"

namespace espalier {

struct AtomOptions {
    float verge = 0.15f;  // metres that roofs reach over the walls of their gables
};

// What expansion reads of a town (Buron 2013 §3.1): an atom for each eave, with its targets, its outline's pieces, and
// its region cut into convex parts. Faces that the structure has cut apart are one atom again.
struct RoofTables {
    std::vector<RoofAtom> atoms;
    std::vector<RoofPiece> pieces;
    std::vector<RoofRegion> regions;
    std::vector<RoofPart> parts;
    std::vector<vec4> planes;
    struct House {
        uint32_t firstAtom = 0, atomCount = 0;
        bool hidden = false;  // nothing grows from its atoms
        bool operator==(const House&) const = default;
    };
    std::vector<House> houses;
    std::vector<RoofPlot> plots;  // [house]; generations count for nothing here
};

// The structure must pass checkRoof(). Atoms of a house follow each other; those of tier 0 stand before upper ones.
RoofTables makeAtoms(const RoofStructure& structure, const AtomOptions& options = {});

// Replaces house `index` by the only one of `structure`: its atoms are added at the end, the old ones are left unused.
// A house that is hidden stays hidden.
void replaceAtoms(RoofTables& tables, uint32_t index, const RoofStructure& structure, const AtomOptions& options = {});

// The atoms of the house that expansion begins with, see startShape(): those of tier 0; none of a house that is hidden.
void appendStarts(const RoofTables& tables, uint32_t house, std::vector<uint32_t>& atoms);

// Triangulates nothing: cuts a simple polygon with counterclockwise edges into convex parts between upright lines. Edge
// i leads from point i to the next; planes[i] is the half-space of edge i. Exposed for tests.
struct OutlineEdge {
    glm::vec2 from, to;
    vec4 plane;
    bool open = false;  // no terminal is clipped by it (an eave, which tiles may reach over)
    bool seam = false;  // leads on to another part of the same face
};
void cutIntoParts(std::span<const OutlineEdge> edges, std::vector<RoofPart>& parts, std::vector<vec4>& planes);

}  // namespace espalier
