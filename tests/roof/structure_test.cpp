// Roofs over real outlines: all of them are made, and the judge finds nothing wrong.
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "runtime/roof/shapes.hpp"
#include "tests/roof/structure_cases.hpp"
#include "tests/roof/structure_judge.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

double asked(const Footprint& f, const RoofFace& face) {
    return face.tier == 0 ? f.slope.value_or(-1) : -1;
}

// Makes the roof, judges all its houses; returns how many there are.
size_t judgeRoof(const Footprint& footprint, bool mustPlain = false) {
    std::vector<Diagnostic> said;
    RoofStructure roof = roofOf(footprint, said);
    for (uint32_t h = 0; h < roof.houses.size(); h++) {
        INFO(footprint.id << " as shape " << uint32_t(footprint.shape));
        Verdict verdict = judge(roof, h, [&](const RoofFace& face) { return asked(footprint, face); });
        CHECK(verdict.problem == "");
    }
    if (mustPlain)
        for (const Diagnostic& d : said) {
            INFO(toString(d));
            CHECK(d.message.find("roof") == std::string::npos);
        }
    return roof.houses.size();
}

}  // namespace

TEST_CASE("hip roofs over every real outline") {
    for (const char* file : {"osm_north_bayreuth_DE_local.json", "osm_monaco_west_local.json",
                             "osm_campo_grande_BR_local.json", "bpypolyskel_cases.json"}) {
        for (Footprint& f : casesOf(file)) {
            f.slope = 0.8;
            INFO(file << " " << f.id);
            CHECK(judgeRoof(f, true) >= 1);
        }
    }
}

TEST_CASE("stress polygons and broken outlines are repaired or named") {
    for (const char* file : {"polygon_stress_cases.json", "corrupted_footprints.json"}) {
        size_t made = 0, left = 0;
        for (Footprint& f : casesOf(file)) {
            f.slope = 1;
            std::vector<Diagnostic> said;
            RoofStructure roof = roofOf(f, said);
            INFO(file << " " << f.id << ": " << toString(said));
            for (uint32_t h = 0; h < roof.houses.size(); h++) CHECK(judge(roof, h).problem == "");
            bool named = false;
            for (const Diagnostic& d : said) named = named || (!d.warning && d.rule == f.id);
            CHECK((!roof.houses.empty() || named));
            (roof.houses.empty() ? left : made)++;
            if (roof.houses.empty()) MESSAGE(toString(said));
        }
        MESSAGE(std::string(file) << ": " << made << " made, " << left << " named");
    }
}

TEST_CASE("every shape over letters and courtyards, turned and moved") {
    for (Footprint f : letters())
        for (uint32_t shape = 0; shape <= uint32_t(RoofShape::flat); shape++)
            for (double angle : {0.0, 0.3, 1.0, 2.5}) {
                Footprint g = f;
                for (Ring& ring : g.rings) ring = turned(ring, angle);
                g.shape = RoofShape(shape);
                std::vector<Diagnostic> said;
                RoofStructure roof = roofOf(g, said);
                INFO(g.id << " as shape " << shape << " turned by " << angle << " " << toString(said));
                REQUIRE(roof.houses.size() == 1);
                CHECK(judge(roof, 0).problem == "");
                bool pyramidless = RoofShape(shape) == RoofShape::pyramid;
                if (!pyramidless) CHECK(roof.houses[0].shape == RoofShape(shape));
            }
}
