#pragma once

// The baker's mesh. It comes into being in steps: points, triangles and twins from positions alone (buildMesh);
// charts and their UVs (makeAtlas); their places on the walk's UV square (layOut).
//
// Half-edge 3 t + k runs from corner k to corner (k + 1) % 3 of triangle t.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "runtime/surface/contacts.hpp"
#include "runtime/surface/grid_segment.hpp"
#include "runtime/surface/mesh_tree.hpp"
#include "tools/bake/bake.hpp"

namespace espalier::bakery {

constexpr uint32_t kNone = 0xFFFFFFFFu;

struct Triangle {
    std::array<uint32_t, 3> point;  // into BakeMesh::points
    std::array<glm::dvec2, 3> uv;   // the walk's
    uint32_t source;                // triangle of the model
    uint32_t chart;
    bool turned;  // corners 1 and 2 are exchanged against the model's
    bool bare;    // of a bare material: no ground
};

// The model's vertex at corner k of a triangle.
inline uint32_t vertexAt(const Model& model, const Triangle& t, size_t k) {
    return model.indices[size_t(t.source) * 3 + (t.turned && k > 0 ? 3 - k : k)];
}

struct BakeMesh {
    std::vector<glm::dvec3> points;       // welded
    std::vector<Triangle> triangles;      // those with area; sorted by chart once there are charts
    std::vector<uint32_t> twin;           // per half-edge: the half-edge on the other side, kNone at borders
    std::vector<uint8_t> joined;          // per half-edge: 1 where the chart goes on across it
    std::vector<float> orientation;       // per chart: sign of its triangles in UV
    std::vector<uint32_t> firstTriangle;  // per chart and one more: where its triangles begin
    std::vector<glm::vec3> normals;       // per corner: the shading normal
    std::vector<float> curvature;         // per point, 1/m, positive on bulges
    glm::dvec3 boundsMin{0}, boundsMax{0};
    size_t crowdedEdges = 0;  // edges of more than two triangles
    bool metric = false;      // UVs are in metres and charts lie anywhere: layOut has to place them
    double radius = 0;        // half the diagonal of the bounds
    double area = 0;          // of the model, what is left out included
    double copied = 0;        // of that: triangles that others cover exactly

    uint32_t chartCount() const { return uint32_t(orientation.size()); }
    uint32_t chartOf(uint32_t halfEdge) const { return triangles[halfEdge / 3].chart; }
    glm::dvec2 uvAt(uint32_t halfEdge) const { return triangles[halfEdge / 3].uv[halfEdge % 3]; }
    glm::dvec3 pointAt(uint32_t halfEdge) const { return points[triangles[halfEdge / 3].point[halfEdge % 3]]; }
    // Does bare ground begin between two triangles?
    bool parted(uint32_t t, uint32_t u) const { return triangles[t].bare != triangles[u].bare; }
    static uint32_t next(uint32_t halfEdge) { return halfEdge % 3 == 2 ? halfEdge - 2 : halfEdge + 1; }
};

inline double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}
inline double uvArea(const Triangle& t) {
    return cross(t.uv[1] - t.uv[0], t.uv[2] - t.uv[0]) / 2;
}
double area3(const BakeMesh& mesh, const Triangle& t);
// The angle by which a walk that comes to half-edge a turns towards its outside until it stands on b's triangle, which
// runs along the same edge the other way, (0, 2 pi]. Faces that coincide count as back to back.
double outsideAngle(const BakeMesh& mesh, uint32_t a, uint32_t b);

// Welds and pairs edges, by positions alone: fills in points, triangles without chart and UV, twins and measures.
// Refuses models without area or with NaN.
Result<BakeMesh> buildMesh(const Model& model, std::vector<Diagnostic>& warnings);

// Drops triangles that others cover exactly, and fins smaller than finArea (m²), before edges are paired; returns how
// many.
size_t dropCopies(BakeMesh& mesh, double finArea);

// Cuts the mesh into charts and gives every corner its UV: sorts triangles by chart (twins follow), fills in joined,
// orientation and firstTriangle. Charts may still lie over each other: layOut places them.
// resolution: of the finest level, in which charts should be wide enough for their gutters.
// keep: the model's charts serve however stretched or narrow they are.
Status makeAtlas(const Model& model, BakeMesh& mesh, uint32_t resolution, bool keep, BakeReport& report);

// Puts shading normals and mean curvature on the mesh.
void addNormalsAndCurvature(const Model& model, BakeMesh& mesh);

// Which texel a level holds: an inner texel's triangle, a gutter texel's half-edge, or nothing.
constexpr uint32_t kGutterBit = 0x80000000u;
struct IdImage {
    uint32_t size = 0;
    std::vector<uint32_t> id;  // row by row: kNone, triangle, or kGutterBit | half-edge
};

// Keeps the charts where they are, moved into [0,1]² as a whole, if none lies over another and their gutters are wide
// enough, and densities are even; else places each anew. Refuses models whose charts don't fit.
// Returns per chart the coarsest level that its place allows for; later rasterising may lower it. finest: the triangles
// as they lie then, drawn at the resolution. Touches nothing of the mesh but its UVs.
struct LayoutOptions {
    uint32_t resolution, levels;
    bool keep;
    std::vector<double> density;  // per chart, to the densest; empty: even
};
Result<std::vector<uint32_t>> layOut(BakeMesh& mesh, const std::string& name, const LayoutOptions& options,
                                     IdImage& finest, BakeReport& report);

// What is painted on each chart, as a share of the densest chart's: LayoutOptions::density. weights: in the model's
// UVs.
std::vector<double> chartDensities(const Model& model, const BakeMesh& mesh, const UvPicture& weights);

// Places charts as masks on a grid so that their bands don't meet. levelOf(scale) is decided within.
// Returns per chart the offset, and the one scale: uv' = uv * scale + offset; scale 0: nothing fits.
struct Placement {
    double scale = 0;
    std::vector<glm::dvec2> offset;
    std::vector<uint32_t> coarsest;
};
Placement packCharts(const BakeMesh& mesh, uint32_t resolution, uint32_t levels);

// A piece of border and where it leads; the crossing's records are made from it.
struct Link {
    uint32_t from, to;    // half-edges; to = kNone: open
    double from0, from1;  // parameters along `from`, from0 < from1
    double to0, to1;      // along `to`, of the same points: to0 > to1; to0 < to1: it leads to the back
    uint32_t kind;        // kCrossingSeam...
};
std::vector<Link> findLinks(const BakeMesh& mesh, double tolerance);
std::vector<Crossing> makeCrossings(const BakeMesh& mesh, const std::vector<Link>& links);

// Triangles that a crossing leads from and to; kNone: open.
struct Sides {
    uint32_t from, to;
};

// Bare ground. Borders between it and ground inside of charts, each as an open link of the ground's side.
std::vector<Link> bareBorders(const BakeMesh& mesh);
// Makes what leads from ground to bare ground, or back, lead nowhere. sides: of each crossing.
// Seams keep their targets: they tell what is one piece.
void closeTowardsBare(const BakeMesh& mesh, const std::vector<Sides>& sides, std::vector<Crossing>& crossings);
// Makes inner texels on bare triangles kTexelLink. They keep their clearance, so that a walk that should get past the
// border ends there. Returns their number.
uint64_t takeBareTexels(const BakeMesh& mesh, SurfaceLevelData& level);

// Draws triangles' centres. overlaps: texels that a second triangle would have covered as well.
void drawTriangles(const BakeMesh& mesh, uint32_t size, IdImage& image, uint64_t* overlaps);

// Draws gutters around charts for which walkable[chart] is set, nearest border first, and clears the flag of each
// chart that misses a texel which a bilinear read inside of it needs. Returns whether a flag was cleared.
bool drawGutters(const BakeMesh& mesh, const std::vector<uint32_t>& borders, IdImage& image,
                 std::vector<uint8_t>& walkable);

// Half-edges across which their chart doesn't go on, ascending.
std::vector<uint32_t> borderEdges(const BakeMesh& mesh);

// What composing needs of a triangle: its affine map P(uv) = p0 + e1 (g1 · d) + e2 (g2 · d), d = uv - uv0.
struct Plane {
    glm::dvec2 uv0;
    glm::vec2 g1, g2;
    glm::vec3 p0, e1, e2;
    glm::vec3 normal;  // of the flat triangle, outward
};
std::vector<Plane> makePlanes(const BakeMesh& mesh);

// What all levels are made from.
struct LevelSource {
    const BakeMesh& mesh;
    const std::vector<Plane>& planes;
    const std::vector<TrianglePlane>& records;  // the same maps, as texels' positions are taken from them
    const std::vector<Link>& links;
    const std::vector<Crossing>& crossings;  // one per link, then the contacts
    const std::vector<uint32_t>& creases;
    const std::vector<Chart>& charts;
};

// Makes one level from its ids. Clears walkable[chart] where a texel meets more crossings than a record can count.
SurfaceLevelData composeLevel(const LevelSource& source, const IdImage& image, std::vector<uint8_t>& walkable);

// Half-edges (one of each pair) inside of charts whose triangles meet at more than 15°.
std::vector<uint32_t> creaseEdges(const BakeMesh& mesh);

// Fills in the mesh as it is drawn: vertices split where charts were moved apart, ranges by material.
void makeDrawing(const Model& model, const BakeMesh& mesh, SurfaceData& surface);

// The drawn mesh, to ask distances of.
MeshTree drawnTree(const SurfaceData& surface);
// Fills in surface.coarser: each about half the triangles of the one before. drawn: the drawn mesh. Touches nothing
// else.
void simplifyDrawing(const MeshTree& drawn, SurfaceData& surface);
// Measures the levels' distances to the drawn mesh.
void measureLevelErrors(const MeshTree& drawn, SurfaceData& surface);

// Fills in how far triangles' maps are from their charts' mean scale: in their worst direction, by their area, and,
// whatever their scale, by their shape. Of the surface only charts and triangles are read.
void measureStretch(const BakeMesh& mesh, const SurfaceData& surface, BakeReport& report);

// Fills in the report's other figures by walking through the finished surface's records. sides: of each crossing.
// drawn: the drawn mesh.
void measure(const Model& model, const BakeMesh& mesh, const std::vector<Sides>& sides, const MeshTree& drawn,
             const SurfaceData& surface, BakeReport& report);

// Pieces that are too thin for the resolution, by material.
std::vector<Thread> findThreads(const Model& model, const BakeMesh& mesh, const SurfaceData& surface,
                                uint32_t resolution);

// The model's connected pieces, contacts included, the largest first, and how far plants get about on each.
std::vector<PieceReach> measureReach(const BakeMesh& mesh, const std::vector<Sides>& sides, const MeshTree& drawn,
                                     const SurfaceData& surface);

}  // namespace espalier::bakery
