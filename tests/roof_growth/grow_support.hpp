#pragma once

#include <doctest/doctest.h>

#include "runtime/roof/shapes.hpp"
#include "runtime/roof_growth/roof_growth.hpp"

// What the tests of roofs' growth share: houses, grammars, meshes.
namespace roof_test {

using namespace espalier;

inline const std::vector<TerminalMesh> kMeshes = {{"slate", false}, {"ridge", false}, {"panel", false}};
// A cell of the unit square, one centimetre thick.
inline const std::vector<RoofMesh> kBounds(3, RoofMesh{{0, 0, 0}, {1, 1, 0.01f}});

inline RuleMap compiled(const std::string& text) {
    CompileOptions options;
    options.meshes = kMeshes;
    Result<RuleMap> map = compileGrammar(text, options);
    INFO(text);
    if (!map) FAIL(map.failure().text());
    return std::move(map.value());
}
inline std::string failureText(const std::string& text) {
    CompileOptions options;
    options.meshes = kMeshes;
    Result<RuleMap> map = compileGrammar(text, options);
    return map ? std::string("compiled") : map.failure().text();
}

inline Footprint footprint(std::vector<glm::dvec2> ring, RoofShape shape = RoofShape::hip, double slope = 1) {
    Footprint f;
    f.id = "house";
    f.rings = {std::move(ring)};
    f.shape = shape;
    f.slope = slope;
    f.levels = 1;
    return f;
}
inline RoofStructure structureOf(const std::vector<Footprint>& all) {
    std::vector<Diagnostic> diagnostics;
    RoofStructure s = roofsOf(all, diagnostics);
    INFO(toString(diagnostics));
    REQUIRE(s.houses.size() >= all.size());
    return s;
}

struct Roofs {
    RoofStructure structure;
    RoofTables tables;
    RuleMap map;
    RoofInputs inputs() const {
        RoofInputs in;
        in.town = &tables;
        in.grammar = &map;
        in.meshes = kBounds;
        in.native = false;
        return in;
    }
};
inline Roofs roofs(const std::vector<Footprint>& all, const std::string& grammar, float verge = 0) {
    Roofs r;
    r.structure = structureOf(all);
    r.tables = makeAtoms(r.structure, {verge});
    r.map = compiled(grammar);
    return r;
}

inline const std::vector<glm::dvec2> kRectangle = {{0, 0}, {10, 0}, {10, 6}, {0, 6}};
inline const std::vector<glm::dvec2> kEll = {{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 12}, {0, 12}};

// Walls are bare, roofs are slated.
inline const std::string kSlates =
    "House -> Extrude(wallHeight) {NULL, TopWall}\n"
    "TopWall -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, NULL}\n"
    "Cover -> Repeat(XY, vec2(0.25, 0.2), clip) {Slate}\n"
    "Slate -> Shape(\"slate\")\n";

}  // namespace roof_test
