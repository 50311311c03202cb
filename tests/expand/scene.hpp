#pragma once

// Small scenes for growth: a baked surface, grammars, layers and seeds, on the GPU and for the CPU reference alike.

#include <functional>
#include <string>
#include <vector>

#include "runtime/expand/cpu_growth.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/buffer.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/surface/gpu_surface.hpp"
#include "tests/support/cube_model.hpp"
#include "tools/bake/bake.hpp"

namespace espalier::growthtest {

// A square of 2 m in the xz plane, one chart, facing up.
Model flatSquare();
using test::ball;
using test::cube;

class Scene {
  public:
    explicit Scene(SurfaceData surface);
    static Scene baked(const Model& model, uint32_t resolution = 256);

    uint32_t addGrammar(const std::string& text);  // index; fails the test if it doesn't compile
    RuleMap& grammar(uint32_t index) { return grammars_[index]; }
    // value of texel at uv, for the scene's layer `layer`; size a multiple of 8
    void paint(uint32_t layer, uint32_t size, const std::function<float(glm::vec2)>& value);
    // At the inner texel of level 0 nearest to `at` (object space).
    void plant(glm::vec3 at, glm::vec3 direction, uint32_t grammar = 0, uint64_t number = 1);
    // `count` of them, spread over all inner texels, each with a direction of its own.
    void plantMany(uint32_t count, uint32_t grammar = 0, uint64_t number = 1);
    void clearSeeds() { seeds_.clear(); }

    std::vector<Seed>& seeds() { return seeds_; }
    std::vector<uint64_t> pruned;     // see GrowthInputs::pruned
    std::vector<FrozenPlant> frozen;  // see GrowthInputs::frozen; not for growOnCpu
    const SurfaceData& surface() const { return surface_; }
    GrowthLimits limits;
    std::vector<float> widths, avoid;        // see GrowthInputs
    const GrowthChanges* changes = nullptr;  // see GrowthInputs::changes
    GrowthWatch* watch = nullptr;            // see GrowthInputs
    bool native = false;                     // see there; tests are of shaders where they don't say otherwise

    Result<CpuGrowth> growOnCpu(const March& march = {});
    // Uploads and grows; the buffers live as long as the scene.
    Status grow(Device& device, Growth& growth);

  private:
    struct Layer {
        uint32_t index, size;
        std::vector<float> texels;
    };
    SurfaceData surface_;
    std::vector<RuleMap> grammars_;
    std::vector<Layer> layers_;
    std::vector<Seed> seeds_;
    // Rule maps stay where they are until they change, as a host's do.
    struct Uploaded {
        std::vector<uint32_t> words;
        Buffer buffer;
    };
    GpuSurface gpuSurface_;
    std::vector<Uploaded> uploaded_;
    std::vector<Buffer> buffers_;
};

// A validated device; its end checks that the layer had nothing to say.
struct TestDevice {
    explicit TestDevice(bool validation = true);
    ~TestDevice();
    std::unique_ptr<Device> owner;
    Device& device() { return *owner; }
    std::unique_ptr<Growth> growth(const GrowthRoom& room = {});
};

}  // namespace espalier::growthtest
