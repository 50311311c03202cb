// render/lod-…: what a scan of 200,000 triangles costs in a frame at growing distance, its level of detail within a
// pixel, beside the mesh itself at the same place. Time of all cores that the frame takes longer than one without it.
#include <cstdio>
#include <ctime>
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
        std::vector<double> times[3];  // within a pixel; the mesh; nothing
        uint64_t triangles[2] = {};
        for (int i = -1; i < bench.options().repeats; ++i)
            for (int side = 0; side < 3; ++side) {
                inputs.look.lodPixels = side == 0 ? 1.0f : 0.0f;
                (*renderer)->removeSurface(0);
                if (side < 2)
                    if (Status s = (*renderer)->setSurface(0, data, glm::mat4(1)); !s) return;
                std::clock_t start = 0;
                for (int frame = 0; frame < 4; ++frame) {
                    if (frame == 1) start = std::clock();
                    Result<Commands> commands = Commands::begin(**device, "frame");
                    if (!commands || !(*renderer)->draw(*commands, inputs, {}) || !commands->finish()) return;
                }
                if (i >= 0) times[side].push_back(1e3 * double(std::clock() - start) / (3.0 * CLOCKS_PER_SEC));
                if (side < 2) triangles[side] = (*renderer)->stats().modelTriangles;
            }
        const double nothing = median(times[2]);
        char name[32], figure[96];
        std::snprintf(name, sizeof name, "render/lod-%.0f-radii", double(radii));
        std::snprintf(figure, sizeof figure, "%llu triangles drawn, CPU time",
                      static_cast<unsigned long long>(triangles[0]));
        char other[64];
        std::snprintf(other, sizeof other, "the mesh of %llu triangles", static_cast<unsigned long long>(triangles[1]));
        bench.add({name, figure, "ms", median(times[0]) - nothing, other, median(times[1]) - nothing});
    }
}

}  // namespace espalier
