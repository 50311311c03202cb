// In: a model. Out: its surface and the report: weld and cut into charts, lay out, link borders, rasterise each
// level, measure.
#include "tools/bake/bake.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <optional>

#include "runtime/core/jobs.hpp"
#include "runtime/surface/length_unit.hpp"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bake/beside.hpp"
#include "tools/bake/contact.hpp"
#include "tools/bake/repair.hpp"

namespace espalier {
namespace {

using namespace bakery;

constexpr double kSeenGap = 0.01;  // metres: what is farther apart is seen apart, and not joined

// Times stages and tells of progress.
class Stages {
  public:
    Stages(const BakeOptions& options, BakeReport& report) : options_(options), report_(report) {}
    void begin(float progress, const char* name) {
        end();
        name_ = name;
        start_ = Clock::now();
        if (options_.progress) options_.progress(progress, name);
    }
    void end() {
        if (!name_) return;
        report_.seconds.emplace_back(name_, std::chrono::duration<double>(Clock::now() - start_).count());
        name_ = nullptr;
    }

  private:
    using Clock = std::chrono::steady_clock;
    const BakeOptions& options_;
    BakeReport& report_;
    const char* name_ = nullptr;
    Clock::time_point start_;
};

std::vector<Chart> makeCharts(const BakeMesh& mesh) {
    std::vector<Chart> charts(mesh.chartCount());
    for (uint32_t c = 0; c < charts.size(); ++c) {
        glm::dvec2 low(1e300), high(-1e300);
        double area = 0, uv = 0;
        for (uint32_t t = mesh.firstTriangle[c]; t < mesh.firstTriangle[c + 1]; ++t) {
            for (glm::dvec2 p : mesh.triangles[t].uv) low = glm::min(low, p), high = glm::max(high, p);
            area += area3(mesh, mesh.triangles[t]);
            uv += std::abs(uvArea(mesh.triangles[t]));
        }
        charts[c] = {glm::vec2(low),        glm::vec2(high),
                     mesh.orientation[c],   0,
                     float(area),           float(std::sqrt(area / uv)),
                     mesh.firstTriangle[c], mesh.firstTriangle[c + 1] - mesh.firstTriangle[c]};
    }
    return charts;
}

std::vector<TrianglePlane> makeRecords(const BakeMesh& mesh) {
    std::vector<TrianglePlane> out(mesh.triangles.size());
    for (size_t t = 0; t < out.size(); ++t) {
        const Triangle& tri = mesh.triangles[t];
        // From the corner as records hold it, so that the map is exact where it begins.
        glm::dvec2 uv0(glm::vec2(tri.uv[0])), u1 = tri.uv[1] - tri.uv[0], u2 = tri.uv[2] - tri.uv[0];
        double det = cross(u1, u2);
        glm::dvec3 p0 = mesh.points[tri.point[0]], e1 = mesh.points[tri.point[1]] - p0,
                   e2 = mesh.points[tri.point[2]] - p0;
        glm::dvec3 du = (e1 * u2.y - e2 * u1.y) / det, dv = (e2 * u1.x - e1 * u2.x) / det;
        glm::dvec2 shift = uv0 - tri.uv[0];
        out[t] = {glm::vec3(p0 + du * shift.x + dv * shift.y),
                  glm::vec3(du),
                  glm::vec3(dv),
                  glm::vec2(uv0),
                  tri.chart,
                  glm::vec2(tri.uv[1]),
                  glm::vec2(tri.uv[2])};
    }
    return out;
}

// Rasterises all levels and settles down to which level each chart can be walked. image: the triangles on the finest
// level. Returns per level, per chart, whether it can.
std::vector<std::vector<uint8_t>> makeLevels(const BakeMesh& mesh, const std::vector<Link>& links,
                                             const Contacts& contacts, const std::vector<uint32_t>& allowed,
                                             IdImage image, const BakeOptions& options, Stages& stages,
                                             SurfaceData& surface, BakeReport& report) {
    std::vector<Plane> planes = makePlanes(mesh);
    std::vector<uint32_t> creases = creaseEdges(mesh), borders = borderEdges(mesh);
    LevelSource source{mesh, planes, surface.triangles, links, surface.crossings, creases, surface.charts};
    std::vector<std::vector<uint8_t>> walkable(options.levels);
    surface.levels.resize(options.levels);
    for (uint32_t l = 0; l < options.levels; ++l) {
        if (l == 0) stages.begin(0.4f, "level_0");
        if (l == 1) stages.begin(0.75f, "further_levels");
        walkable[l].assign(mesh.chartCount(), 1);
        for (size_t c = 0; l > 0 && c < walkable[l].size(); ++c) walkable[l][c] = walkable[l - 1][c] && allowed[c] >= l;
        if (l > 0) drawTriangles(mesh, options.resolution >> l, image, nullptr);
        drawGutters(mesh, borders, image, walkable[l]);
        surface.levels[l] = composeLevel(source, image, walkable[l]);
        uint64_t buried = contacts.bury(surface.crossings, planes, surface.levels[l]);
        uint64_t bare = takeBareTexels(mesh, surface.levels[l]);
        if (l == 0) report.buriedTexels = buried, report.bareTexels = bare;
        for (size_t c = 0; c < walkable[l].size(); ++c)
            if (walkable[l][c]) surface.charts[c].coarsestLevel = l;
    }
    return walkable;
}

void reportLevels(const std::string& name, const SurfaceData& surface,
                  const std::vector<std::vector<uint8_t>>& walkable, BakeReport& report) {
    double all = 0;
    for (const Chart& c : surface.charts) all += c.area;
    for (size_t l = 0; l < walkable.size(); ++l) {
        double area = 0;
        size_t lost = 0;
        for (size_t c = 0; c < walkable[l].size(); ++c) {
            if (walkable[l][c])
                area += surface.charts[c].area;
            else
                ++lost;
        }
        report.walkableByLevel.emplace_back(surface.levels[l].size, area / all);
        if (l == 0 && lost > 0) {
            char share[32];
            std::snprintf(share, sizeof share, "%.3g %%", (1 - area / all) * 100);
            report.warnings.push_back(
                {name,
                 0,
                 0,
                 {},
                 std::to_string(lost) + " charts (" + share +
                     " of the area) lack room around them even on the finest level: a walk is inexact there; "
                     "bake at " +
                     std::to_string(surface.levels[0].size * 2) + " or give them wider gutters",
                 true});
        }
    }
}

Diagnostic describe(const std::string& name, const Thread& thread, const BakeOptions& options) {
    char text[256];
    std::snprintf(text, sizeof text,
                  "%u thin piece%s of material '%.60s', %.2g texels wide at %u (%.3g m at %.4g %.4g %.4g): ",
                  thread.pieces, thread.pieces == 1 ? "" : "s", thread.material.c_str(), thread.texels,
                  options.resolution, thread.metres, double(thread.at.x), double(thread.at.y), double(thread.at.z));
    const std::string wish = thread.wants > 0 ? "bake at " + std::to_string(thread.wants) + " for plants to follow them"
                                              : "no resolution is fine enough for plants to follow them";
    return {name, 0, 0, {}, text + wish, true};
}

// Nobody sees a texel's gap from where all of the model is seen; closer by, a centimetre is one.
double nearestTolerance(const SurfaceData& surface, const BakeOptions& options) {
    if (options.nearestTolerance > 0) return options.nearestTolerance;
    const glm::vec3 size = surface.boundsMax - surface.boundsMin;
    const float side = std::max({size.x, size.y, size.z});
    const double seen = kSeenGap * double(lengthUnit(side, side));
    double area = 0, uv = 0;
    for (const Chart& c : surface.charts) {
        area += c.area;
        uv += double(c.area) / (double(c.metresPerUv) * c.metresPerUv);
    }
    return std::min(std::sqrt(area / uv) / options.resolution, seen);
}

}  // namespace

Status checkOptions(const std::string& name, BakeOptions& options) {
    if (!std::has_single_bit(options.resolution) || options.resolution < 64 || options.resolution > 8192)
        return Failure(name,
                       "resolution " + std::to_string(options.resolution) + " is not a power of two from 64 to 8192");
    uint32_t most = uint32_t(std::countr_zero(options.resolution)) - 2;  // down to 8 texels
    if (options.levels == 0) options.levels = std::max(1u, uint32_t(std::countr_zero(options.resolution)) - 5);
    options.levels = std::min(options.levels, kMaxLevels);
    if (!options.weights.empty() && options.keepLayout)
        return Failure(name, "weights move charts: they can't be had with a layout that is kept");
    if (options.levels > most)
        return Failure(name, std::to_string(options.levels) + " levels: a level of " +
                                 std::to_string(options.resolution) + " texels has at most " + std::to_string(most) +
                                 " (down to 8 texels)");
    return Done{};
}

Result<Baked> bake(const Model& asGiven, const BakeOptions& given) {
    BakeOptions options = given;
    Status valid = checkOptions(asGiven.name, options);
    if (!valid) return std::move(valid.failure());
    if (!options.weights.empty() && asGiven.uvs.empty())
        return Failure(asGiven.name, "has no UVs in which weights could be drawn");
    Baked out;
    BakeReport& report = out.report;
    SurfaceData& surface = out.surface;
    // A file's folder says where somebody works, not what was baked.
    report.source = surface.source = asGiven.name.substr(asGiven.name.find_last_of("/\\") + 1);
    report.warnings = asGiven.warnings;
    Stages stages(options, report);

    stages.begin(0.0f, "mesh");
    std::vector<Diagnostic> found;
    auto mesh = buildMesh(asGiven, found);
    if (!mesh) return std::move(mesh.failure());
    if (std::ranges::all_of(mesh->triangles, &Triangle::bare))
        return Failure(asGiven.name, "no ground is left: all of its materials are bare");
    std::optional<Model> turned = repairOrientation(asGiven, *mesh, report.warnings);
    const Model& model = turned ? *turned : asGiven;
    if (turned) {
        found.clear();
        mesh = buildMesh(model, found);
        if (!mesh) return std::move(mesh.failure());
    }
    report.warnings.insert(report.warnings.end(), found.begin(), found.end());
    stages.begin(0.05f, "atlas");
    Status cut = makeAtlas(model, *mesh, options.resolution, options.keepLayout, report);
    if (!cut) return std::move(cut.failure());
    stages.begin(0.1f, "layout");
    LayoutOptions layout{options.resolution, options.levels, options.keepLayout, {}};
    if (!options.weights.empty()) layout.density = chartDensities(model, *mesh, options.weights);
    IdImage finest;
    Result<std::vector<uint32_t>> allowed = std::vector<uint32_t>();
    beside([&] { addNormalsAndCurvature(model, *mesh); },
           [&] { allowed = layOut(*mesh, model.name, layout, finest, report); });
    if (!allowed) return std::move(allowed.failure());
    stages.begin(0.3f, "links");
    surface.boundsMin = glm::vec3(mesh->boundsMin);
    surface.boundsMax = glm::vec3(mesh->boundsMax);
    surface.origin = report.origin = model.origin;
    surface.charts = makeCharts(*mesh);
    surface.triangles = makeRecords(*mesh);
    double tolerance = report.touching = nearestTolerance(surface, options);
    std::vector<Link> links = findLinks(*mesh, tolerance);
    surface.crossings = makeCrossings(*mesh, links);
    stages.begin(0.35f, "contacts");
    std::vector<Sides> sides;  // of each crossing
    for (const Link& link : links) sides.push_back({link.from / 3, link.to == kNone ? kNone : link.to / 3});
    std::optional<Contacts> contacts(std::in_place, *mesh, links,
                                     Contacts::Options{options.contacts, tolerance, 1.0 / options.resolution});
    for (const Contact& contact : contacts->takeList()) {
        surface.crossings.push_back(contact.crossing);
        sides.push_back({contact.from, contact.to});
    }
    const std::vector<Link> bare = bareBorders(*mesh);
    for (const Crossing& crossing : makeCrossings(*mesh, bare)) surface.crossings.push_back(crossing);
    for (const Link& link : bare) sides.push_back({link.from / 3, kNone});

    MeshTree drawn;  // beside the levels, which know nothing of it
    std::vector<std::vector<uint8_t>> walkable;
    beside(
        [&] {
            makeDrawing(model, *mesh, surface);
            drawn = drawnTree(surface);
            simplifyDrawing(drawn, surface);
        },
        [&] {
            walkable =
                makeLevels(*mesh, links, *contacts, *allowed, std::move(finest), options, stages, surface, report);
        });
    contacts.reset();
    closeTowardsBare(*mesh, sides, surface.crossings);  // only now: it buries as it would
    for (const SurfaceLevelData& level : surface.levels)
        if (level.crossingRefs.size() >= (size_t(1) << 24))
            return Failure(model.name, "more borders than a level can list: bake at a lower resolution");
    stages.begin(0.92f, "report");
    beside(
        [&] {
            measureLevelErrors(drawn, surface);
            surface.hash = walkHash(surface);
            measureStretch(*mesh, surface, report);
        },
        [&] { measure(model, *mesh, sides, drawn, surface, report); });
    reportLevels(model.name, surface, walkable, report);
    report.threads = findThreads(model, *mesh, surface, options.resolution);
    for (const Thread& thread : report.threads) report.warnings.push_back(describe(model.name, thread, options));
    stages.end();
    if (options.progress) options.progress(1.0f, "done");
    return out;
}

}  // namespace espalier
