// bake/atlas-…: from triangles to charts that lie in the square, beside xatlas on the same welded mesh, with its
// default options, as WebAssembly in one thread. Whether a chart serves isn't asked of its charts; seconds, how many
// they are and how stretched is.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <memory>

#include "runtime/core/file.hpp"
#include "tools/bake/bake_mesh.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {

namespace {

using bakery::BakeMesh;
using bakery::Triangle;

// xatlas has thresholds that don't go with a mesh's size: the bunny at 25 cm gets eleven times the charts. At this
// radius it does best.
constexpr double kRadius = 10;

struct Atlas {
    double seconds = 0, cpu = 0;  // wall clock, and CPU time of all threads
    double charts = 0;
    double stretch95 = 0;  // as in BakeReport
};

// What the bake's stages up to `links` took: mesh, atlas, layout.
Result<Atlas> ourAtlas(const Model& model) {
    Atlas out;
    const std::clock_t started = std::clock();
    const auto begun = std::chrono::steady_clock::now();
    BakeOptions options;
    options.progress = [&](float, const char* stage) {
        if (std::strcmp(stage, "links") != 0) return;
        out.cpu = double(std::clock() - started) / CLOCKS_PER_SEC;
        out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    };
    Result<Baked> baked = bake(model, options);
    if (!baked) return std::move(baked.failure());
    out.charts = baked->report.charts;
    out.stretch95 = baked->report.stretch95;
    return out;
}

// The map of one triangle, in UVs of any scale: its longest and shortest image of a UV, in metres.
std::pair<double, double> singularValues(const BakeMesh& mesh, const Triangle& t, const float* uv) {
    const glm::dvec3 e1 = mesh.points[t.point[1]] - mesh.points[t.point[0]],
                     e2 = mesh.points[t.point[2]] - mesh.points[t.point[0]];
    const glm::dvec2 u1(uv[2] - uv[0], uv[3] - uv[1]), u2(uv[4] - uv[0], uv[5] - uv[1]);
    const double flat = bakery::cross(u1, u2);
    const glm::dvec3 du = (e1 * u2.y - e2 * u1.y) / flat, dv = (e2 * u1.x - e1 * u2.x) / flat;
    const double mean = (glm::dot(du, du) + glm::dot(dv, dv)) / 2,
                 half = std::hypot((glm::dot(du, du) - glm::dot(dv, dv)) / 2, glm::dot(du, dv));
    return {std::sqrt(mean + half), std::sqrt(std::max(mean - half, 0.0))};
}

// 95th percentile, by area, of how far triangles' maps are from their charts' mean scale. uv: six a triangle.
double stretch95(const BakeMesh& mesh, const std::vector<float>& uv, const std::vector<uint32_t>& chart) {
    std::vector<double> area, flat;
    for (size_t t = 0; t < chart.size(); ++t) {
        if (chart[t] == bakery::kNone) continue;
        if (chart[t] >= area.size()) area.resize(chart[t] + 1, 0), flat.resize(chart[t] + 1, 0);
        const float* c = &uv[t * 6];
        area[chart[t]] += area3(mesh, mesh.triangles[t]);
        flat[chart[t]] += std::abs(bakery::cross({c[2] - c[0], c[3] - c[1]}, {c[4] - c[0], c[5] - c[1]})) / 2;
    }
    std::vector<std::pair<double, double>> all;
    double total = 0;
    for (size_t t = 0; t < chart.size(); ++t) {
        if (chart[t] == bakery::kNone) continue;
        const double scale = std::sqrt(area[chart[t]] / flat[chart[t]]), own = area3(mesh, mesh.triangles[t]);
        const auto [most, least] = singularValues(mesh, mesh.triangles[t], &uv[t * 6]);
        const double worst = std::max(most / scale, scale / std::max(least, 1e-12));
        all.emplace_back(worst < 1e6 ? worst : 1e6, own);  // also what isn't a number: no area in UV
        total += own;
    }
    std::sort(all.begin(), all.end());
    double sum = 0;
    for (const auto& [worst, own] : all)
        if ((sum += own) >= 0.95 * total) return worst;
    return 0;
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
    const auto* at = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), at, at + sizeof value);
}

// Runs tools/bench/xatlas.mjs on a mesh. Failure: no node, or no such module.
Result<Atlas> xatlas(const Bench& bench, const BakeMesh& mesh) {
    const std::string modules = bench.options().modulesFolder;
    if (!std::filesystem::exists(modules + "/watlas"))
        return Failure("xatlas", "npm install --prefix " + std::filesystem::path(modules).parent_path().string() +
                                     " watlas@1.0.1");
    std::vector<std::byte> bytes;
    append(bytes, uint32_t(mesh.points.size()));
    append(bytes, uint32_t(mesh.triangles.size()));
    const glm::dvec3 middle = (mesh.boundsMin + mesh.boundsMax) / 2.0;
    for (const glm::dvec3& p : mesh.points) append(bytes, glm::vec3((p - middle) * (kRadius / mesh.radius)));
    for (const Triangle& t : mesh.triangles) append(bytes, t.point);
    const std::string base = neighbourOf(std::filesystem::temp_directory_path() / "espalier-xatlas");
    const std::string in = base + ".in", out = base + ".out";
    Status written = writeFile(in, bytes);
    if (!written) return std::move(written.failure());
    const std::string command = "node '" ESPALIER_XATLAS_SCRIPT "' '" + modules + "' '" + in + "' '" + out + "' 2>&1";
    std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
    Atlas atlas;
    const bool ran = pipe && std::fscanf(pipe.get(), "%lf %lf", &atlas.cpu, &atlas.charts) == 2;
    pipe.reset();
    std::filesystem::remove(in);
    auto result = readFile(out);
    std::filesystem::remove(out);
    const size_t count = mesh.triangles.size();
    if (!ran || !result || result->size() != count * 28) return Failure("xatlas", "failed: " + command);
    std::vector<float> uv(count * 6);
    std::vector<uint32_t> chart(count);
    std::memcpy(uv.data(), result->data(), count * 24);
    std::memcpy(chart.data(), result->data() + count * 24, count * 4);
    atlas.stretch95 = stretch95(mesh, uv, chart);
    return atlas;
}

void addRows(Bench& bench, const std::string& name, const Model& model) {
    std::vector<double> times, cpu;
    Atlas ours;
    for (int i = 0; i < bench.options().repeats; ++i) {
        Result<Atlas> atlas = ourAtlas(model);
        if (!atlas) return bench.skip(name, atlas.failure().text());
        ours = *atlas;
        times.push_back(ours.seconds), cpu.push_back(ours.cpu);
    }
    std::vector<Diagnostic> warnings;
    Result<BakeMesh> mesh = bakery::buildMesh(model, warnings);
    Result<Atlas> other = xatlas(bench, *mesh);
    const std::string figure = std::to_string(mesh->triangles.size()) + " triangles; ";
    const std::string who = other ? "xatlas, WebAssembly, one thread" : "xatlas isn't installed";
    if (!other) bench.skip(name + "/xatlas", other.failure().text());
    const Atlas theirs = other ? *other : Atlas{};
    bench.add({name, figure + "wall clock", "s", median(times), who, theirs.cpu});
    bench.add({name + "/cpu", "CPU time of both threads", "s", median(cpu), who, theirs.cpu});
    if (!other) return;
    bench.add({name + "/charts", "charts", "", ours.charts, "xatlas's", theirs.charts});
    bench.add({name + "/stretch", "95th percentile by area", "", ours.stretch95, "xatlas's", theirs.stretch95});
}

}  // namespace

void atlasCases(Bench& bench) {
    const std::pair<const char*, const char*> cases[] = {{"bake/atlas-bunny", "derived/bunny.glb"},
                                                         {"bake/atlas-armadillo", "derived/armadillo.glb"},
                                                         {"bake/atlas-dragon", "derived/dragon_res3.glb"},
                                                         {"bake/atlas-house", "models/quaternius/House2.glb"}};
    for (const auto& [name, file] : cases) {
        if (!bench.wants(name)) continue;
        const std::string path = bench.options().dataFolder + "/" + file;
        if (Result<Model> model = importModel(path))
            addRows(bench, name, *model);
        else
            bench.skip(name, "needs " + path);
    }
}

}  // namespace espalier
