#pragma once

// The baker's library face: a model becomes a surface. espalier_bake is authoring code; games link the runtime only.

#include <functional>
#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"
#include "runtime/surface/uv_picture.hpp"

namespace espalier {

// A model as it came from a file: one triangle list in one space, nodes' transforms applied.
struct Model {
    std::string name;                        // the file's path, for messages
    std::vector<glm::vec3> positions;        // metres, one a vertex
    glm::dvec3 origin{0};                    // metres: what has been taken off the file's positions
    std::vector<glm::vec3> normals;          // same length, or empty
    std::vector<glm::vec2> uvs;              // the UV set that the walk's charts come from, same length, or empty;
                                             // NaN: this vertex has none
    std::vector<glm::vec2> materialUvs;      // same length, or empty: uvs
    std::vector<glm::vec4> colours;          // linear, times the materials'; same length, or empty: white
    std::vector<glm::vec2> otherUvs;         // same length, or empty: no material has textures in two UV sets
    std::vector<uint32_t> indices;           // three a triangle
    std::vector<uint32_t> triangleMaterial;  // one a triangle, or empty: material 0
    std::vector<Material> materials;
    std::vector<std::string> materialNames;  // same length, or empty
    std::vector<Picture> images;
    std::vector<Diagnostic> warnings;
};

// progress: 0 to 1 and the stage's name; called from the calling thread.
using Progress = std::function<void(float, const char*)>;

struct BakeOptions {
    uint32_t resolution = 1024;  // of level 0: a power of two, 64 to 8192
    uint32_t levels = 0;         // 0: down to 64 texels
    float nearestTolerance = 0;  // metres; 0: a texel's footprint, a centimetre at most
    bool keepLayout = false;     // true: charts are never moved, gutters or not (tests of analytic surfaces)
    UvPicture weights;           // drawn in the model's UVs: texels a metre, as a share of the most; empty: even
    bool contacts = true;        // false: pieces that touch are no ground for one plant (tests whose oracle knows none)
    Progress progress;
};

// What became of the model's UV charts, by cause.
struct UvFate {
    std::string cause;    // "kept", or why they were made anew
    uint32_t charts = 0;  // of the model's UVs
    double area = 0;      // share of the model's
};

// A measure of distortion over the area: 1 is none.
struct Distortion {
    double p50 = 1, p95 = 1, max = 1;
};

// A connected piece of the model: what borders, near borders and contacts join.
struct PieceReach {
    double area = 0;       // m² of its ground on the finest level
    double enclosed = 0;   // m² more that can't be got to and that no ray from outside meets
    double reachable = 0;  // m² of `area` in the part within which plants get from everywhere to everywhere
    // Walks that began there, two radii long, and those of them that end where the model goes on.
    uint32_t walks = 0, ended = 0;
    // Of `area`: reachable, less the share of walks that end so.
    double share() const;
};

// What a material covers, triangles without area aside.
struct MaterialArea {
    std::string name;
    double area = 0;  // m²
    bool bare = false;
};

// Pieces of one material that are much longer than wide, all of whose charts are less than four texels wide.
struct Thread {
    std::string material;
    uint32_t pieces = 0;
    double area = 0;                    // m²
    double texels = 1e300, metres = 0;  // how wide the narrowest is
    glm::vec3 at{0};                    // the middle of that one
    uint32_t wants = 0;                 // the resolution at which it has four texels; 0: more than 8192
};

// The figures of a bake; see docs/surface_format.md for the meaning of each.
struct BakeReport {
    std::string source;
    glm::dvec3 origin{0};
    uint32_t triangles = 0, charts = 0;
    uint64_t innerTexels = 0, linkTexels = 0, openTexels = 0, buriedTexels = 0, bareTexels = 0;
    uint32_t seamCrossings = 0, nearestCrossings = 0, contactCrossings = 0, danglingCrossings = 0, danglingContacts = 0;
    double touching = 0;  // metres: pieces and borders that are nearer to each other are joined
    double walkableArea = 0;
    double charted = 0;  // share of the model's area that is in charts; what others cover exactly isn't asked for
    double stretch50 = 0, stretch95 = 0, stretchMax = 0;
    Distortion ofArea, ofAngle;
    double roundTrip50 = 0, roundTrip999 = 0;                  // texels
    double gap999 = 0;                                         // local texels
    std::vector<std::pair<uint32_t, double>> walkableByLevel;  // size, area share of charts walkable on it
    std::vector<UvFate> uvs;
    std::vector<MaterialArea> materials;
    std::vector<PieceReach> pieces;  // the largest first
    std::vector<Thread> threads;     // one a material
    uint32_t madeCharts = 0;         // of `charts`: not the model's own
    uint64_t overlaps = 0;           // texels of the finest level that two triangles claim
    bool layoutKept = false;         // charts lie where the model has them
    std::vector<std::pair<std::string, double>> seconds;
    std::vector<Diagnostic> warnings;
    double reachableShare() const;  // of all pieces' ground; 1 where there is none
    double leastReachable() const;  // the least share of a piece that holds a thousandth of the ground or more
    double endedWalks() const;      // share of all walks
    std::string json() const;
};

struct Baked {
    SurfaceData surface;
    BakeReport report;
};

// Reads glTF 2.0, OBJ or PLY (tools/bake/import_model.hpp, which has further options).
// uvSet: which TEXCOORD, 0 to 7, of a glTF file the walk's charts come from; materials keep theirs.
Result<Model> importModel(const std::string& path, int uvSet = 0);

// Refuses models whose UVs can't serve, saying what is wrong and how much of the area it concerns.
Result<Baked> bake(const Model& model, const BakeOptions& options);
// What bake() asks of its options before all else; sets how many levels there will be. name: for the message.
Status checkOptions(const std::string& name, BakeOptions& options);

}  // namespace espalier
