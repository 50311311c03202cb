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

// A stretch of a footprint's wall against which a neighbour's wall stands.
struct SharedWall {
    glm::dvec2 from, to;  // plan metres, on an edge of the footprint
    double top;           // metres from the ground that the neighbour reaches
    bool endsRoof;        // it stands higher than this footprint's eave: no eave may reach over the wall
    bool alike;           // it is nearly as high or higher: both are of one row, and roofs end in gables
};

// Heights count from the ground, in metres (wiki.openstreetmap.org, Simple 3D Buildings).
struct Footprint {
    std::string id;
    std::vector<std::vector<glm::dvec2>> rings;  // plan metres, not closed; outer ring first, any orientation
    std::vector<EdgeRoof> edges;                 // numbers over the rings as given
    RoofShape shape = RoofShape::hip;
    bool shaped = false;                          // the shape was asked for; else it is what suits the outline
    bool part = false;                            // building:part: stands for its share of an outline
    bool open = false;                            // a roof on posts, without walls
    std::optional<double> roofHeight;             // metres from eave to ridge; else slope counts
    std::optional<double> slope;                  // tangent of the pitch; else the shape's own
    std::optional<double> direction;              // radians clockwise from north, where the roof falls to
    std::optional<RidgeOrientation> orientation;  // the ridge along the house's length, or across it
    double ground = 0;                            // of the place where it stands, above the ground plane
    double baseHeight = 0;                        // of the walls' foot: building:min_level, min_height
    std::optional<double> height;                 // of the ridge
    std::optional<double> levels;                 // storeys from the ground to the eave
    std::optional<double> roofLevels;             // storeys in the roof
    std::optional<double> wallHeight;             // from the walls' foot to the eave, whatever else says: a designer's
    std::vector<SharedWall> shared;               // walls against which neighbours stand
    RoofMaterial material = RoofMaterial::unknown;
    uint32_t colour = 0;    // 0xAABBGGRR
    float overhang = 0;     // of the eaves, metres; 0: as the grammar says
    uint32_t chimneys = 0;  // 0: as the grammar says, 1: none, 2: on every ridge
};

// A town: footprints in plan metres around an origin, and what was wrong with the features that are missing or mended.
struct Town {
    glm::dvec2 origin{0};     // where the plan's (0, 0) lies: degrees of longitude and latitude, or metres of the file
    bool geographic = false;  // the origin is in degrees
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
