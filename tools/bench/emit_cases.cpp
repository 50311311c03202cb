// emit/…: 4.5 million triangles of bark written to memory, beside a hand-written C++ loop on two threads that writes
// as many, and beside memset of the same bytes. On software devices they are written by native code
// (EmitInputs::native); shaders have a row of their own.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>

#include "runtime/emit/emit.hpp"
#include "runtime/host/triangles.hpp"
#include "shaders/shared/exact.h"
#include "tools/bench/bark_loop.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"

namespace espalier {
namespace {

// As many spans of the same kind, each a gentle bend somewhere in a cube.
std::vector<BarkSpan> spansLike(uint32_t count) {
    std::vector<BarkSpan> spans(count);
    for (uint32_t i = 0; i < count; ++i) {
        float a = float(i) * 0.37f;
        glm::vec3 p(std::sin(a), std::cos(a * 1.3f), std::sin(a * 0.7f)), d(0.02f, 0.01f * std::sin(a), 0.005f);
        spans[i] = {p,      p + d * 0.33f, p + d * 0.66f + glm::vec3(0, 0.002f, 0), p + d, {0, 1, 0.1f}, {0.1f, 1, 0},
                    0.004f, 0.003f};
    }
    return spans;
}

struct LoopTimes {
    double loop = 0, fill = 0;
    double loopCpu = 0, nativeCpu = 0;  // CPU time of the loop, and of native code on the same spans
};

LoopTimes timeLoop(uint32_t spanCount, std::vector<BarkVertex>& vertices, std::vector<uint32_t>& indices) {
    std::vector<BarkSpan> spans = spansLike(spanCount);
    std::vector<SpanInstance> instances(spanCount);
    std::vector<DrawnItem> drawn(spanCount);
    for (uint32_t i = 0; i < spanCount; ++i) {
        const BarkSpan& s = spans[i];
        instances[i] = {
            s.p0, s.b1, s.b2,         s.p3, packOct(s.normal0), packOct(s.normal1), s.radius0, s.radius1, 0, 0,
            0,    0,    glm::vec3(0), 0};
        drawn[i].item = i;
    }
    static_assert(sizeof(TriangleVertex) == sizeof(BarkVertex));
    LoopTimes times;
    times.nativeCpu = cpuSeconds([&] {
        writeBarkNative(instances.data(), drawn.data(), spanCount, reinterpret_cast<TriangleVertex*>(vertices.data()),
                        indices.data());
    });
    times.loopCpu = cpuSeconds([&] { times.loop = seconds([&] { writeBark(spans, vertices, indices); }); });
    times.fill = seconds([&] {
        std::thread other([&] { std::memset(indices.data(), 1, indices.size() * 4); });
        std::memset(static_cast<void*>(vertices.data()), 1, vertices.size() * sizeof(BarkVertex));
        other.join();
    });
    return times;
}

}  // namespace

void emitCases(Bench& bench) {
    const char* name = "emit/bark-4.5M";
    if (!bench.wants(name)) return;
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    Result<std::unique_ptr<Growth>> growth = Growth::create(**device);
    auto scene = BenchScene::create(**device, bench.options().contentFolder + "/ruin.glb", 1024);
    Result<TerminalData> meshes = readTerminals(bench.options().contentFolder + "/terminals.glb");
    if (!growth || !scene || !meshes) return bench.skip(name, "needs " + bench.options().contentFolder);
    Result<Terminals> terminals = Terminals::create(**device, std::move(*meshes));
    if (!terminals) return bench.skip(name, terminals.failure().text());
    Result<Emit> emit = Emit::create(**device, *terminals);
    if (!emit) return bench.skip(name, emit.failure().text());

    const char* stems =
        "param stride = 0.01 [0 .. 1]\nStem(n) -> Marching(stride, rand(-0.1, 0.1), n < 1300) {Stem(n + 1), Bark}\n"
        "Bark -> S(0.004) Shape(\"bark\", C1)\n";
    if (!scene->setGrammar(stems)) return;
    scene->plant(16);
    if (Status grown = scene->grow(**growth); !grown) return bench.skip(name, grown.failure().text());

    std::vector<double> ours, shaders, gather, gatherShaders, loop, fill, loopCpu, nativeCpu;
    uint64_t triangles = 0, bytes = 0;
    for (int i = -1; i < bench.options().repeats; ++i) {
        EmitInputs inputs{(*growth)->view(), scene->surfaces()};
        emit->forget();  // bound anew
        Result<EmittedTriangles> made = emit->materialise(inputs);
        if (!made) return bench.skip(name, made.failure().text());
        triangles = made->indexCount / 3;
        bytes = made->vertexCount * sizeof(BarkVertex) + made->indexCount * 4;
        std::vector<BarkVertex> vertices(made->vertexCount);
        std::vector<uint32_t> indices(made->indexCount);
        uint32_t spans = uint32_t(made->vertexCount / kBarkSpanVertices);
        timeLoop(spans, vertices, indices);  // touches the memory first
        LoopTimes times = timeLoop(spans, vertices, indices);
        const double ms = made->milliseconds, gatherMs = made->gatherMilliseconds;
        inputs.native = false;
        made = emit->materialise(inputs);
        if (i < 0 || !made) continue;
        ours.push_back(ms * 1e-3);
        shaders.push_back(made->milliseconds * 1e-3);
        loopCpu.push_back(times.loopCpu);
        nativeCpu.push_back(times.nativeCpu);
        gather.push_back(gatherMs * 1e-3);
        gatherShaders.push_back(made->gatherMilliseconds * 1e-3);
        loop.push_back(times.loop);
        fill.push_back(times.fill);
    }
    double million = double(triangles) * 1e-6;
    std::printf("%.2f million triangles, %.0f MB\n", million, double(bytes) * 1e-6);
    bench.add({name, "triangles written", "ms", median(ours) * 1e3, "C++ loop, 2 threads", median(loop) * 1e3});
    if ((*device)->info().cpu) {
        bench.add({std::string(name) + "/cpu", "CPU time of native code", "ms", median(nativeCpu) * 1e3,
                   "of the C++ loop", median(loopCpu) * 1e3});
        bench.add({std::string(name) + "/native", "written by native code", "ms", median(ours) * 1e3, "by shaders",
                   median(shaders) * 1e3});
    }
    bench.add({std::string(name) + "/memset", "triangles written", "ms", median(ours) * 1e3,
               "memset of the same bytes, 2 threads", median(fill) * 1e3});
    bench.add({std::string(name) + "/gather", "spans gathered before", "ms", median(gather) * 1e3, "by shaders",
               median(gatherShaders) * 1e3});
}

}  // namespace espalier
