#pragma once

// What the growth and emit cases stand on: a device, a baked model, a grammar, seeds.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "runtime/expand/cpu_growth.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/surface/gpu_surface.hpp"
#include "tools/bake/bake.hpp"

namespace espalier {

class BenchScene {
  public:
    // Bakes the model at `path`; prints why and returns null if that fails.
    static std::unique_ptr<BenchScene> create(Device& device, const std::string& path, uint32_t resolution);

    // Compiles the text; prints and returns false if that fails.
    bool setGrammar(const std::string& text);
    // Likewise in place of the text that has grown; edits: what the next growth is to take as changed.
    bool changeGrammar(const std::string& text, GrowthChanges& edits);
    // `count` seeds over all inner texels, each with a direction of its own; the same in every run.
    void plant(uint32_t count);
    GrowthLimits limits;
    bool native = true;  // see GrowthInputs
    float avoid = 0;     // see GrowthInputs

    // Paints a layer of `size` texels a side; the next growth reads it. False: no memory.
    bool paint(uint32_t layer, uint32_t size, const std::vector<float>& texels);
    // What the next growths may take as changed; null: everything.
    const GrowthChanges* changes = nullptr;

    Status grow(Growth& growth);
    // With room for as much as `stats` count, so that it needn't begin again.
    Result<CpuGrowth> growOnCpu(const GrowthStats& stats) const;

    // Median edge of a texel of the finest level, metres.
    float texelMetres() const;
    SurfaceBuf surfaces() const { return {reinterpret_cast<SurfaceRef*>(table_.address())}; }
    const SurfaceData& surface() const { return surface_; }

  private:
    Device* device_ = nullptr;
    SurfaceData surface_;
    GpuSurface gpuSurface_;
    RuleMap grammar_;
    std::vector<Seed> seeds_;
    Buffer table_, words_, layers_;
    std::array<Buffer, kMaxLayers> painted_;
    std::vector<LayerRef> layerRefs_ = std::vector<LayerRef>(kMaxLayers, LayerRef{{nullptr}, 0, 1});
};

// Recursive ivy as the paper's Figure 10a: stems that wander, twigs that end after some steps, bark and a leaf a span.
// `step` in metres; a stem has `stemSteps`, a twig up to `twigSteps`.
std::string branchingGrammar(float step, uint32_t stemSteps, uint32_t twigSteps);

}  // namespace espalier
