// In: the welded mesh and the model's UVs. Out: islands: sets of triangles of one orientation in UV, connected across
// edges on whose UVs both sides agree; and of each whether it can be a chart, or why not.
#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr double kUvTolerance = 1e-6;  // within which two corners' UVs agree
constexpr double kMinUvArea = 1e-13;   // of a triangle; below, its map has no inverse worth the name
constexpr double kNarrowTexels = 3;    // charts narrower than that on the finest level are remade with their neighbours
constexpr double kWorthMending = 0.003;  // of the area: charts above that keep their outline if they can
constexpr double kAtlasFill = 0.5;       // the share of the square that charts will cover, as a guess
constexpr size_t kFoldTriangles = 4;     // flipped islands up to this many triangles are folds of the chart around them

bool uvsAgree(const BakeMesh& mesh, uint32_t h, uint32_t twin) {
    glm::dvec2 d0 = mesh.uvAt(h) - mesh.uvAt(BakeMesh::next(twin));
    glm::dvec2 d1 = mesh.uvAt(BakeMesh::next(h)) - mesh.uvAt(twin);
    double most = std::max(std::max(std::abs(d0.x), std::abs(d0.y)), std::max(std::abs(d1.x), std::abs(d1.y)));
    return most <= kUvTolerance;
}

// Gives corners the model's UVs; tells of each triangle whether they are of use.
std::vector<UvFault> readUvs(const Model& model, BakeMesh& mesh) {
    std::vector<UvFault> fault(mesh.triangles.size(), UvFault::none);
    for (size_t t = 0; t < fault.size(); ++t) {
        Triangle& triangle = mesh.triangles[t];
        bool finite = !model.uvs.empty();
        for (size_t k = 0; k < 3 && finite; ++k) {
            triangle.uv[k] = glm::dvec2(model.uvs[vertexAt(model, triangle, k)]);
            finite = std::abs(triangle.uv[k].x) < 1e6 && std::abs(triangle.uv[k].y) < 1e6;
        }
        if (!finite)
            fault[t] = UvFault::missing;
        else if (std::abs(uvArea(triangle)) < kMinUvArea)
            fault[t] = UvFault::collapsed;
    }
    return fault;
}

// The island's patch with its UVs scaled to metres, as judgePatch takes them.
void takeUvs(const BakeMesh& mesh, Patch& patch) {
    double area = 0, flat = 0;
    for (uint32_t t : patch.triangles) area += area3(mesh, mesh.triangles[t]), flat += uvArea(mesh.triangles[t]);
    glm::dvec2 scale(std::sqrt(area / std::abs(flat)));
    if (flat < 0) scale.x = -scale.x;
    patch.uv.resize(patch.point.size());
    for (size_t t = 0; t < patch.triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) patch.uv[patch.corner[t][k]] = mesh.triangles[patch.triangles[t]].uv[k] * scale;
}

bool isNarrow(const Patch& patch, double texel) {
    double area = 0, border = 0;
    for (size_t t = 0; t < patch.triangles.size(); ++t) {
        glm::dvec2 p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = patch.uv[patch.corner[t][k]];
        area += cross(p[1] - p[0], p[2] - p[0]) / 2;
        for (size_t k = 0; k < 3; ++k)
            if (patch.twin[t * 3 + k] == kNone) border += glm::length(p[(k + 1) % 3] - p[k]);
    }
    return 2 * area < kNarrowTexels * texel * border;
}

UvFault judgeIsland(const BakeMesh& mesh, Patch& patch, double texel) {
    takeUvs(mesh, patch);
    PatchVerdict verdict = judgePatch(patch);
    if (!verdict.good()) return UvFault::overlapping;
    if (!verdict.serves()) return UvFault::stretched;
    bool hasNeighbours = false;
    for (size_t h = 0; h < patch.twin.size() && !hasNeighbours; ++h)
        hasNeighbours = patch.twin[h] == kNone && mesh.twin[patch.triangles[h / 3] * 3 + h % 3] != kNone;
    return hasNeighbours && isNarrow(patch, texel) ? UvFault::narrow : UvFault::none;
}

// Flattens an island that overlaps itself or is stretched: seams stay where an artist put them. If that tangles it,
// what is only stretched is made as rigid as it needs to be.
bool mend(BakeMesh& mesh, Patch& patch, double texel, bool stretched) {
    if (!canFlatten(patch)) return false;
    const std::vector<glm::dvec2> given = patch.uv;
    bool serves = flatten(patch).serves();
    if (!serves && stretched) {
        patch.uv = given;
        serves = relax(patch).serves();
    }
    if (!serves || isNarrow(patch, texel)) return false;
    for (size_t t = 0; t < patch.triangles.size(); ++t)
        for (size_t k = 0; k < 3; ++k) mesh.triangles[patch.triangles[t]].uv[k] = patch.uv[patch.corner[t][k]];
    return true;
}

}  // namespace

const char* toString(UvFault fault) {
    switch (fault) {
        case UvFault::none:
            return "kept";
        case UvFault::missing:
            return "without UVs";
        case UvFault::collapsed:
            return "collapsed to points or lines";
        case UvFault::folded:
            return "folded";
        case UvFault::overlapping:
            return "overlapping itself";
        case UvFault::stretched:
            return "stretched";
        case UvFault::narrow:
            return "too narrow for a gutter";
    }
    return "";
}

Islands judgeUvs(const Model& model, BakeMesh& mesh, uint32_t resolution, bool keep) {
    size_t count = mesh.triangles.size();
    Islands out;
    std::vector<UvFault> fault = readUvs(model, mesh);
    DisjointSets sets(count);
    out.cut.assign(count * 3, 1);
    std::vector<uint32_t> folds;  // half-edges across which UVs agree but the orientation turns
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t twin = mesh.twin[h];
        if (twin == kNone || fault[h / 3] != fault[twin / 3]) continue;
        if (fault[h / 3] == UvFault::none) {
            if (!uvsAgree(mesh, h, twin)) continue;
            if ((uvArea(mesh.triangles[h / 3]) > 0) != (uvArea(mesh.triangles[twin / 3]) > 0)) {
                folds.push_back(h);
                continue;
            }
            out.cut[h] = 0;
        }
        sets.join(h / 3, twin / 3);
    }
    // Number islands by their first triangle; list their triangles.
    out.island.assign(count, kNone);
    std::vector<uint32_t> number(count, kNone);
    for (uint32_t t = 0; t < count; ++t) {
        uint32_t& n = number[sets.find(t)];
        if (n == kNone) {
            n = uint32_t(out.triangles.size());
            out.triangles.emplace_back();
            out.fault.push_back(fault[t]);
        }
        out.island[t] = n;
        out.triangles[n].push_back(t);
    }
    for (uint32_t h : folds) {
        uint32_t a = out.island[h / 3], b = out.island[mesh.twin[h] / 3];
        uint32_t small = out.triangles[a].size() < out.triangles[b].size() ? a : b;
        if (!keep && out.triangles[small].size() <= kFoldTriangles) out.fault[a] = out.fault[b] = UvFault::folded;
    }
    out.mended.assign(out.triangles.size(), 0);
    double texel = std::sqrt(mesh.area / kAtlasFill) / resolution;
    std::vector<uint32_t> local(count, 0);
    std::vector<uint32_t> order;  // the largest first, so that no thread is left alone with it
    for (uint32_t i = 0; i < out.triangles.size(); ++i)
        if (out.fault[i] == UvFault::none && !keep) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return out.triangles[a].size() > out.triangles[b].size(); });
    parallelFor(order.size(), 1, [&](size_t begin, size_t end) {
        for (uint32_t i : std::span(order).subspan(begin, end - begin)) {
            Patch patch = makePatch(mesh, out.triangles[i], out.island, out.cut, local);
            out.fault[i] = judgeIsland(mesh, patch, texel);
            double area = 0;
            for (uint32_t t : out.triangles[i]) area += area3(mesh, mesh.triangles[t]);
            bool large = area > kWorthMending * mesh.area;  // small ones had better be joined to others
            if (large && (out.fault[i] == UvFault::overlapping || out.fault[i] == UvFault::stretched))
                out.mended[i] = mend(mesh, patch, texel, out.fault[i] == UvFault::stretched);
        }
    });
    return out;
}

}  // namespace espalier::bakery
