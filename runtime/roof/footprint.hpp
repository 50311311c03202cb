#pragma once

// What is known of a building before its roof is made: its outline and what its tags say.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/roof/structure.hpp"

namespace espalier {

enum class RoofMaterial : uint32_t {
    unknown,
    tiles,
    slate,
    metal,
    copper,
    thatch,
    wood,
    stone,
    concrete,
    asphalt,
    gravel,
    glass,
    grass,
    plainTiles,  // these three are asked for by designers; plans say `tiles`
    panTiles,
    barrelTiles
};

enum class RidgeOrientation : uint32_t { along, across };

struct Footprint {
    std::string id;
    std::vector<std::vector<glm::dvec2>> rings;  // plan metres, not closed; outer ring first, any orientation
    std::vector<EdgeRoof> edges;                 // numbers over the rings as given
    RoofShape shape = RoofShape::hip;
    bool part = false;                 // building:part: stands for its share of an outline
    std::optional<double> roofHeight;  // metres from eave to ridge; else slope counts
    std::optional<double> slope;       // tangent of the pitch; else the shape's own
    std::optional<double> direction;   // radians clockwise from north, where the roof falls to: sheds
    RidgeOrientation orientation = RidgeOrientation::along;  // the ridge along the house's length, or across it
    double baseHeight = 0;             // metres above the ground plane: building:min_level, min_height
    std::optional<double> height;      // from the ground to the ridge
    std::optional<double> levels;      // storeys below the roof
    std::optional<double> roofLevels;  // storeys in the roof
    RoofMaterial material = RoofMaterial::unknown;
    uint32_t colour = 0;    // 0xAABBGGRR
    float overhang = 0;     // of the eaves, metres; 0: as the grammar says
    uint32_t chimneys = 0;  // 0: as the grammar says, 1: none, 2: on every ridge
};

// A town: footprints in plan metres around an origin, and what was wrong with the features that are missing or mended.
struct Town {
    glm::dvec2 originLonLat{0};  // degrees; 0, 0 for plans in metres
    std::vector<Footprint> footprints;
    std::vector<Diagnostic> diagnostics;  // rule: the feature's id
};

// Adds what was said of a footprint or a file to what was said of the town. Beyond kMostMessages only one more, which
// tells so: a file that says something wrong a million times may be meant to.
constexpr size_t kMostMessages = 10000;
void addMessages(std::vector<Diagnostic>& all, std::vector<Diagnostic> more);

// Reads GeoJSON (coordinates in degrees; Polygon, MultiPolygon) or a plan in metres ({"buildings": [...]});
// docs/roofs.md lists tags and keys. Fails only if the text is neither; a feature that can't be used is named in the
// diagnostics.
Result<Town> parseFootprints(const std::string& text, const std::string& file);
Result<Town> readFootprints(const std::string& path);

// An outline that the structure can be made of: outer rings counterclockwise, holes clockwise, simple, disjoint,
// corners on a grid of 2^-20 m about `origin` (coarser for large ones, so that floats hold them), no corner nearer than
// 5 mm to the next or within 2 mm of a straight
// line.
struct RepairedOutline {
    glm::dvec2 origin;
    std::vector<std::vector<glm::dvec2>> rings;  // relative to the origin
    std::vector<uint32_t> sourceEdges;           // of each edge: the nearest edge as given
};

// One outline for each part that an outline falls into, largest first; none if nothing of it is left (and a diagnostic
// says why). What was mended is a warning. Any thread.
std::vector<RepairedOutline> repairOutline(const Footprint& footprint, std::vector<Diagnostic>& diagnostics);

constexpr size_t kMostCorners = 20000;  // of one footprint

}  // namespace espalier
