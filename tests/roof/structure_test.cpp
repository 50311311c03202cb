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

namespace {

size_t edgesOf(const Footprint& f) {
    size_t count = 0;
    for (const Ring& ring : f.rings) count += ring.size();
    return count;
}

// Makes the roof and judges it with the slopes that its edges ask for; nothing may have been done otherwise than asked.
void judgeEdges(const Footprint& f) {
    std::vector<Diagnostic> said;
    RoofStructure roof = roofOf(f, said);
    INFO(f.id << " " << toString(said));
    REQUIRE(roof.houses.size() == 1);
    CHECK(said.empty());
    bool scaled = f.roofHeight || f.height;
    std::set<uint32_t> gables;
    Verdict verdict = judge(roof, 0, [&](const RoofFace& face) {
        double slope = f.slope.value_or(-1);
        for (const EdgeRoof& own : f.edges)
            if (own.edge == face.edge && own.slope) slope = *own.slope;
        return scaled || face.tier ? -1 : slope;
    });
    CHECK(verdict.problem == "");
    for (const RoofFace& face : roof.faces)
        if (face.kind == FaceKind::gable) gables.insert(face.edge);
    for (const EdgeRoof& own : f.edges)
        if (own.gable) CHECK(gables.count(own.edge) == size_t(*own.gable));
    if (f.roofHeight)
        CHECK(roof.houses[0].ridgeHeight - roof.houses[0].eaveHeight == doctest::Approx(*f.roofHeight).epsilon(1e-4));
}

}  // namespace

TEST_CASE("slopes and gables an edge") {
    size_t fixtures = 0;
    for (const Footprint& letter : letters()) {
        uint32_t count = uint32_t(edgesOf(letter));
        for (uint32_t e = 0; e < count; e += 3, fixtures++) {
            Footprint f = letter;
            f.id += ", gable on edge " + std::to_string(e);
            f.slope = 0.7;
            f.edges = {{e, true, {}}};
            judgeEdges(f);
        }
        for (int variant = 0; variant < 4; variant++, fixtures++) {
            Footprint f = letter;
            f.id += ", slopes " + std::to_string(variant);
            f.slope = 0.7;
            for (uint32_t e = 0; e < count; e++)
                if (variant == 0 ? e % 2 == 0 : variant == 1 ? e == 0 : variant == 2)
                    f.edges.push_back({e, {}, variant == 2 ? 0.4 + 0.13 * ((e * 7) % 11) : 1.4});
            if (variant == 3) f.roofHeight = 3.5;
            judgeEdges(f);
        }
    }
    MESSAGE(fixtures << " fixtures");
}

TEST_CASE("stars of many spikes stand under every kind of break") {
    // Regular: all spikes' roofs meet at one moment, in the middle.
    for (bool regular : {true, false})
        for (RoofShape shape : {RoofShape::hip, RoofShape::mansard, RoofShape::gambrel}) {
            constexpr int kCorners = 1500;
            Ring ring;
            for (int i = 0; i < kCorners; i++) {
                const double wide = regular ? 0 : 4 * std::sin(2.3 * i), turn = regular ? 0 : 0.2 * std::sin(5.1 * i);
                const double angle = 2 * 3.14159265358979 * (i + turn) / kCorners;
                ring.push_back((i % 2 ? 20 : 40 + wide) * glm::dvec2(std::cos(angle), std::sin(angle)));
            }
            Footprint f = outline(regular ? "star" : "ragged star", {ring});
            f.shape = shape;
            std::vector<Diagnostic> said;
            const RoofStructure roof = roofOf(f, said);
            INFO(f.id << " as shape " << uint32_t(shape) << ": " << toString(said));
            REQUIRE(roof.houses.size() == 1);
            CHECK(roof.houses[0].shape == shape);
            CHECK(judge(roof, 0).problem == "");
        }
}

TEST_CASE("hairline outlines") {
    // Ties missed by a hair of every size, from a grid line to a centimetre.
    for (double hair : {1e-6, 1e-5, 1e-4, 1e-3, 4e-3, 6e-3, 1e-2})
        for (Footprint f : letters())
            for (int variant = 0; variant < 3; variant++) {
                f.slope = 0.7;
                Footprint g = f;
                Ring& ring = g.rings[0];
                if (variant == 0) ring[2] += glm::dvec2(hair, 0);
                if (variant == 1)
                    for (size_t i = 0; i < ring.size(); i += 2) ring[i] += glm::dvec2(-hair, hair * double(i % 3));
                if (variant == 2) ring.insert(ring.begin() + 1, (ring[0] + ring[1]) / 2.0 + glm::dvec2(0, hair));
                g.id += ", a hair of " + std::to_string(hair) + ", " + std::to_string(variant);
                INFO(g.id);
                CHECK(judgeRoof(g, true) == 1);
            }
}
