// growth/…: nodes a second on a real model, from 1 to 4,096 seeds; the CPU reference of the same text beside it,
// and 4,096 seeds beside 64. On software devices growth is native code (GrowthInputs::native); shaders have rows of
// their own.
#include <cstdio>
#include <map>

#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"

namespace espalier {
namespace {

// Counted are recorded samples of the grammar, at least two texels from the one before: not those that seams,
// creases and split spans put in.
double stepsOf(const GrowthStats& stats) {
    return double(stats.nodes) - double(stats.inserted);
}

struct Measured {
    double nodesPerSecond = 0, coreNodesPerSecond = 0, cpuNodesPerSecond = 0;
    GrowthStats stats;
};

Measured measure(Bench& bench, BenchScene& scene, Growth& growth) {
    std::vector<double> gpu, core, cpu;
    Measured result;
    for (int i = -2; i < bench.options().repeats; ++i) {
        Status grown = Done{};
        double wall = 0;
        const double busy = cpuSeconds([&] { wall = seconds([&] { grown = scene.grow(growth); }); });
        if (!grown) return std::printf("%s\n", grown.failure().text().c_str()), Measured{};
        if (i < 0) continue;  // pipelines warm up, buffers reach their size
        gpu.push_back(wall);
        core.push_back(busy);
        if (i < 2) cpu.push_back(cpuSeconds([&] { (void)scene.growOnCpu(growth.stats()); }));
    }
    result.stats = growth.stats();
    result.nodesPerSecond = stepsOf(result.stats) / median(gpu);
    result.coreNodesPerSecond = stepsOf(result.stats) / median(core);
    result.cpuNodesPerSecond = stepsOf(result.stats) / median(cpu);
    return result;
}

// Stems that keep a distance of two texels beside the same that don't, in turn.
void avoidRow(Bench& bench, BenchScene& scene, Growth& growth, const std::string& row) {
    std::vector<double> apart, free;
    double nodes[2] = {};
    for (int i = -1; i < bench.options().repeats; ++i)
        for (const bool keeps : {true, false}) {
            scene.avoid = keeps ? 2 * scene.texelMetres() : 0;
            Status grown = Done{};
            const double busy = cpuSeconds([&] { grown = scene.grow(growth); });
            if (!grown) return bench.skip(row, grown.failure().text());
            nodes[keeps] = stepsOf(growth.stats());
            if (i >= 0) (keeps ? apart : free).push_back(busy);
        }
    scene.avoid = 0;
    bench.add({row, "growth of stems that keep a distance, a second of CPU time", "nodes/s", nodes[1] / median(apart),
               "that don't", nodes[0] / median(free)});
    bench.add({row + "/time", "the same growth, CPU time", "ms", median(apart) * 1e3, "without a distance",
               median(free) * 1e3});
}

}  // namespace

void growthCases(Bench& bench) {
    const std::string name = "growth/";
    std::vector<uint32_t> wanted;
    for (uint32_t seeds : {1u, 8u, 42u, 64u, 512u, 4096u})
        if (bench.wants(name + "bunny-" + std::to_string(seeds)) || bench.wants(name + "4096-to-64"))
            wanted.push_back(seeds);
    if (wanted.empty()) return;
    std::string path = bench.options().dataFolder + "/derived/bunny_unwrap.glb";
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    Result<std::unique_ptr<Growth>> growth = Growth::create(**device);
    auto scene = BenchScene::create(**device, path, 1024);
    if (!growth || !scene) return bench.skip(name, "needs " + path);

    std::map<uint32_t, double> rate;
    for (uint32_t seeds : wanted) {
        // The same number of nodes whatever the number of seeds, a little above half a million.
        if (!scene->setGrammar(branchingGrammar(2.2f * scene->texelMetres(), 1200 * 42 / seeds, 24))) return;
        scene->plant(seeds);
        Measured m = measure(bench, *scene, **growth);
        rate[seeds] = m.nodesPerSecond;
        std::string row = name + "bunny-" + std::to_string(seeds);
        bench.add({row, "growth with terminals, wall clock", "nodes/s", m.nodesPerSecond,
                   "the CPU reference, one thread", m.cpuNodesPerSecond});
        bench.add({row + "/core", "growth with terminals, a second of CPU time", "nodes/s", m.coreNodesPerSecond,
                   "the CPU reference", m.cpuNodesPerSecond});
        if (seeds != 42) continue;
        scene->native = false;
        const Measured shaders = m.stats.native ? measure(bench, *scene, **growth) : m;
        scene->native = true;
        if (m.stats.native)
            bench.add({row + "/native", "growth as native code, a second of CPU time", "nodes/s", m.coreNodesPerSecond,
                       "as shaders", shaders.coreNodesPerSecond});
        const GrowthStats& s = m.stats;
        bench.add({row + "/dispatches", "kernels that wait for each other, as shaders", "dispatches",
                   double(shaders.stats.dispatches), "waves of the queue", double(shaders.stats.waves)});
        bench.add({row + "/nodes", "nodes grown", "nodes", stepsOf(s), "asked for", 500000});
        bench.add({row + "/gpu", "time of expansion", "ms", s.expandMs, "of it marching", s.marchMs});
        bench.add({row + "/memory", "bytes of a bark node, chunks too", "B",
                   double(s.nodeBytes + s.chunkBytes) / s.nodes, "bound", 64});
        avoidRow(bench, *scene, **growth, row + "/avoid");
        if (s.leaves) bench.add({row + "/leaf", "bytes of a leaf", "B", double(s.leafBytes) / s.leaves, "bound", 32});
    }
    if (rate.count(64) && rate.count(4096))
        bench.add({name + "4096-to-64", "4,096 seeds", "nodes/s", rate[4096], "64 seeds", rate[64]});
}

}  // namespace espalier
