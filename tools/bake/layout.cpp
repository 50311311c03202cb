// In: charts where the model's UVs put them. Out: charts in [0,1]², none over another, far enough apart for the
// band of texels around them; refusal with figures where the UVs can't serve.
#include <algorithm>
#include <cmath>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr double kOverlapRefused = 0.005;  // of the covered texels
constexpr double kWalkableShare = 0.9;     // of the area: kept layouts let so much be walked at the coarsest level

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", share * 100);
    return text;
}

void transform(BakeMesh& mesh, double scale, glm::dvec2 offset) {
    for (Triangle& t : mesh.triangles)
        for (glm::dvec2& uv : t.uv) uv = uv * scale + offset;
}

// Brings UVs that lie elsewhere into the unit square, by whole numbers where that does.
bool enclose(BakeMesh& mesh) {
    glm::dvec2 low(1e300), high(-1e300);
    for (const Triangle& t : mesh.triangles)
        for (glm::dvec2 uv : t.uv) low = glm::min(low, uv), high = glm::max(high, uv);
    if (low.x >= 0 && low.y >= 0 && high.x <= 1 && high.y <= 1) return false;
    glm::dvec2 shift(std::floor(low.x + 1e-6), std::floor(low.y + 1e-6));
    glm::dvec2 top = high - shift, bottom = low - shift;
    if (bottom.x >= 0 && bottom.y >= 0 && top.x <= 1 && top.y <= 1) {
        transform(mesh, 1, -shift);
        return true;
    }
    double scale = 0.998 / std::max(high.x - low.x, high.y - low.y);
    transform(mesh, scale, glm::dvec2(0.001) - low * scale);
    return true;
}

std::vector<double> chartAreas(const BakeMesh& mesh) {
    std::vector<double> area(mesh.chartCount(), 0);
    for (const Triangle& t : mesh.triangles) area[t.chart] += area3(mesh, t);
    return area;
}

// The area share of charts that can be walked on a level of this size where the charts lie now.
double walkableShare(const BakeMesh& mesh, const std::vector<uint32_t>& borders, uint32_t size) {
    IdImage image;
    drawTriangles(mesh, size, image, nullptr, nullptr);
    std::vector<uint8_t> walkable(mesh.chartCount(), 1);
    drawGutters(mesh, borders, image, walkable);
    std::vector<double> area = chartAreas(mesh);
    double all = 0, good = 0;
    for (size_t c = 0; c < area.size(); ++c) {
        all += area[c];
        if (walkable[c]) good += area[c];
    }
    return good / all;
}

}  // namespace

Result<std::vector<uint32_t>> layOut(BakeMesh& mesh, const std::string& name, const LayoutOptions& options,
                                     std::vector<Diagnostic>& warnings) {
    auto warn = [&](std::string text) { warnings.push_back({name, 0, 0, {}, std::move(text), true}); };
    if (enclose(mesh)) warn("UVs outside of [0,1]²: the walk's charts were moved into it");
    IdImage image;
    uint64_t covered = 0, overlaps = 0;
    drawTriangles(mesh, options.resolution, image, &covered, &overlaps);
    if (covered == 0) return Failure(name, "the UVs cover no texel at all at this resolution");
    double share = double(overlaps) / double(covered);
    if (share > kOverlapRefused)
        return Failure(name, "the UVs overlap: " + percent(share) + " of the covered texels are hit more than once (" +
                                 std::to_string(overlaps) + " of " + std::to_string(covered) + " at " +
                                 std::to_string(options.resolution) + "²): an unwrapped UV set is needed to bake it");
    if (overlaps > 0) warn(percent(share) + " of the texels are covered more than once");
    std::vector<uint32_t> coarsest(mesh.chartCount(), options.levels - 1);
    if (options.keep) return coarsest;
    std::vector<uint32_t> borders = borderEdges(mesh);
    uint32_t last = options.resolution >> (options.levels - 1);
    if (walkableShare(mesh, borders, last) >= kWalkableShare &&
        walkableShare(mesh, borders, options.resolution) > 1 - 1e-12)
        return coarsest;
    Placement placed = packCharts(mesh, options.resolution, options.levels);
    if (placed.scale <= 0)
        return Failure(name, std::to_string(mesh.chartCount()) + " charts don't fit into " +
                                 std::to_string(options.resolution) +
                                 "² with room around each: bake at a higher resolution");
    for (Triangle& t : mesh.triangles)
        for (glm::dvec2& uv : t.uv) uv = uv * placed.scale + placed.offset[t.chart];
    return std::move(placed.coarsest);
}

}  // namespace espalier::bakery
