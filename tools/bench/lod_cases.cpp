// render/lod-…: a frame with a scan of 200,000 triangles at growing distance, each level of detail within a pixel,
// beside the mesh itself at the same place.
#include <cstdio>
#include <random>

#include "runtime/render/renderer.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

// Each triangle in three, the new corner off its plane by a scanner's noise: as many triangles, none of them idle.
void refine(Model& model) {
    std::mt19937 random(1);
    std::normal_distribution<float> noise(0, 0.03f);
    std::vector<uint32_t> indices;
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        const uint32_t a = model.indices[i], b = model.indices[i + 1], c = model.indices[i + 2];
        const uint32_t middle = uint32_t(model.positions.size());
        const glm::vec3 p = model.positions[a], ab = model.positions[b] - p, ac = model.positions[c] - p;
        const glm::vec3 across = glm::cross(ab, ac);
        const float area = glm::length(across);
        const glm::vec3 off = area > 0 ? across / std::sqrt(area) * noise(random) : glm::vec3(0);
        model.positions.push_back(p + (ab + ac) / 3.0f + off);
        for (uint32_t v : {a, b, middle, b, c, middle, c, a, middle}) indices.push_back(v);
    }
    model.indices = std::move(indices);
    model.normals.clear();
    model.uvs.clear();
    model.materialUvs.clear();
    model.triangleMaterial.clear();
}

}  // namespace

void lodCases(Bench& bench) {
    constexpr float kRadii[] = {2, 4, 8, 16, 32, 64};
    if (!bench.wants("render/lod-")) return;
    const std::string path = bench.options().dataFolder + "/derived/bunny.glb";
    Result<Model> model = importModel(path);
    if (!model) return bench.skip("render/lod-", "needs " + path);
    refine(*model);
    BakeOptions options;
    options.resolution = 512;
    Result<Baked> baked = bake(*model, options);
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!baked || !device) return bench.skip("render/lod-", "no device, or the scan can't be baked");
    auto renderer = Renderer::create(**device, bench.options().contentFolder + "/terminals.glb");
    if (!renderer) return bench.skip("render/lod-", renderer.failure().text());
    const SurfaceData& data = baked->surface;
    const glm::vec3 middle = (data.boundsMin + data.boundsMax) * 0.5f;
    const float radius = glm::length(data.boundsMax - data.boundsMin) / 2;
    for (float radii : kRadii) {
        DrawInputs inputs;
        inputs.look.shadows = false;
        inputs.camera = {middle + glm::normalize(glm::vec3(0.4f, 0.3f, 1)) * radius * radii, middle, {0, 1, 0}};
        inputs.camera.nearPlane = radius * 0.05f;
        std::vector<double> times[2];
        uint64_t triangles[2] = {};
        for (int i = -1; i < bench.options().repeats; ++i)
            for (int side = 0; side < 2; ++side) {
                inputs.look.lodPixels = side == 0 ? 1.0f : 0.0f;
                if (Status s = (*renderer)->setSurface(0, data, glm::mat4(1)); !s) return;
                for (int frame = 0; frame < 2; ++frame) {
                    Result<Commands> commands = Commands::begin(**device, "frame");
                    if (!commands || !(*renderer)->draw(*commands, inputs, {}) || !commands->finish()) return;
                }
                (*device)->collect();
                const RenderStats stats = (*renderer)->stats();
                if (i >= 0) times[side].push_back(stats.drawMs);
                triangles[side] = stats.modelTriangles;
            }
        char name[32], figure[96];
        std::snprintf(name, sizeof name, "render/lod-%.0f-radii", double(radii));
        std::snprintf(figure, sizeof figure, "frame, %llu triangles drawn",
                      static_cast<unsigned long long>(triangles[0]));
        char other[64];
        std::snprintf(other, sizeof other, "the mesh of %llu triangles", static_cast<unsigned long long>(triangles[1]));
        bench.add({name, figure, "ms", median(times[0]), other, median(times[1])});
    }
}

}  // namespace espalier
