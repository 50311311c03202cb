#include "tests/pattern/scene.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "runtime/field/field_texels.hpp"
#include "shaders/shared/random.h"

namespace espalier::patterntest {
namespace {

struct Triangles {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
};

Triangles box() {
    Triangles t;
    for (int i = 0; i < 8; ++i) t.positions.push_back({(i & 1) - .5f, (i >> 1) & 1, (i >> 2 & 1) - .5f});
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, base = uint32_t(side) << axis;
            const uint32_t q[4] = {base, base + u, base + u + v, base + v};
            for (int k : {0, 1, 2, 0, 2, 3}) t.indices.push_back(q[side ? k : 3 - k]);
        }
    return t;
}

Triangles ring(uint32_t nu = 16, uint32_t nv = 8) {
    Triangles t;
    const float large = .4f, small = .1f;
    for (uint32_t i = 0; i < nu; ++i)
        for (uint32_t j = 0; j < nv; ++j) {
            const float a = 2 * std::numbers::pi_v<float> * float(i) / float(nu);
            const float b = 2 * std::numbers::pi_v<float> * float(j) / float(nv);
            const float r = large + small * std::cos(b);
            t.positions.push_back({r * std::cos(a), small * std::sin(b), r * std::sin(a)});
            const uint32_t i1 = (i + 1) % nu, j1 = (j + 1) % nv;
            for (uint32_t k : {i * nv + j, i * nv + j1, i1 * nv + j, i1 * nv + j, i * nv + j1, i1 * nv + j1})
                t.indices.push_back(k);
        }
    return t;
}

}  // namespace

Model square(float side) {
    Model model;
    model.name = "square";
    const float h = side / 2;
    model.positions = {{-h, 0, -h}, {h, 0, -h}, {h, 0, h}, {-h, 0, h}};
    model.normals.assign(4, {0, 1, 0});
    model.uvs = {{0.05f, 0.05f}, {0.95f, 0.05f}, {0.95f, 0.95f}, {0.05f, 0.95f}};
    model.indices = {0, 2, 1, 0, 3, 2};
    return model;
}

Model sheet(uint32_t nu, uint32_t nv, const std::function<glm::vec3(float, float)>& place,
            const std::function<glm::vec3(float, float)>& normal) {
    Model model;
    model.name = "sheet";
    for (uint32_t i = 0; i <= nu; ++i)
        for (uint32_t j = 0; j <= nv; ++j) {
            const float u = float(i) / float(nu), v = float(j) / float(nv);
            model.positions.push_back(place(u, v));
            model.normals.push_back(normal(u, v));
            model.uvs.push_back({.03f + .94f * u, .03f + .94f * v});
        }
    for (uint32_t i = 0; i < nu; ++i)
        for (uint32_t j = 0; j < nv; ++j) {
            const uint32_t a = i * (nv + 1) + j, c = a + nv + 1;
            for (uint32_t k : {a, c, c + 1, a, c + 1, a + 1}) model.indices.push_back(k);
        }
    return model;
}

Model torus(float large, float small, uint32_t nu, uint32_t nv) {
    const auto outside = [](float u, float v) {
        const float a = 2 * std::numbers::pi_v<float> * (u == 1 ? 0 : u);
        const float b = 2 * std::numbers::pi_v<float> * (v == 1 ? 0 : v);
        return glm::vec3(std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b));
    };
    return sheet(
        nu, nv,
        [&](float u, float v) {
            const float a = 2 * std::numbers::pi_v<float> * (u == 1 ? 0 : u);
            return glm::vec3(large * std::cos(a), 0, -large * std::sin(a)) + small * outside(u, v);
        },
        outside);
}

Scene::Scene(const Model& model, uint32_t resolution) {
    BakeOptions options;
    options.resolution = resolution;
    Result<Baked> baked = bake(model, options);
    if (!baked) FAIL(baked.failure().text());
    surface_ = std::move(baked->surface);
    mesh_ = makeFieldMesh(surface_);
    for (const Triangles& t : {box(), ring()}) meshes_.add(t.positions, t.indices);
}

uint32_t Scene::addGrammar(const std::string& text) {
    CompileOptions options;
    options.pieces = {{"box", false}, {"ring", false}};
    Result<RuleMap> map = compileGrammar(text, options);
    if (!map) FAIL(map.failure().text());
    grammars_.push_back(std::move(*map));
    fields_.emplace_back(kMaxFields);
    symmetry_.emplace_back(kMaxFields, 0);
    return uint32_t(grammars_.size()) - 1;
}

void Scene::setField(const std::string& name, const Field& field) {
    const auto& known = grammars_.back().fields();
    for (uint32_t i = 0; i < known.size(); ++i) {
        if (known[i].name != name) continue;
        fields_.back()[i] = FieldSampling(surface_, mesh_).texels(field);
        symmetry_.back()[i] = field.symmetry;
    }
}

std::pair<Walk, glm::vec3> Scene::texelNear(glm::vec3 at) const {
    const SurfaceLevelData& level = surface_.levels[0];
    float best = 1e30f;
    std::pair<Walk, glm::vec3> found{};
    for (uint32_t y = 0; y < level.size; ++y)
        for (uint32_t x = 0; x < level.size; ++x) {
            const Texel& t = level.texels[texelIndex(level.size, x, y)];
            const float d = glm::length(t.position - at);
            if (texelClass(t.bits) != kTexelInner || d >= best) continue;
            best = d;
            found.first.place = texelChart(t.bits);
            found.first.uv = (glm::vec2(x, y) + 0.5f) / float(level.size);
            found.second = t.position;
        }
    return found;
}

void Scene::plant(glm::vec3 at, glm::vec3 direction, uint32_t grammar, uint64_t number) {
    Seed seed{};
    seed.walk = texelNear(at).first;
    seed.walk.direction = glm::normalize(direction);
    seed.key = mix64(number);
    seed.grammar = grammar;
    seed.symbol = grammars_[grammar].startSymbol();
    seeds_.push_back(seed);
}

Result<GrownPattern> Scene::tryGrow(const PatternLimits& limits, unsigned threads) const {
    const SurfaceRef ref = surfaceRef(surface_);
    std::vector<LayerRef> layers(kMaxLayers);
    std::vector<RuleMapRef> maps;
    std::vector<FieldRef> fields;
    for (size_t g = 0; g < grammars_.size(); ++g) {
        maps.push_back(grammars_[g].ref());
        for (uint32_t f = 0; f < kMaxFields; ++f) {
            const std::vector<FieldTexel>& texels = fields_[g][f];
            fields.push_back({{const_cast<FieldTexel*>(texels.data())},
                              surface_.levels[0].size,
                              texels.empty() ? 0 : symmetry_[g][f]});
        }
    }
    PatternInputs inputs;
    inputs.surfaces.v = const_cast<SurfaceRef*>(&ref);
    inputs.surfaceCount = 1;
    inputs.layers.v = layers.data();
    inputs.grammars = maps;
    inputs.fields.v = fields.data();
    inputs.seeds = seeds_;
    inputs.meshes = &meshes_;
    inputs.limits = limits;
    return growPatternsOnCpu(inputs, threads);
}

GrownPattern Scene::grow(unsigned threads) const {
    Result<GrownPattern> grown = tryGrow({}, threads);
    if (!grown) FAIL(grown.failure().text());
    return std::move(*grown);
}

}  // namespace espalier::patterntest
