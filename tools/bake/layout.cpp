// In: charts where the model's UVs put them, or anywhere. Out: charts in [0,1]², none over another, far enough apart
// for the band of texels around them.
#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {
namespace {

constexpr double kGuessedFill = 0.6;     // of the square: what charts may cover when there were no bands
constexpr double kLeastDensity = 0.125;  // of the densest chart: what is painted darker gets so many texels a metre
constexpr int kTurns = 24;               // angles tried to lay a chart into the smallest box
constexpr double kWalkableShare = 0.9;   // of the area: kept layouts let so much be walked at the coarsest level

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
    drawTriangles(mesh, size, image, nullptr);
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

// The turn by which the chart's box gets smallest, as (cosine, sine): one that lays a long border edge flat, if there
// are straight ones, or one of evenly spaced angles. border: starts of border edges, with where they lead.
glm::dvec2 smallestBox(const std::vector<std::pair<glm::dvec2, glm::dvec2>>& border) {
    std::vector<glm::dvec2> turns, longest;
    for (const auto& [a, b] : border) longest.push_back(b - a);
    size_t some = std::min(longest.size(), size_t(kTurns));
    std::partial_sort(longest.begin(), longest.begin() + long(some), longest.end(),
                      [](glm::dvec2 x, glm::dvec2 y) { return glm::dot(x, x) > glm::dot(y, y); });
    for (size_t i = 0; i < some; ++i) turns.push_back(glm::normalize(glm::dvec2(longest[i].x, -longest[i].y)));
    for (int i = 0; i < kTurns; ++i) {
        double angle = i * (1.5707963267948966 / kTurns);
        turns.push_back({std::cos(angle), std::sin(angle)});
    }
    glm::dvec2 best(1, 0);
    double least = 1e300;
    for (glm::dvec2 turn : turns) {
        glm::dvec2 low(1e300), high(-1e300);
        for (const auto& [p, unused] : border) {
            glm::dvec2 q(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y);
            low = glm::min(low, q), high = glm::max(high, q);
        }
        double box = (high.x - low.x) * (high.y - low.y);
        if (box < least * (1 - 1e-6)) least = box, best = turn;
    }
    return best;
}

// Scales the chart to `scale` UV a metre.
void turnIntoBox(BakeMesh& mesh, uint32_t chart, double scale) {
    double area = 0, flat = 0;
    std::vector<std::pair<glm::dvec2, glm::dvec2>> border;
    uint32_t first = mesh.firstTriangle[chart], last = mesh.firstTriangle[chart + 1];
    for (uint32_t t = first; t < last; ++t) {
        area += area3(mesh, mesh.triangles[t]), flat += std::abs(uvArea(mesh.triangles[t]));
        for (uint32_t h = t * 3; h < t * 3 + 3; ++h)
            if (!mesh.joined[h]) border.push_back({mesh.uvAt(h), mesh.uvAt(BakeMesh::next(h))});
    }
    glm::dvec2 turn = smallestBox(border), low(1e300);
    scale *= std::sqrt(area / flat);
    auto place = [&](glm::dvec2 p) {
        return glm::dvec2(turn.x * p.x - turn.y * p.y, turn.y * p.x + turn.x * p.y) * scale;
    };
    for (const auto& [p, unused] : border) low = glm::min(low, place(p));
    for (uint32_t t = first; t < last; ++t)
        for (glm::dvec2& uv : mesh.triangles[t].uv) uv = place(uv) - low;
}

// Gives every chart its density, turns it into its smallest box, lower left corner at the origin; all together as large
// as would just about fill the square.
void makeMetric(BakeMesh& mesh, const std::vector<double>& density) {
    auto of = [&](size_t chart) { return density.empty() ? 1.0 : density[chart]; };
    double total = 0;
    for (const Triangle& t : mesh.triangles) total += area3(mesh, t) * of(t.chart) * of(t.chart);
    double all = std::sqrt(kGuessedFill / total);
    parallelFor(mesh.chartCount(), 4, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) turnIntoBox(mesh, uint32_t(c), all * of(c));
    });
    mesh.metric = true;
}

}  // namespace

std::vector<double> chartDensities(const Model& model, const BakeMesh& mesh, const UvPicture& weights) {
    std::vector<double> sum(mesh.chartCount(), 0), area(mesh.chartCount(), 0);
    for (const Triangle& t : mesh.triangles) {
        glm::vec2 corner[3], middle(0);
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec2 uv = model.uvs[vertexAt(model, t, k)];
            corner[k] = glm::length(uv) < 1e6f ? uv : glm::vec2(0);
            middle += corner[k] / 3.0f;
        }
        // Tiled UVs mean the same place of the picture; the middle's tile is taken for all.
        const glm::vec2 tile = glm::floor(middle);
        double mean = 0;
        for (glm::vec2 c : corner) mean += weights.at((c + middle) / 2.0f - tile) / 3;
        sum[t.chart] += area3(mesh, t) * mean, area[t.chart] += area3(mesh, t);
    }
    double most = 0;
    for (size_t c = 0; c < sum.size(); ++c) most = std::max(most, sum[c] /= area[c]);
    for (double& d : sum) d = most > 0 ? std::max(d / most, kLeastDensity) : 1;
    return sum;
}

Result<std::vector<uint32_t>> layOut(BakeMesh& mesh, const std::string& name, const LayoutOptions& options,
                                     IdImage& finest, BakeReport& report) {
    std::vector<uint32_t> coarsest(mesh.chartCount(), options.levels - 1);
    if (!mesh.metric && options.density.empty()) {
        if (enclose(mesh))
            report.warnings.push_back(
                {name, 0, 0, {}, "UVs outside of [0,1]²: the walk's charts were moved into it", true});
        drawTriangles(mesh, options.resolution, finest, &report.overlaps);
        report.layoutKept = options.keep;
        if (options.keep) return coarsest;
        std::vector<uint32_t> borders = borderEdges(mesh);
        uint32_t last = options.resolution >> (options.levels - 1);
        if (report.overlaps == 0 && walkableShare(mesh, borders, last) >= kWalkableShare &&
            walkableShare(mesh, borders, options.resolution) > 1 - 1e-12) {
            report.layoutKept = true;
            return coarsest;
        }
    }
    makeMetric(mesh, options.density);
    Placement placed = packCharts(mesh, options.resolution, options.levels);
    if (placed.scale <= 0)
        return Failure(name, std::to_string(mesh.chartCount()) + " charts don't fit into " +
                                 std::to_string(options.resolution) +
                                 "² with room around each: bake at a higher resolution");
    for (Triangle& t : mesh.triangles)
        for (glm::dvec2& uv : t.uv) uv = uv * placed.scale + placed.offset[t.chart];
    drawTriangles(mesh, options.resolution, finest, &report.overlaps);
    return std::move(placed.coarsest);
}

}  // namespace espalier::bakery
