// In: the welded mesh and the model's UVs. Out: charts. Islands of the model's UVs that can serve are kept; all other
// triangles are segmented into regions, which are flattened, and halved until each can be a chart.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/core/jobs.hpp"
#include "tools/bake/atlas.hpp"

namespace espalier::bakery {
namespace {

constexpr int kMostRings = 2;        // around what is tangled
constexpr double kMostSmeared = 10;  // stretch of a triangle by smoothing: more had better be cut out
constexpr size_t kFewestKept = 64;   // triangles: smaller parts are flattened anew, which costs little

// Flattens a patch; where that leaves it tangled, tries to smooth it.
PatchVerdict flattenWell(Patch& patch) {
    PatchVerdict verdict = flatten(patch);
    if (verdict.tangled.empty()) return verdict;
    Patch spread = patch;
    PatchVerdict after = verdict;
    for (int rings = 1; rings <= kMostRings && !after.tangled.empty(); ++rings) {
        untangle(spread, after.tangled, rings);
        after = judgePatch(spread);
    }
    if (!after.serves() || after.stretchMax > kMostSmeared) return verdict;
    patch = std::move(spread);
    return after;
}

// Flattens one region; where it can't be a chart as a whole, its parts, and theirs. A part that can be one as it lies
// in the whole stays like that.
std::vector<Patch> makeCharts(const BakeMesh& mesh, const Facets& facets, Patch region) {
    std::vector<Patch> done, open;
    open.push_back(std::move(region));
    while (!open.empty()) {
        Patch patch = std::move(open.back());
        open.pop_back();
        PatchVerdict verdict;
        if (canFlatten(patch)) {
            const bool keep = !patch.uv.empty() && patch.triangles.size() >= kFewestKept;
            if (keep) verdict = judgePatch(patch);
            if (!keep || !verdict.excels()) verdict = flattenWell(patch);
            if (patch.triangles.size() == 1 || verdict.serves()) {
                done.push_back(std::move(patch));
                continue;
            }
        }
        for (Patch& part : divide(mesh, facets, patch, verdict)) open.push_back(std::move(part));
    }
    return done;
}

// Regions' charts, in the order of regions, whatever thread made them.
std::vector<Patch> flattenRegions(const BakeMesh& mesh, const Facets& facets, const std::vector<uint32_t>& label,
                                  uint32_t count) {
    std::vector<std::vector<uint32_t>> regions(count);
    for (uint32_t t = 0; t < label.size(); ++t)
        if (label[t] != kNone) regions[label[t]].push_back(t);
    std::vector<uint32_t> order(count), local(label.size(), 0);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return regions[a].size() > regions[b].size(); });
    std::vector<std::vector<Patch>> made(count);
    std::vector<uint8_t> cut(label.size() * 3, 0);
    parallelFor(count, 1, [&](size_t begin, size_t) {
        uint32_t r = order[begin];
        made[r] = makeCharts(mesh, facets, makePatch(mesh, regions[r], label, cut, local));
        regions[r] = {};
    });
    std::vector<Patch> all;
    for (auto& list : made)
        for (Patch& patch : list) all.push_back(std::move(patch));
    return all;
}

// The islands and their share of the area by what became of them, those that there are.
std::vector<UvFate> tell(const BakeMesh& mesh, const Islands& islands) {
    std::vector<UvFate> fates(kUvFaults);
    for (size_t i = 0; i < islands.fault.size(); ++i) {
        UvFate& fate = fates[size_t(islands.fault[i])];
        fate.cause = toString(islands.fault[i]);
        ++fate.charts;
        for (uint32_t t : islands.triangles[i]) fate.area += area3(mesh, mesh.triangles[t]) / mesh.area;
    }
    std::erase_if(fates, [](const UvFate& f) { return f.charts == 0; });
    return fates;
}

// Puts triangles in the order of their charts, given by Triangle::chart; twins follow.
void sortByChart(BakeMesh& mesh, uint32_t charts) {
    size_t count = mesh.triangles.size();
    mesh.firstTriangle.assign(charts + 1, 0);
    for (const Triangle& t : mesh.triangles) ++mesh.firstTriangle[t.chart + 1];
    for (size_t c = 0; c < charts; ++c) mesh.firstTriangle[c + 1] += mesh.firstTriangle[c];
    std::vector<uint32_t> at(mesh.firstTriangle.begin(), mesh.firstTriangle.end() - 1), moved(count);
    std::vector<Triangle> sorted(count);
    for (uint32_t t = 0; t < count; ++t) sorted[moved[t] = at[mesh.triangles[t].chart]++] = mesh.triangles[t];
    std::vector<uint32_t> twin(count * 3, kNone);
    std::vector<uint8_t> joined(count * 3, 0);
    for (uint32_t h = 0; h < count * 3; ++h) {
        uint32_t other = mesh.twin[h], to = moved[h / 3] * 3 + h % 3;
        if (other != kNone) twin[to] = moved[other / 3] * 3 + other % 3;
        joined[to] = mesh.joined[h];
    }
    mesh.triangles.swap(sorted);
    mesh.twin.swap(twin);
    mesh.joined.swap(joined);
}

}  // namespace

Status makeAtlas(const Model& model, BakeMesh& mesh, uint32_t resolution, bool keep, BakeReport& report) {
    size_t count = mesh.triangles.size();
    Islands islands = judgeUvs(model, mesh, resolution, keep);
    report.uvs = tell(mesh, islands);
    std::vector<uint8_t> wanted(count);
    size_t toMake = 0;
    uint32_t mended = 0;
    for (size_t t = 0; t < count; ++t) {
        uint32_t i = islands.island[t];
        toMake += wanted[t] = islands.fault[i] != UvFault::none && !islands.mended[i];
    }
    mesh.joined.assign(count * 3, 0);
    for (uint32_t h = 0; h < count * 3; ++h) mesh.joined[h] = !wanted[h / 3] && !islands.cut[h];
    for (uint8_t m : islands.mended) mended += m;
    mesh.metric = toMake + mended > 0;
    // Kept islands come first.
    uint32_t charts = 0;
    for (size_t i = 0; i < islands.triangles.size(); ++i) {
        if (islands.fault[i] != UvFault::none && !islands.mended[i]) continue;
        double area = 0, flat = 0;
        for (uint32_t t : islands.triangles[i]) {
            area += area3(mesh, mesh.triangles[t]), flat += uvArea(mesh.triangles[t]);
            mesh.triangles[t].chart = charts;
        }
        if (mesh.metric)
            for (uint32_t t : islands.triangles[i])
                for (glm::dvec2& uv : mesh.triangles[t].uv) uv *= std::sqrt(area / std::abs(flat));
        mesh.orientation.push_back(flat > 0 ? 1.0f : -1.0f);
        ++charts;
    }
    const uint32_t kept = charts;
    if (toMake > 0) {
        Facets facets = measureFacets(mesh);
        std::vector<uint32_t> label;
        uint32_t regions = segment(mesh, facets, wanted, label);
        for (const Patch& patch : flattenRegions(mesh, facets, label, regions)) {
            for (size_t i = 0; i < patch.triangles.size(); ++i) {
                Triangle& t = mesh.triangles[patch.triangles[i]];
                t.chart = charts;
                for (size_t k = 0; k < 3; ++k) {
                    t.uv[k] = patch.uv[patch.corner[i][k]];
                    mesh.joined[patch.triangles[i] * 3 + k] = patch.twin[i * 3 + k] != kNone;
                }
            }
            ++charts;
        }
        charts = foldOut(mesh, kept, charts);
        mesh.orientation.resize(charts, 1.0f);
    }
    if (charts > 65535)
        return Failure(model.name, "the model falls into " + std::to_string(charts) + " charts; 65535 is the limit");
    sortByChart(mesh, charts);
    report.madeCharts = charts - kept + mended;
    return Done{};
}

}  // namespace espalier::bakery
