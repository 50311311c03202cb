#pragma once

// A roof structure: for each eave the face above it (Buron 2013 §3.1). roofOf() in shapes.hpp makes one from a
// footprint; "any other roof structure extractor" (§5) may fill it in, as long as checkRoof() in check.hpp passes.
//
// A footprint lies in a plan in metres, x east and y north; all plan coordinates of a house are relative to its own
// `origin`, so that floats are precise in any town. The plan point (x, y) at height h stands at (x, h, -y):
// right-handed, Y up. Outer rings run counterclockwise seen from above, holes clockwise: inside is to the left.

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace espalier {

constexpr uint32_t kNoFace = ~0u;

enum class RoofShape : uint32_t { hip, gable, halfHip, pyramid, shed, gambrel, mansard, flat };

enum class FaceKind : uint32_t {
    slope,  // rises from its eave at `slope`
    gable,  // upright: the wall between a zero-speed edge and the roof; it covers no area of the plan
    flat    // level; slope 0
};

enum class JointKind : uint32_t {
    hip,        // between two slopes, rising, the roof falls away on both sides
    valley,     // between two slopes, the roof rises on both sides
    ridge,      // level or nearly so, the roof falls away on both sides
    verge,      // against a gable's wall
    breakLine,  // level, a steeper face below: mansard, gambrel, half-hip
    wall,       // an upright edge between walls, or the border of a level roof
    cut         // inside one plane: nothing shows, a face was cut into monotone pieces
};

// One piece of a face's boundary: from the point before it to its own.
struct ChainSegment {
    glm::vec3 to;      // twins share their points to the bit
    uint32_t face;     // the face beyond it, kNoFace: none (the border of the roof)
    uint32_t segment;  // its twin there, an index into RoofStructure::segments; kNoFace: none, or it is the face's eave
    JointKind kind;
};

// A planar face whose outline is the eave and then the chain, counterclockwise seen from outside (a gable's: from the
// open air). Slopes and levels are monotone along their eave: a plumb cut square to the eave meets the face in one
// piece. So the chain runs from eave[1] out to its furthest point along the eave (only at reflex corners is that not
// eave[1]: a valley leads out there), from there its projections on the eave never turn back until the furthest
// point at the other end, then in to eave[0].
struct RoofFace {
    uint32_t house;  // index into RoofStructure::houses
    uint32_t edge;   // of the footprint: running number over its rings, edge i leads from corner i to the next
    uint32_t tier;   // 0: from the wall's top; 1: above a break
    FaceKind kind;
    glm::vec3 eave[2];      // in the footprint's direction (inside to the left)
    float slope;            // tangent of the pitch; 0 for level faces and gables
    uint32_t firstSegment;  // the chain, from eave[1] round to eave[0]: its last point is eave[0] to the bit
    uint32_t segmentCount;  // at least 2
    // The piece of a cut face that doesn't touch its eave: the chain is the whole outline (its first segment comes from
    // the last one's point) and `eave` only gives the line that courses of tiles are counted from.
    bool detached;
};

// What one edge of an outline has of its own.
struct EdgeRoof {
    uint32_t edge;                // running number over rings
    std::optional<bool> gable;    // a wall up to the roof instead of an eave
    std::optional<double> slope;  // tangent of the pitch, > 0
};

// RoofHouse::shared where a neighbour stands higher than the eave.
constexpr float kEndsRoof = 1e9f;

struct RoofHouse {
    std::string id;                             // the feature's
    glm::dvec2 origin;                          // plan, metres east and north of the town's origin
    float baseHeight, eaveHeight, ridgeHeight;  // metres above the ground plane y = 0; base: the wall's foot
    RoofShape shape;
    std::vector<std::vector<glm::vec2>> rings;  // repaired footprint: outer ring, holes
    std::vector<EdgeRoof> edges;                // of these rings, as was asked for
    std::vector<float> shared;                  // an edge each: metres from the walls' foot that a neighbour covers, or
                                                // kEndsRoof; empty: none
    bool open;                                  // on posts, without walls
    std::string note;                           // what couldn't be made as asked, a line each
    uint32_t firstFace, faceCount;
    uint32_t material;  // RoofMaterial of footprint.hpp
    uint32_t colour;    // 0xAABBGGRR; alpha 0: not given
    float overhang;     // as of the footprint, as is the next
    uint32_t chimneys;
};

struct RoofStructure {
    std::vector<RoofHouse> houses;
    std::vector<RoofFace> faces;
    std::vector<ChainSegment> segments;
};

}  // namespace espalier
