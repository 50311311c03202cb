// paint/…: one dab on the sample's ruin, from the call until the layer has it; a C++ loop over the same blocks beside
// it.
#include <algorithm>
#include <array>
#include <chrono>

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

// The mean of six places straight over the chart, clamped to the picture: no seams, the least that smoothing can do.
void loopSmooth(const SurfaceLevelData& level, const std::vector<uint32_t>& blocks, const BrushRecord& brush,
                const DabRecord& dab, int reach, std::vector<float>& layer, std::vector<float>& result) {
    const int last = int(level.size) - 1;
    const int up = reach * 7 / 8;
    const int ways[6][2] = {{reach, 0},       {-reach, 0},      {reach / 2, up},
                            {reach / 2, -up}, {-reach / 2, up}, {-reach / 2, -up}};
    result.clear();
    for (uint32_t block : blocks)
        for (uint32_t i = block * kBlockTexels; i < (block + 1) * kBlockTexels; ++i) {
            const Texel& texel = level.texels[i];
            result.push_back(layer[i]);
            if (texelClass(texel.bits) == kTexelEmpty) continue;
            const float share = dabWeight(brush, dab, texel.position, glm::vec3(0));
            const int x = int(block % (level.size / 8) * 8 + i % 8), y = int(block / (level.size / 8) * 8 + i % 64 / 8);
            float sum = 0;
            for (const auto& way : ways)
                sum += layer[texelIndex(level.size, uint32_t(std::clamp(x + way[0], 0, last)),
                                        uint32_t(std::clamp(y + way[1], 0, last)))];
            result.back() = towards(layer[i], sum / 6, share);
        }
    size_t k = 0;
    for (uint32_t block : blocks)
        for (uint32_t i = block * kBlockTexels; i < (block + 1) * kBlockTexels; ++i) layer[i] = result[k++];
}

// Strokes of so many dabs, a quarter of the radius apart; CPU time of a dab.
void smoothCase(Bench& bench, Device& device, Painter& painter, const SurfaceData& data, int dabs,
                const std::string& name) {
    if (!bench.wants(name)) return;
    const float radius = 1;
    const SurfaceLevelData& level = data.levels.front();
    std::vector<float> onCpu(size_t(level.size) * level.size), result;
    for (size_t i = 0; i < onCpu.size(); ++i) onCpu[i] = float(i / kBlockTexels % 2);
    Result<GpuSurface> surface = GpuSurface::create(device, data);
    Result<Buffer> layer = makeBuffer(device, "bench layer", onCpu);
    if (!surface || !layer) return bench.skip(name, "no room on the device");
    Result<Buffer> table = makeBuffer(device, "bench surfaces", std::vector<SurfaceRef>{surface->ref()});
    if (!table) return bench.skip(name, "no room on the device");
    Canvas canvas{&*layer, surface->ref(), 0, {reinterpret_cast<SurfaceRef*>(table->address())}};
    const BlockBounds bounds(level);
    const BrushRecord brush = softBrush(radius);
    const auto dabAt = [&](int i) { return DabRecord{{-1.4f + .25f * float(i), 1.2f, .36f}, 1, {0, 0, 1}, 0}; };
    size_t touched = 0;
    const auto ours = [&] {
        BlockRecord record;
        for (int i = 0; i < dabs; ++i) {
            const DabRecord dab = dabAt(i);
            PaintJob job{canvas, &record, {}};
            bounds.near(dab.position, radius, job.blocks);
            touched = job.blocks.size();
            (void)painter.smooth(job, {.12f, 11}, brush, {&dab, 1});
        }
        (void)device.wait(device.submitted());
    };
    const auto loop = [&] {
        for (int i = 0; i < dabs; ++i) {
            std::vector<uint32_t> blocks;
            bounds.near(dabAt(i).position, radius, blocks);
            loopSmooth(level, blocks, brush, dabAt(i), 11, onCpu, result);
        }
    };
    ours();
    std::vector<double> a, b;
    for (int i = 0; i < bench.options().repeats; ++i) {
        a.push_back(cpuSeconds(ours));
        b.push_back(cpuSeconds(loop));
    }
    device.collect();
    bench.add({name, std::to_string(touched * kBlockTexels) + " texels; CPU time of a dab", "ms",
               median(a) * 1e3 / dabs, "a C++ loop that knows no seams", median(b) * 1e3 / dabs});
    bench.add({name + "/places", "GPU time of finding where texels look", "ms", device.milliseconds("paint places"),
               "of a dab", device.milliseconds("paint smooth")});
}

// What a stroke's end costs: its record is closed, and copied to the host with what was painted.
void keepCase(Bench& bench, Device& device, Painter& painter, const SurfaceData& data, const std::string& name) {
    if (!bench.wants(name)) return;
    const float radius = 1;
    const SurfaceLevelData& level = data.levels.front();
    std::vector<float> kept(size_t(level.size) * level.size);
    Result<GpuSurface> surface = GpuSurface::create(device, data);
    Result<Buffer> layer = makeBuffer(device, "bench layer", kept);
    if (!surface || !layer) return bench.skip(name, "no room on the device");
    const Canvas canvas{&*layer, surface->ref(), 0, {}};
    const BlockBounds bounds(level);
    std::vector<double> closing, keeping;
    size_t touched = 0;
    for (int i = 0; i < bench.options().repeats * 3; ++i) {
        BlockRecord record;
        for (int k = 0; k < 8; ++k) {
            const DabRecord dab{{-1.4f + .25f * float(k), 1.2f, .36f}, 1, {0, 0, 1}, 0};
            BrushRecord brush = softBrush(radius);
            brush.target = float(i % 2);
            PaintJob job{canvas, &record, {}};
            bounds.near(dab.position, radius, job.blocks);
            (void)painter.dabs({&job, 1}, brush, {&dab, 1});
        }
        (void)device.wait(device.submitted());
        const auto before = std::chrono::steady_clock::now();
        (void)painter.close(canvas, record);
        (void)device.wait(device.submitted());
        const auto closed = std::chrono::steady_clock::now();
        (void)painter.keep(canvas, record, kept);
        const auto done = std::chrono::steady_clock::now();
        touched = record.blocks().size();
        closing.push_back(std::chrono::duration<double, std::milli>(closed - before).count());
        keeping.push_back(std::chrono::duration<double, std::milli>(done - closed).count());
    }
    bench.add({name, std::to_string(touched * kBlockTexels) + " texels to the host, wall clock", "ms", median(keeping),
               "closing the stroke's record", median(closing)});
}

}  // namespace

void paintCases(Bench& bench) {
    if (std::ranges::none_of(
            std::array{"paint/dab-25cm", "paint/dab-100cm", "paint/smooth-first", "paint/smooth-100cm", "paint/keep"},
            [&](const char* name) { return bench.wants(name); }))
        return;
    const std::string path = bench.options().contentFolder + "/ruin.surface.glb";
    Result<SurfaceData> data = readSurface(path);
    if (!data) return bench.skip("paint/", "needs " + path);
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip("paint/", device.failure().text());
    Result<std::unique_ptr<Painter>> painter = Painter::create(**device);
    if (!painter) return bench.skip("paint/", painter.failure().text());
    dabCase(bench, **device, **painter, *data, .25f, "paint/dab-25cm");
    dabCase(bench, **device, **painter, *data, 1, "paint/dab-100cm");
    smoothCase(bench, **device, **painter, *data, 1, "paint/smooth-first");
    smoothCase(bench, **device, **painter, *data, 8, "paint/smooth-100cm");
    keepCase(bench, **device, **painter, *data, "paint/keep");
}

}  // namespace espalier
