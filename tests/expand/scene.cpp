#include "tests/expand/scene.hpp"

#include <doctest/doctest.h>

#include <cstdio>

#include "shaders/shared/exact.h"
#include "shaders/shared/random.h"

namespace espalier::growthtest {

Model flatSquare() {
    Model model;
    model.name = "square";
    model.positions = {{-1, 0, -1}, {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}};
    model.normals.assign(4, {0, 1, 0});
    model.uvs = {{0.1f, 0.1f}, {0.9f, 0.1f}, {0.9f, 0.9f}, {0.1f, 0.9f}};
    model.indices = {0, 2, 1, 0, 3, 2};
    return model;
}

Scene::Scene(SurfaceData surface) : surface_(std::move(surface)) {}

Scene Scene::baked(const Model& model, uint32_t resolution) {
    BakeOptions options;
    options.resolution = resolution;
    Result<Baked> made = bake(model, options);
    if (!made) FAIL(made.failure().text());
    return Scene(std::move(made->surface));
}

uint32_t Scene::addGrammar(const std::string& text) {
    Result<RuleMap> map = compileGrammar(text);
    if (!map) FAIL(map.failure().text());
    grammars_.push_back(std::move(*map));
    return uint32_t(grammars_.size()) - 1;
}

void Scene::paint(uint32_t layer, uint32_t size, const std::function<float(glm::vec2)>& value) {
    Layer made{layer, size, std::vector<float>(size_t(size) * size)};
    for (uint32_t y = 0; y < size; ++y)
        for (uint32_t x = 0; x < size; ++x)
            made.texels[texelIndex(size, x, y)] = value((glm::vec2(x, y) + 0.5f) / float(size));
    std::erase_if(layers_, [&](const Layer& l) { return l.index == layer; });
    layers_.push_back(std::move(made));
}

void Scene::plant(glm::vec3 at, glm::vec3 direction, uint32_t grammar, uint64_t number) {
    const SurfaceLevelData& level = surface_.levels[0];
    float best = 1e30f;
    Seed seed{};
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            const Texel& t = level.texels[texelIndex(level.size, x, y)];
            float d = glm::length(t.position - at);
            if (texelClass(t.bits) != kTexelInner || d >= best) continue;
            best = d;
            seed.walk.place = texelChart(t.bits);
            seed.walk.uv = (glm::vec2(x, y) + 0.5f) / float(level.size);
        }
    seed.key = mix64(number * 7919 + seeds_.size() + 1);
    seed.walk.direction = direction;
    seed.grammar = grammar;
    seed.symbol = grammars_.at(grammar).startSymbol();
    seeds_.push_back(seed);
}

void Scene::plantMany(uint32_t count, uint32_t grammar, uint64_t number) {
    const SurfaceLevelData& level = surface_.levels[0];
    std::vector<uint32_t> inner;
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x)
            if (texelClass(level.texels[texelIndex(level.size, x, y)].bits) == kTexelInner)
                inner.push_back(y * level.size + x);
    REQUIRE(!inner.empty());
    for (uint32_t i = 0; i < count; ++i) {
        uint64_t key = mix64(number * 104729 + i + 1);
        uint32_t at = inner[size_t(uniformRandom(key, 1) * double(inner.size()))];
        Seed seed{};
        seed.key = key;
        seed.walk.uv = (glm::vec2(at % level.size, at / level.size) + 0.5f) / float(level.size);
        seed.walk.place = texelChart(level.texels[texelIndex(level.size, at % level.size, at / level.size)].bits);
        seed.walk.direction = {uniformRandom(key, 2) - 0.5f, uniformRandom(key, 3) - 0.5f,
                               uniformRandom(key, 4) - 0.5f};
        seed.grammar = grammar;
        seed.symbol = grammars_.at(grammar).startSymbol();
        seeds_.push_back(seed);
    }
}

Result<CpuGrowth> Scene::growOnCpu(const March& march) {
    SurfaceRef surface = surfaceRef(surface_);
    std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    for (Layer& l : layers_) layers[l.index] = {{l.texels.data()}, l.size, 1};
    std::vector<RuleMapRef> refs;
    for (const RuleMap& map : grammars_) refs.push_back(map.ref());
    GrowthInputs in;
    in.surfaces = {&surface};
    in.surfaceCount = 1;
    in.layers = {layers.data()};
    in.grammars = refs;
    in.widths = widths;
    in.avoid = avoid;
    in.seeds = seeds_;
    in.pruned = pruned;
    in.limits = limits;
    return espalier::growOnCpu(in, {}, march);
}

Status Scene::grow(Device& device, Growth& growth) {
    if (!gpuSurface_) {
        Result<GpuSurface> made = GpuSurface::create(device, surface_);
        if (!made) return made.failure();
        gpuSurface_ = std::move(*made);
    }
    buffers_.clear();
    auto upload = [&](auto const& values, const char* name) -> uint64_t {
        Result<Buffer> made = makeBuffer(device, name, values);
        if (!made) FAIL(made.failure().text());
        buffers_.push_back(std::move(*made));
        return buffers_.back().address();
    };
    std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    for (Layer& l : layers_) layers[l.index] = {{reinterpret_cast<float*>(upload(l.texels, "layer"))}, l.size, 1};
    std::vector<RuleMapRef> refs;
    uploaded_.resize(grammars_.size());
    for (size_t i = 0; i < grammars_.size(); ++i) {
        std::vector<uint32_t> words(grammars_[i].words().begin(), grammars_[i].words().end());
        if (uploaded_[i].words != words) {
            upload(words, "rule map");
            uploaded_[i] = {std::move(words), std::move(buffers_.back())};
        }
        refs.push_back(grammars_[i].refAt(uploaded_[i].buffer.address()));
    }
    GrowthInputs in;
    in.surfaces = {reinterpret_cast<SurfaceRef*>(upload(std::vector<SurfaceRef>{gpuSurface_.ref()}, "surfaces"))};
    in.surfaceCount = 1;
    in.native = native;
    in.layers = {reinterpret_cast<LayerRef*>(upload(layers, "layers"))};
    in.grammars = refs;
    in.widths = widths;
    in.avoid = avoid;
    in.seeds = seeds_;
    in.pruned = pruned;
    in.limits = limits;
    in.frozen = frozen;
    in.changes = changes;
    in.watch = watch;
    return growth.grow(in);
}

TestDevice::TestDevice(bool validation) {
    DeviceOptions options;
    options.applicationName = "test_expand";
    options.validation = validation;
    Result<std::unique_ptr<Device>> made = Device::create(options);
    if (!made) FAIL(made.failure().text());
    owner = std::move(*made);
}
TestDevice::~TestDevice() {
    if (!owner) return;
    CHECK(owner->waitIdle());
    CHECK(owner->validationMessages() == 0);
    for (const std::string& text : owner->validationTexts()) std::printf("%s\n", text.c_str());
}
std::unique_ptr<Growth> TestDevice::growth(const GrowthRoom& room) {
    Result<std::unique_ptr<Growth>> made = Growth::create(device(), room);
    if (!made) FAIL(made.failure().text());
    return std::move(*made);
}

}  // namespace espalier::growthtest
