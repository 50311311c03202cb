#pragma once

// How the atlas is made: charts of the model's UVs are judged; triangles of those that can't serve, or of models
// without any, are segmented into regions and each region is flattened, and cut again where that takes too much
// stretch.

#include <span>

#include "runtime/core/disjoint_sets.hpp"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

// Why triangles don't keep the UVs that the model has.
enum class UvFault : uint8_t { none, missing, collapsed, folded, overlapping, stretched, narrow };
constexpr size_t kUvFaults = 7;
const char* toString(UvFault fault);

// The model's UV charts and what each is worth. Triangles without usable UVs are islands too, with their fault.
struct Islands {
    std::vector<std::vector<uint32_t>> triangles;  // of each island, ascending
    std::vector<UvFault> fault;                    // of each island
    std::vector<uint8_t> mended;                   // of each island: 1: flattened anew within its own outline
    std::vector<uint32_t> island;                  // of each triangle
    std::vector<uint8_t> cut;                      // per half-edge: 1 where no island goes on across it
};
// Gives corners the model's UVs, where it has any; in islands that could be mended UVs in metres. resolution: of the
// finest level. keep: islands serve however stretched or narrow they are.
Islands judgeUvs(const Model& model, BakeMesh& mesh, uint32_t resolution, bool keep);

// Flat measures of the mesh's triangles, made once.
struct Facets {
    std::vector<glm::dvec3> normal;  // unit
    std::vector<double> area;        // m²
    double total = 0;
};
Facets measureFacets(const BakeMesh& mesh);

// Groups triangles for which wanted[t] is set into connected regions that flatten well: few, compact, bordered by
// creases where there are any. label: per triangle, kNone where not wanted; returns how many regions there are.
uint32_t segment(const BakeMesh& mesh, const Facets& facets, const std::vector<uint8_t>& wanted,
                 std::vector<uint32_t>& label);

// A connected set of triangles with vertices of its own, to be flattened. Local half-edge 3 t + k as in BakeMesh.
struct Patch {
    std::vector<uint32_t> triangles;              // of the mesh
    std::vector<std::array<uint32_t, 3>> corner;  // per triangle: vertices
    std::vector<uint32_t> twin;                   // per local half-edge: the local one that it is glued to, or kNone
    std::vector<glm::dvec3> point;                // per vertex
    std::vector<glm::dvec2> uv;                   // per vertex, metres; empty until flattened; a part has the whole's
};

// Glues the triangles along the edges that two of them share, but for those with cut[half-edge of the mesh]. region: of
// each triangle of the mesh; that of these is theirs alone. local: scratch of the mesh's size; only the entries of
// these triangles are touched, so that other threads may make patches of other regions.
Patch makePatch(const BakeMesh& mesh, std::span<const uint32_t> triangles, const std::vector<uint32_t>& region,
                const std::vector<uint8_t>& cut, std::vector<uint32_t>& local);

// Border loops as lists of local half-edges, the longest first.
std::vector<std::vector<uint32_t>> borderLoops(const Patch& patch);
// Whether it is a disk, with or without holes.
bool canFlatten(const Patch& patch);

// 95th percentile of a chart's area: what is stretched more can't serve.
constexpr double kMostStretch = 1.5;

// What a flattening is worth.
struct PatchVerdict {
    std::vector<uint32_t> tangled;  // vertices at turned over triangles, at cones that wind twice, of holes inside out
    std::vector<uint32_t> crossed;  // vertices where the outer border meets itself within a few edges
    bool torn = false;              // holes meet something or are inside out
    bool overlapping = false;       // the outer border meets itself from afar, or runs the wrong way round
    double stretch95 = 0;           // of its area
    double stretchMax = 0;
    bool good() const { return tangled.empty() && crossed.empty() && !overlapping; }
    bool serves() const { return good() && stretch95 <= kMostStretch; }
    bool excels() const { return serves() && stretchMax <= kMostStretch * 2; }
    bool settled() const { return excels() || torn; }  // more rounds won't change it
};
PatchVerdict judgePatch(const Patch& patch);

// Gives the patch UVs in metres, with little stretch; more work goes into patches that can't serve yet. The result may
// be bad all the same.
PatchVerdict flatten(Patch& patch);

// Makes the UVs that the patch has more rigid, by a few rounds, until it serves: what is one to one mostly stays so.
PatchVerdict relax(Patch& patch);

// Spreads vertices out evenly around those named, within some rings of triangles: what is tangled there mostly isn't
// afterwards. The outer border stays.
void untangle(Patch& patch, const std::vector<uint32_t>& tangled, int rings);

// Divides a patch that can't be a chart: cuts out what is tangled or crossed where that is little, else halves it along
// creases. Connected parts, at least two, with the UVs that they have in the whole. At least two triangles.
std::vector<Patch> divide(const BakeMesh& mesh, const Facets& facets, const Patch& patch, const PatchVerdict& verdict);

// Joins small charts, numbered from `first` on, to others as one unfolds a box; UVs are in metres. Returns how many
// charts there are then.
uint32_t foldOut(BakeMesh& mesh, uint32_t first, uint32_t charts);

}  // namespace espalier::bakery
