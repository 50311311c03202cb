// paint/…: one dab on the sample's ruin, from the call until the layer has it; a C++ loop over the same blocks beside
// it.
#include <cstdio>

#include "runtime/paint/painter.hpp"
#include "runtime/surface/gpu_surface.hpp"
#include "tools/bench/bench.hpp"

namespace espalier {
namespace {

BrushRecord softBrush(float radius) {
    BrushRecord brush{};
    brush.perRadius = 1 / radius;
    brush.hardness = .2f;
    brush.perSoft = 1 / .8f;
    brush.target = 1;
    brush.strength = .5f;
    return brush;
}

// What a programmer would write for one thread.
void loopDab(const SurfaceLevelData& level, const std::vector<uint32_t>& blocks, const BrushRecord& brush,
             const DabRecord& dab, std::vector<float>& layer) {
    for (uint32_t block : blocks)
        for (uint32_t i = block * kBlockTexels; i < (block + 1) * kBlockTexels; ++i) {
            const Texel& texel = level.texels[i];
            if (texelClass(texel.bits) == kTexelEmpty) continue;
            const float share = dabWeight(brush, dab, texel.position, glm::vec3(0));
            layer[i] = towards(layer[i], brush.target, share);
        }
}

void dabCase(Bench& bench, Device& device, Painter& painter, const SurfaceData& data, float radius,
             const std::string& name) {
    if (!bench.wants(name)) return;
    const SurfaceLevelData& level = data.levels.front();
    const size_t texels = size_t(level.size) * level.size;
    Result<GpuSurface> surface = GpuSurface::create(device, data);
    Result<Buffer> layer = makeBuffer(device, "bench layer", std::vector<float>(texels));
    if (!surface || !layer) return bench.skip(name, "no room on the device");
    const BlockBounds bounds(level);
    DabRecord dab{{0, 1.2f, .36f}, 1, {0, 0, 1}, 0};
    const BrushRecord brush = softBrush(radius);
    std::vector<float> onCpu(texels);
    BlockRecord record;
    size_t touched = 0;
    // The dab moves a little each time, as in a stroke.
    const auto place = [&](int i) { dab.position.x = -1.4f + .01f * float(i % 20); };
    int i = 0, k = 0;
    const Pair times = medianSeconds(
        bench.options().repeats * 3,
        [&] {
            place(i++);
            PaintJob job{{&*layer, surface->ref(), 0, {}}, &record, {}};
            bounds.near(dab.position, radius, job.blocks);
            touched = job.blocks.size();
            (void)painter.dabs({&job, 1}, brush, {&dab, 1});
            (void)device.wait(device.submitted());
        },
        [&] {
            place(k++);
            std::vector<uint32_t> blocks;
            bounds.near(dab.position, radius, blocks);
            loopDab(level, blocks, brush, dab, onCpu);
        });
    device.collect();
    bench.add({name, std::to_string(touched * kBlockTexels) + " texels, wall clock", "ms", times.a * 1e3,
               "a C++ loop, one thread", times.b * 1e3});
    bench.add({name + "/gpu", "GPU time of the pass", "ms", device.milliseconds("paint dabs"), "saving blocks",
               device.milliseconds("paint save")});
}

}  // namespace

void paintCases(Bench& bench) {
    if (!bench.wants("paint/dab-25cm") && !bench.wants("paint/dab-100cm")) return;
    const std::string path = bench.options().contentFolder + "/ruin.surface.glb";
    Result<SurfaceData> data = readSurface(path);
    if (!data) return bench.skip("paint/", "needs " + path);
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip("paint/", device.failure().text());
    Result<std::unique_ptr<Painter>> painter = Painter::create(**device);
    if (!painter) return bench.skip("paint/", painter.failure().text());
    dabCase(bench, **device, **painter, *data, .25f, "paint/dab-25cm");
    dabCase(bench, **device, **painter, *data, 1, "paint/dab-100cm");
}

}  // namespace espalier
