// pattern/…: shipped grammars on a real model, derived by all threads as native code, with one thread beside it; how
// many meshes are tried for one that stands.
#include <cstdio>
#include <numbers>

#include "runtime/field/field_texels.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/pattern/pattern_data.hpp"
#include "shaders/shared/random.h"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

constexpr uint32_t kResolution = 512;

// The meshes that grammars ask for, in the order of their numbers, and how wide the ball is that stands for each:
// scales and links overlap by design.
struct Stand {
    const char* name;
    float width;
};
constexpr Stand kStands[] = {{"scale", .3f}, {"cobble", 1}, {"link", .3f},    {"tile", .9f}, {"rod", .5f},
                             {"leaf", .5f},  {"stud", .2f}, {"blossom", .5f}, {"tube", 1},   {"band", 1}};

// A ball that stands on its origin.
void addBall(PieceMeshes& meshes, float width) {
    constexpr uint32_t kAround = 10, kUp = 6;
    std::vector<glm::vec3> points;
    for (uint32_t j = 0; j <= kUp; ++j)
        for (uint32_t i = 0; i < kAround; ++i) {
            const float a = 2 * std::numbers::pi_v<float> * float(i) / kAround;
            const float b = std::numbers::pi_v<float> * float(j) / kUp;
            points.push_back(glm::vec3(std::sin(b) * std::cos(a), 1 - std::cos(b), std::sin(b) * std::sin(a)) *
                             (width / 2));
        }
    std::vector<uint32_t> indices;
    for (uint32_t j = 0; j < kUp; ++j)
        for (uint32_t i = 0; i < kAround; ++i) {
            const uint32_t a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
            if (j > 0) indices.insert(indices.end(), {a, a + kAround, b});
            if (j + 1 < kUp) indices.insert(indices.end(), {b, a + kAround, b + kAround});
        }
    meshes.add(points, indices);
}

struct PatternBench {
    SurfaceData surface;
    FieldMesh mesh;
    PieceMeshes meshes;
    RuleMap rules;
    std::vector<std::vector<FieldTexel>> texels;
    PatternInputs inputs;

    // What `inputs` points at.
    SurfaceRef surfaceRefs[1];
    std::vector<LayerRef> layers = std::vector<LayerRef>(kMaxLayers);
    std::vector<RuleMapRef> maps;
    std::vector<FieldRef> fields;
    std::vector<Seed> seeds;

    Status begin(const std::string& model) {
        Result<Model> imported = importModel(model);
        if (!imported) return imported.failure();
        BakeOptions options;
        options.resolution = kResolution;
        Result<Baked> baked = bake(*imported, options);
        if (!baked) return baked.failure();
        surface = std::move(baked->surface);
        mesh = makeFieldMesh(surface);
        for (const Stand& stand : kStands) addBall(meshes, stand.width);
        surfaceRefs[0] = surfaceRef(surface);
        return Done{};
    }

    // One seed in the middle of the texels; lengths that suit a model of this size.
    Status take(std::string text) {
        const std::string scale = "param scale = 1 ";
        if (const size_t at = text.find(scale); at != std::string::npos)
            text.replace(at, scale.size(), "param scale = " + std::to_string(mesh.radius) + " ");
        CompileOptions options;
        for (const Stand& stand : kStands) options.pieces.push_back({stand.name, false});
        Result<RuleMap> map = compileGrammar(text, options);
        if (!map) return map.failure();
        rules = std::move(*map);
        texels.clear();
        fields.clear();
        for (uint32_t f = 0; f < kMaxFields; ++f) {
            fields.push_back({{nullptr}, surface.levels[0].size, 0});
            if (f >= rules.fields().size()) continue;
            FieldDesign design;
            design.symmetry = rules.fields()[f].symmetry;
            Result<Field> field = designField(mesh, design);
            if (!field) return field.failure();
            texels.push_back(FieldSampling(surface, mesh).texels(*field));
            fields.back() = {{texels.back().data()}, surface.levels[0].size, design.symmetry};
        }
        maps = {rules.ref()};
        seeds = {seedInTheMiddle()};
        inputs.surfaces.v = surfaceRefs;
        inputs.surfaceCount = 1;
        inputs.layers.v = layers.data();
        inputs.grammars = maps;
        inputs.fields.v = fields.data();
        inputs.seeds = seeds;
        inputs.meshes = &meshes;
        return Done{};
    }

    Seed seedInTheMiddle() const {
        const SurfaceLevelData& level = surface.levels[0];
        std::vector<uint32_t> inner;
        for (uint32_t i = 0; i < level.size * level.size; ++i)
            if (texelClass(level.texels[texelIndex(level.size, i % level.size, i / level.size)].bits) == kTexelInner)
                inner.push_back(i);
        const uint32_t at = inner[inner.size() / 2];
        Seed seed{};
        seed.walk.uv = (glm::vec2(at % level.size, at / level.size) + .5f) / float(level.size);
        seed.walk.place = texelChart(level.texels[texelIndex(level.size, at % level.size, at / level.size)].bits);
        seed.walk.direction = {0, 1, 0};
        seed.key = mix64(1);
        seed.symbol = rules.startSymbol();
        return seed;
    }
};

}  // namespace

void patternCases(Bench& bench) {
    const std::string group = "pattern/";
    std::vector<const char*> wanted;
    for (const char* name : {"scales", "mail", "tiles", "cobbles", "veins", "crackle"})
        if (bench.wants(group + name)) wanted.push_back(name);
    if (wanted.empty()) return;
    PatternBench pattern;
    const std::string model = bench.options().dataFolder + "/derived/bunny_unwrap.glb";
    if (Status begun = pattern.begin(model); !begun) return bench.skip(group, "needs " + model);
    for (const char* name : wanted) {
        const std::string row = group + name;
        const std::string file = bench.options().contentFolder + "/grammars/pattern_" + name + ".grammar";
        if (Status taken = pattern.take(textOf(file)); !taken) {
            bench.skip(row, taken.failure().text());
            continue;
        }
        PatternStats stats;
        const auto derive = [&](unsigned threads) {
            Result<GrownPattern> grown = growPatternsOnCpu(pattern.inputs, threads);
            if (grown) stats = grown->stats;
        };
        const Pair times = medianSeconds(
            bench.options().repeats, [&] { derive(0); }, [&] { derive(1); });
        bench.add({row, "the pattern anew, wall clock", "ms", 1e3 * times.a, "one thread", 1e3 * times.b});
        bench.add({row + "/tried", "meshes tried", "meshes", double(stats.tried), "that stand", double(stats.pieces)});
    }
}

}  // namespace espalier
