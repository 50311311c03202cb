#pragma once

// Towns out of texts, and what tests ask of their roofs.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "runtime/roof/shapes.hpp"
#include "tests/support/data.hpp"

namespace espalier::test {

struct GrownTown {
    Town town;
    RoofStructure roofs;
    std::vector<Diagnostic> said;  // by reading and by making roofs

    bool says(const std::string& what) const { return toString(said).find(what) != std::string::npos; }
    const RoofHouse& house(const std::string& id) const {
        for (const RoofHouse& h : roofs.houses)
            if (h.id == id) return h;
        FAIL("no house " << id);
        return roofs.houses.front();
    }
    std::string ids() const {
        std::string all;
        for (const RoofHouse& h : roofs.houses) all += h.id + " ";
        return all;
    }
};

inline GrownTown grown(const std::string& text) {
    Result<Town> read = parseFootprints(text, "town.json");
    if (!read) FAIL(read.failure().text());
    GrownTown g{*read, {}, read->diagnostics};
    g.roofs = roofsOf(g.town.footprints, g.said);
    return g;
}

inline std::optional<GrownTown> grownReport(const std::string& name) {
    const std::optional<std::string> path = dataFile("reports/" + name);
    if (!path) return {};
    Result<Town> read = readFootprints(*path);
    if (!read) FAIL(read.failure().text());
    GrownTown g{*read, {}, read->diagnostics};
    g.roofs = roofsOf(g.town.footprints, g.said);
    return g;
}

struct Line {
    glm::dvec2 from, to;
    double height;
};

// The longest level ridge of a house, in plan metres, from its western or else southern end.
inline Line ridgeOf(const RoofStructure& roofs, const RoofHouse& house) {
    Line best{{0, 0}, {0, 0}, 0};
    for (uint32_t f = house.firstFace; f < house.firstFace + house.faceCount; ++f) {
        const RoofFace& face = roofs.faces[f];
        for (uint32_t i = 0; i < face.segmentCount; ++i) {
            const ChainSegment& s = roofs.segments[face.firstSegment + i];
            if (s.kind != JointKind::ridge) continue;
            const glm::vec3 a = i > 0 ? roofs.segments[face.firstSegment + i - 1].to : face.eave[1], b = s.to;
            glm::dvec2 from = house.origin + glm::dvec2(a.x, -a.z), to = house.origin + glm::dvec2(b.x, -b.z);
            if (std::abs(from.x - to.x) > 1e-3 ? from.x > to.x : from.y > to.y) std::swap(from, to);
            if (glm::distance(from, to) > glm::distance(best.from, best.to)) best = {from, to, a.y};
        }
    }
    return best;
}

inline bool runs(const Line& line, glm::dvec2 from, glm::dvec2 to) {
    return glm::distance(line.from, from) < 1e-3 && glm::distance(line.to, to) < 1e-3;
}

// Edges of a house over which a gable stands, by their middles.
inline bool gableAt(const RoofStructure& roofs, const RoofHouse& house, glm::dvec2 middle) {
    for (uint32_t f = house.firstFace; f < house.firstFace + house.faceCount; ++f) {
        const RoofFace& face = roofs.faces[f];
        const glm::dvec2 at =
            house.origin + glm::dvec2(face.eave[0].x + face.eave[1].x, -face.eave[0].z - face.eave[1].z) / 2.0;
        if (face.kind == FaceKind::gable && glm::distance(at, middle) < 0.1) return true;
    }
    return false;
}

}  // namespace espalier::test
