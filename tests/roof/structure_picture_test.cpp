// Plans of roofs to look at: set ESPALIER_PICTURES to a folder and SVGs of letters and of a block of Bayreuth are
// written.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "runtime/core/file.hpp"
#include "runtime/roof/shapes.hpp"
#include "tests/roof/structure_cases.hpp"
#include "tests/roof/structure_judge.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

const char* kJointColour[] = {"#d03020", "#2040d0", "#000000", "#909090", "#c08000", "#808080", "#d8d8d8"};

// Faces lit from the north-west, joints by kind: hip red, valley blue, ridge black, break orange, cut pale.
void draw(std::ostream& svg, const RoofStructure& roof, uint32_t house, glm::dvec2 shift, double scale) {
    const RoofHouse& h = roof.houses[house];
    auto at = [&](glm::dvec3 p) {
        glm::dvec2 q = (glm::dvec2(p) + shift) * scale;
        return std::to_string(q.x) + "," + std::to_string(-q.y);
    };
    for (uint32_t f = h.firstFace; f < h.firstFace + h.faceCount; f++) {
        const RoofFace& face = roof.faces[f];
        if (face.kind == FaceKind::gable) continue;
        glm::dvec3 e = glm::dvec3(face.eave[1]) - glm::dvec3(face.eave[0]);
        glm::dvec2 up = glm::normalize(glm::dvec2(e.z, e.x));
        int light = int(190 + 55 * glm::dot(up, glm::dvec2(0.5, -0.8)) * std::min(1.0, 1.5 * face.slope));
        svg << "<polygon fill='rgb(" << light << "," << light - 12 << "," << light - 24 << ")' points='";
        for (glm::dvec3 p : outlineOf(roof, face)) svg << at(p) << " ";
        svg << "'/>\n";
        std::vector<glm::dvec3> outline = outlineOf(roof, face);
        size_t skip = face.detached ? 0 : 1;
        for (uint32_t i = 0; i < face.segmentCount; i++) {
            glm::dvec3 from = i + skip > 0 ? outline[i + skip - 1] : outline.back();
            svg << "<polyline fill='none' stroke='" << kJointColour[size_t(roof.segments[face.firstSegment + i].kind)]
                << "' points='" << at(from) << " " << at(outline[i + skip]) << "'/>\n";
        }
    }
    for (const auto& ring : h.rings) {
        svg << "<polygon fill='none' stroke='#000' stroke-width='2' points='";
        for (glm::vec2 p : ring) svg << at({p.x, p.y, 0}) << " ";
        svg << "'/>\n";
    }
}

}  // namespace

TEST_CASE("pictures") {
    const char* folder = std::getenv("ESPALIER_PICTURES");
    if (!folder || !*folder) return;
    std::ostringstream svg;
    const char* head =
        "<svg xmlns='http://www.w3.org/2000/svg' width='1880' height='1600'><rect width='1880' height='1600' "
        "fill='white'/>\n";
    svg << head;
    int row = 0;
    for (Footprint f : letters()) {
        for (uint32_t shape = 0; shape <= uint32_t(RoofShape::flat); shape++) {
            f.shape = RoofShape(shape);
            std::vector<Diagnostic> said;
            RoofStructure roof = roofOf(f, said);
            for (uint32_t h = 0; h < roof.houses.size(); h++) {
                draw(svg, roof, h, glm::dvec2(14 + shape * 31.0, -12 - row * 25.0), 7.5);
            }
        }
        row++;
        if (row == 8) {
            svg << "</svg>\n";
            REQUIRE(bool(writeFile(std::string(folder) + "/letters_a.svg", svg.str())));
            svg.str("");
            svg << head;
            row = 0;
        }
    }
    svg << "</svg>\n";
    REQUIRE(bool(writeFile(std::string(folder) + "/letters_b.svg", svg.str())));

    for (auto [file, x, y] : {std::tuple("osm_north_bayreuth_DE_local.json", 3900.0, -2550.0),
                              std::tuple("osm_monaco_west_local.json", -330.0, -400.0)}) {
        std::ostringstream town;
        town << head;
        for (Footprint& f : casesOf(file)) {
            f.shape = RoofShape::gable;
            std::vector<Diagnostic> said;
            RoofStructure roof = roofOf(f, said);
            for (uint32_t h = 0; h < roof.houses.size(); h++) {
                glm::dvec2 p = roof.houses[h].origin - glm::dvec2(x, y);
                if (std::abs(p.x) < 170 && std::abs(p.y) < 150) draw(town, roof, h, p + glm::dvec2(160, -140), 5.8);
            }
        }
        town << "</svg>\n";
        REQUIRE(bool(writeFile(std::string(folder) + "/" + file + ".svg", town.str())));
    }
}
