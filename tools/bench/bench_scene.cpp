// Enters: a model's path. Leaves: everything that Growth::grow asks for, on the GPU and for the CPU reference.
#include "tools/bench/bench_scene.hpp"

#include <algorithm>
#include <cstdio>

#include "runtime/gpu/commands.hpp"
#include "shaders/shared/random.h"

namespace espalier {

std::string branchingGrammar(float step, uint32_t stemSteps, uint32_t twigSteps) {
    char text[1024];
    std::snprintf(text, sizeof text, R"(
param stride = %g [0 .. 10] "m" "Step"
param stemSteps = %u [0 .. 100000] "" "Steps of a stem"
param twigSteps = %u [0 .. 1000] "" "Steps of a twig"
Stem(n) -> Marching(stride, rand(-0.2, 0.2), n < stemSteps) {Fork(n + 1), Cover}
Fork(n) -> Branch(2) {Twig(0, rand(0, twigSteps)), Stem(n)}
Twig(n, k) -> Marching(stride, rand(-0.5, 0.5), n < k) {Twig(n + 1, k), Cover}
Cover -> Bark Leaves
Bark -> S(stride * 0.1) Shape("bark", C1)
Leaves -> Repeat(1) { T(rand(), 0) R(rand(-1, 1), 0.4) S(stride) Shape("leaf") }
)",
                  double(step), stemSteps, twigSteps);
    return text;
}

std::unique_ptr<BenchScene> BenchScene::create(Device& device, const std::string& path, uint32_t resolution) {
    auto complain = [&](const Failure& failure) { std::printf("%s\n", failure.text().c_str()); };
    Result<Model> model = importModel(path);
    if (!model) return complain(model.failure()), nullptr;
    BakeOptions options;
    options.resolution = resolution;
    Result<Baked> baked = bake(*model, options);
    if (!baked) return complain(baked.failure()), nullptr;

    auto scene = std::make_unique<BenchScene>();
    scene->device_ = &device;
    scene->surface_ = std::move(baked->surface);
    Result<GpuSurface> gpu = GpuSurface::create(device, scene->surface_);
    if (!gpu) return complain(gpu.failure()), nullptr;
    scene->gpuSurface_ = std::move(*gpu);
    Result<Buffer> table = makeBuffer(device, "bench surfaces", std::vector<SurfaceRef>{scene->gpuSurface_.ref()});
    std::vector<LayerRef> none(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    Result<Buffer> layers = makeBuffer(device, "bench layers", none);
    if (!table || !layers) return complain((table ? layers : table).failure()), nullptr;
    scene->table_ = std::move(*table);
    scene->layers_ = std::move(*layers);
    return scene;
}

bool BenchScene::setGrammar(const std::string& text) {
    Result<RuleMap> map = compileGrammar(text);
    if (!map) return std::printf("%s\n", map.failure().text().c_str()), false;
    grammar_ = std::move(*map);
    std::vector<uint32_t> words(grammar_.words().begin(), grammar_.words().end());
    Result<Buffer> buffer = makeBuffer(*device_, "bench rule map", words);
    if (!buffer) return std::printf("%s\n", buffer.failure().text().c_str()), false;
    words_ = std::move(*buffer);
    return true;
}

bool BenchScene::changeGrammar(const std::string& text, GrowthChanges& edits) {
    const RuleMap before = grammar_;
    if (!setGrammar(text)) return false;
    const RuleChanges what = grammar_.changesFrom(before);
    edits.everything = what.all;
    edits.markUses(0, what.uses);
    if (what.extrudes) edits.extrudes.push_back(0);
    return true;
}

bool BenchScene::paint(uint32_t layer, uint32_t size, const std::vector<float>& texels) {
    const bool fresh = painted_[layer].size() != texels.size() * 4;
    if (fresh) {
        Result<Buffer> made = Buffer::create(*device_, "bench layer", texels.size() * 4);
        if (!made) return false;
        painted_[layer] = std::move(*made);
        layerRefs_[layer] = {{reinterpret_cast<float*>(painted_[layer].address())}, size, 1};
    }
    Result<Commands> commands = Commands::begin(*device_, "paint");
    if (!commands || !commands->upload(painted_[layer], texels)) return false;
    if (fresh && !commands->upload(layers_, layerRefs_)) return false;
    return bool(commands->finish());
}

void BenchScene::plant(uint32_t count) {
    const SurfaceLevelData& level = surface_.levels[0];
    std::vector<glm::uvec2> inner;
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x)
            if (texelClass(level.texels[texelIndex(level.size, x, y)].bits) == kTexelInner) inner.push_back({x, y});
    seeds_.clear();
    for (uint32_t i = 0; i < count && !inner.empty(); ++i) {
        Seed seed{};
        seed.key = mix64(i + 1);
        glm::uvec2 at = inner[size_t(double(uniformRandom(seed.key, 1)) * double(inner.size()))];
        seed.walk.uv = (glm::vec2(at) + 0.5f) / float(level.size);
        seed.walk.place = texelChart(level.texels[texelIndex(level.size, at.x, at.y)].bits);
        for (uint32_t k = 0; k < 3; ++k) seed.walk.direction[int(k)] = uniformRandom(seed.key, 2 + k) - 0.5f;
        seed.symbol = grammar_.startSymbol();
        seeds_.push_back(seed);
    }
}

Status BenchScene::grow(Growth& growth) {
    RuleMapRef map = grammar_.refAt(words_.address());
    GrowthInputs in;
    in.surfaces = surfaces();
    in.surfaceCount = 1;
    in.native = native;
    in.layers = {reinterpret_cast<LayerRef*>(layers_.address())};
    in.grammars = {&map, 1};
    in.seeds = seeds_;
    in.limits = limits;
    if (avoid > 0) in.avoid = {&avoid, 1};
    in.changes = changes;
    return growth.grow(in);
}

Result<CpuGrowth> BenchScene::growOnCpu(const GrowthStats& stats) const {
    SurfaceRef surface = surfaceRef(surface_);
    std::vector<LayerRef> none(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    RuleMapRef map = grammar_.ref();
    GrowthInputs in;
    in.surfaces = {&surface};
    in.surfaceCount = 1;
    in.layers = {none.data()};
    in.grammars = {&map, 1};
    in.seeds = seeds_;
    in.limits = limits;
    if (avoid > 0) in.avoid = {&avoid, 1};
    return espalier::growOnCpu(in, {stats.chunks, stats.nodes, stats.branches, stats.leaves, stats.chunks});
}

float BenchScene::texelMetres() const {
    std::vector<float> scales;
    for (const Chart& chart : surface_.charts) scales.push_back(chart.metresPerUv);
    if (scales.empty()) return 0;
    auto middle = scales.begin() + long(scales.size() / 2);
    std::nth_element(scales.begin(), middle, scales.end());
    return *middle / float(surface_.levels[0].size);
}

}  // namespace espalier
