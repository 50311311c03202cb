// In: the mesh as it lies in the atlas. Out: threads, pieces much longer than wide all of whose charts are a few texels
// wide at this resolution: ropes, wires, bars of grilles. Bark on them has too few texels to follow.
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "runtime/core/disjoint_sets.hpp"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr double kFewTexels = 4;  // across a chart
constexpr double kWhole = 0.9;    // of a piece's area that lies in such charts
constexpr double kLong = 10;      // a thread's widths in its length
constexpr uint32_t kMostTexels = 8192;

// How wide each chart is, in UV: the shorter side of a rectangle of its area and outline, whatever way it winds.
std::vector<double> chartWidths(const BakeMesh& mesh) {
    std::vector<double> area(mesh.chartCount(), 0), outline(mesh.chartCount(), 0), width(mesh.chartCount());
    for (const Triangle& t : mesh.triangles) area[t.chart] += std::abs(uvArea(t));
    for (uint32_t h = 0; h < mesh.joined.size(); ++h)
        if (!mesh.joined[h]) outline[mesh.chartOf(h)] += glm::length(mesh.uvAt(BakeMesh::next(h)) - mesh.uvAt(h));
    for (size_t c = 0; c < width.size(); ++c) {
        const double sides = outline[c] / 2, square = sides * sides - 4 * area[c];
        width[c] = square > 0 ? (sides - std::sqrt(square)) / 2 : std::sqrt(area[c]);
    }
    return width;
}

// A connected piece of the mesh.
struct Piece {
    double area = 0, thin = 0;  // m²; of that in narrow charts
    double width = 1e300;       // texels, of the narrowest chart
    double metres = 0;          // how wide that one is
    uint32_t triangle = kNone;  // its first
    glm::dvec3 low{1e300}, high{-1e300};
    bool isThread() const { return area > 0 && thin >= kWhole * area && glm::length(high - low) >= kLong * metres; }
};

std::vector<Piece> findPieces(const BakeMesh& mesh, const SurfaceData& surface, uint32_t resolution) {
    DisjointSets sets(mesh.triangles.size());
    for (uint32_t h = 0; h < mesh.twin.size(); ++h)
        if (mesh.twin[h] != kNone) sets.join(h / 3, mesh.twin[h] / 3);
    std::vector<uint32_t> pieceOf;
    std::vector<Piece> pieces(sets.number(pieceOf));
    const std::vector<double> widths = chartWidths(mesh);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        Piece& piece = pieces[pieceOf[t]];
        const uint32_t chart = mesh.triangles[t].chart;
        const double area = area3(mesh, mesh.triangles[t]), width = widths[chart] * resolution;
        piece.area += area;
        piece.thin += width < kFewTexels ? area : 0;
        piece.triangle = std::min(piece.triangle, t);
        if (width < piece.width)
            piece.width = width, piece.metres = widths[chart] * double(surface.charts[chart].metresPerUv);
        for (uint32_t p : mesh.triangles[t].point)
            piece.low = glm::min(piece.low, mesh.points[p]), piece.high = glm::max(piece.high, mesh.points[p]);
    }
    return pieces;
}

}  // namespace

std::vector<Thread> findThreads(const Model& model, const BakeMesh& mesh, const SurfaceData& surface,
                                uint32_t resolution) {
    std::map<uint32_t, Thread> byMaterial;
    for (const Piece& piece : findPieces(mesh, surface, resolution)) {
        if (!piece.isThread()) continue;
        const uint32_t source = mesh.triangles[piece.triangle].source;
        const uint32_t material = model.triangleMaterial.empty() ? 0 : model.triangleMaterial[source];
        Thread& thread = byMaterial[material];
        if (material < model.materialNames.size()) thread.material = model.materialNames[material];
        ++thread.pieces;
        thread.area += piece.area;
        if (piece.width >= thread.texels) continue;
        thread.texels = piece.width;
        thread.metres = piece.metres;
        thread.at = glm::vec3((piece.low + piece.high) / 2.0);
        const double times = kFewTexels / std::max(piece.width, 1e-6);
        thread.wants = times * resolution <= kMostTexels ? std::bit_ceil(uint32_t(std::ceil(times * resolution))) : 0;
    }
    std::vector<Thread> threads;
    for (auto& [material, thread] : byMaterial) threads.push_back(std::move(thread));
    return threads;
}

}  // namespace espalier::bakery
