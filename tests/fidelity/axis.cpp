// In: a baked model and a grammar. Out: how far the bark's curves (Buron 2015 §6) run from the model's triangles, and
// how they break at joints. The curves are those that drawing makes of the growth (span_load.h), before the bark is
// lifted off them by kBarkRise of its radius; the distances come from an oracle of their own.
#include "tests/fidelity/axis.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "runtime/expand/cpu_growth.hpp"
#include "runtime/grammar/grammar.hpp"
#include "shaders/emit/span_load.h"
#include "shaders/shared/random.h"

namespace espalier::fidelitytest {
namespace {

constexpr int kSamples = 16;
constexpr float kUsualSide = 6;  // metres: the model for which the grammars' own lengths are meant

// `count` seeds on inner texels all over the surface, their headings drawn.
std::vector<Seed> scatter(const SurfaceData& surface, uint32_t count, uint32_t symbol) {
    const SurfaceLevelData& level = surface.levels[0];
    std::vector<uint32_t> inner;
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x)
            if (texelClass(level.texels[texelIndex(level.size, x, y)].bits) == kTexelInner)
                inner.push_back(y * level.size + x);
    REQUIRE(!inner.empty());
    std::vector<Seed> seeds;
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t key = mix64(i + 1);
        const uint32_t at = inner[size_t(uniformRandom(key, 1) * double(inner.size()))];
        const uint32_t x = at % level.size, y = at / level.size;
        Seed seed{};
        seed.key = key;
        seed.walk.uv = (glm::vec2(x, y) + .5f) / float(level.size);
        seed.walk.place = texelChart(level.texels[texelIndex(level.size, x, y)].bits);
        seed.walk.direction = {uniformRandom(key, 2) - .5f, uniformRandom(key, 3) - .5f, uniformRandom(key, 4) - .5f};
        seed.symbol = symbol;
        seeds.push_back(seed);
    }
    return seeds;
}

double angleBetween(vec3 a, vec3 b) {
    const glm::dvec3 x(a), y(b);
    return std::atan2(glm::length(glm::cross(x, y)), glm::dot(x, y)) * 180 / 3.14159265358979;
}

double quantile(const std::vector<double>& sorted, double q) {
    return sorted.empty() ? 0 : sorted[std::min(sorted.size() - 1, size_t(q * double(sorted.size())))];
}

// What is gathered over all spans.
struct Gathered {
    std::vector<double> distances;  // |d| in radii
    std::vector<double> breaks;
    std::vector<double> outTexels;  // radii of samples that are out, in texels
    size_t withinTexel = 0;
    uint32_t spans = 0, nodesOut = 0;
    size_t floating = 0, sinking = 0;
    size_t nodeOut = 0, handles = 0, corners = 0, between = 0;
};

void gatherSpan(const GrowthRecords& g, const SurfaceRef& surface, const SignedDistance& mesh, uint32_t index,
                Gathered& out) {
    NodeBuf nodes{const_cast<Node*>(g.nodes.data())};
    ChunkBuf chunks{const_cast<Chunk*>(g.chunks.data())};
    SurfaceBuf surfaces{const_cast<SurfaceRef*>(&surface)};
    const Node& node = g.nodes[index];
    if (!(node.flags & kNodeBark)) return;
    LoadedSpan s = loadSpan(nodes, chunks, surfaces, index);
    if (!s.valid) return;
    const uint32_t before = previousNode(chunks, node, index);
    const LoadedSpan previous = loadSpan(nodes, chunks, surfaces, before);
    if (previous.valid && (g.nodes[before].flags & kNodeBark))
        out.breaks.push_back(angleBetween(spanVelocity(previous.span, 1), spanVelocity(s.span, 0)));
    // The first span of a plant begins below the ground on purpose; judged is the part from its node on.
    s.span.p0 = g.nodes[before].position * surface.scale;

    const double scale = surface.scale;
    const double texel = surface.charts.v[node.place & 0xFFFFu].metresPerUv / double(surface.levels[0].size) * scale;
    auto radii = [&](const Span& curve, float u) {
        const double radius = s.radius0 + (s.radius1 - s.radius0) * u;
        return mesh.at(glm::dvec3(spanPoint(curve, u)) / scale) * scale / radius;
    };
    const bool startOut = std::abs(radii(s.span, 0)) > 1, endOut = std::abs(radii(s.span, 1)) > 1;
    size_t outside = 0;
    out.spans += 1;
    out.nodesOut += endOut;
    for (int k = 0; k < kSamples; ++k) {
        const double d = radii(s.span, (float(k) + .5f) / kSamples);
        out.distances.push_back(std::abs(d));
        out.floating += d > 1;
        out.sinking += d < -1;
        const double inTexels = (s.radius0 + (s.radius1 - s.radius0) * (k + .5) / kSamples) / texel;
        out.withinTexel += std::abs(d) <= 1 || std::abs(d) * inTexels <= 1;
        if (std::abs(d) <= 1) continue;
        out.outTexels.push_back(inTexels);
        outside += 1;
    }
    if (outside == 0) return;
    const Span chord = straightSpan(s.span.p0, s.span.p3);
    bool chordOut = false;
    for (int k = 0; k < kSamples; ++k) chordOut = chordOut || std::abs(radii(chord, (float(k) + .5f) / kSamples)) > 1;
    const bool turns = angleBetween(s.normal0, s.normal1) > 20;
    (startOut || endOut ? out.nodeOut : !chordOut ? out.handles : turns ? out.corners : out.between) += outside;
}

AxisFigures figures(Gathered& all) {
    std::sort(all.distances.begin(), all.distances.end());
    std::sort(all.outTexels.begin(), all.outTexels.end());
    std::sort(all.breaks.begin(), all.breaks.end());
    const double samples = double(std::max<size_t>(all.distances.size(), 1));
    const double out = double(all.floating + all.sinking), any = std::max(out, 1.0);
    AxisFigures f;
    f.spans = all.spans;
    f.nodesWithin = 1 - double(all.nodesOut) / std::max(all.spans, 1u);
    f.within = 1 - out / samples;
    f.withinTexel = double(all.withinTexel) / samples;
    f.outTexels = quantile(all.outTexels, .5);
    f.floating = double(all.floating) / samples;
    f.sinking = double(all.sinking) / samples;
    f.median = quantile(all.distances, .5);
    f.p99 = quantile(all.distances, .99);
    f.p999 = quantile(all.distances, .999);
    f.worst = quantile(all.distances, 1);
    f.break999 = quantile(all.breaks, .999);
    f.worstBreak = quantile(all.breaks, 1);
    f.outNodes = double(all.nodeOut) / any;
    f.outHandles = double(all.handles) / any;
    f.outCorners = double(all.corners) / any;
    f.outBetween = double(all.between) / any;
    return f;
}

}  // namespace

AxisFigures measureAxis(const Baked& baked, const SignedDistance& mesh, const AxisCase& c) {
    Result<RuleMap> map = compileGrammarFile(std::filesystem::path("content/grammars") / c.grammar);
    if (!map) FAIL(map.failure().text());
    const glm::vec3 size = baked.surface.boundsMax - baked.surface.boundsMin;
    const float side = std::max({size.x, size.y, size.z});
    // Lengths are made to suit the model as opening it does, or, where the grammar has no parameter for that, the
    // model is placed at the size for which they are meant.
    float place = kUsualSide / side;
    if (std::optional<uint32_t> param = map->findParam("scale")) {
        const float scale = side / kUsualSide;
        const ParamInfo& info = map->params()[*param];
        if (scale >= info.minimum && scale <= info.maximum) {
            map->setParam(*param, {&scale, 1});
            place = 1;
        }
    }
    const SurfaceRef surface = surfaceRef(baked.surface, place);
    std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    const RuleMapRef ref = map->ref();
    const std::vector<Seed> seeds = scatter(baked.surface, c.seeds, map->startSymbol());
    GrowthInputs in;
    in.surfaces = {const_cast<SurfaceRef*>(&surface)};
    in.surfaceCount = 1;
    in.layers = {layers.data()};
    in.grammars = {&ref, 1};
    in.seeds = seeds;
    in.limits.maxNodes = c.maxNodes;
    Result<CpuGrowth> growth = growOnCpu(in);
    if (!growth) FAIL(growth.failure().text());
    Gathered all;
    for (uint32_t i = 0; i < growth->nodes.size(); ++i) gatherSpan(*growth, surface, mesh, i, all);
    return figures(all);
}

void printHeading() {
    std::printf(
        "bark's curve to the mesh, 16 samples a span, distances in radii, before the bark's rise\n"
        "%-11s %-9s %6s %8s %8s %8s %8s %8s %6s %6s %6s %6s | %-39s | %s\n",
        "model", "grammar", "spans", "nodes in", "within", "floating", "sinking", "or texel", "p50", "p99", "p99.9",
        "worst", "out: nodes handles corners else r/texel", "break p99.9 worst");
}

void print(const std::string& name, const AxisCase& c, const AxisFigures& f) {
    std::printf("%-11s %-9s %6u %7.3f%% %7.3f%% %7.3f%% %7.3f%% %7.3f%% %6.3f %6.3f %6.3f %6.2f | ", name.c_str(),
                c.grammar.substr(0, c.grammar.find('.')).c_str(), f.spans, 100 * f.nodesWithin, 100 * f.within,
                100 * f.floating, 100 * f.sinking, 100 * f.withinTexel, f.median, f.p99, f.p999, f.worst);
    std::printf("%9.0f%% %6.0f%% %6.0f%% %3.0f%% %7.2f | %11.3f %.3f\n", 100 * f.outNodes, 100 * f.outHandles,
                100 * f.outCorners, 100 * f.outBetween, f.outTexels, f.break999, f.worstBreak);
    std::fflush(stdout);
}

}  // namespace espalier::fidelitytest
