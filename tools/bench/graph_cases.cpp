// graph/…: the woven sphere while its particles move, by native loops, by shaders and by hand; a fluid; what
// bookkeeping costs.
#include <cstdio>

#include "runtime/gpu/device.hpp"
#include "runtime/nodes/evaluation.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/graph_loop.hpp"

namespace espalier {
namespace {

struct Woven {
    const char *name, *file;
    uint32_t points, curves, samples, sides;
};
constexpr Woven kWoven[] = {{"low", "woven_sphere_low.graph", 50, 25, 28, 8},
                            {"medium", "woven_sphere_medium.graph", 150, 100, 42, 12},
                            {"high", "woven_sphere.graph", 250, 200, 56, 16}};

// A graph that goes a frame further each time.
class Playing {
  public:
    Playing(const std::string& text, std::unique_ptr<NodeMachine> machine) : evaluation_(std::move(machine)) {
        Result<NodeGraph> graph = parseGraph(text, "bench");
        if (graph) ready_ = bool(evaluation_.load(std::move(*graph)));
    }
    explicit operator bool() const { return ready_; }
    void step() {
        evaluation_.setTime({++frame_, 1.0 / 30});
        (void)evaluation_.evaluate();
    }

  private:
    NodeEvaluation evaluation_;
    double frame_ = 0;
    bool ready_ = false;
};

// Median CPU seconds of one call of each, taken in turn.
Pair medianCpu(int repeats, const std::function<void()>& a, const std::function<void()>& b, int calls = 10) {
    const auto many = [&](const std::function<void()>& work) {
        return cpuSeconds([&] {
                   for (int i = 0; i < calls; ++i) work();
               }) /
               calls;
    };
    std::vector<double> timesA, timesB;
    many(a), many(b);
    for (int i = 0; i < repeats; ++i) {
        timesA.push_back(many(a));
        timesB.push_back(many(b));
    }
    return {median(timesA), median(timesB)};
}

void woven(Bench& bench, Device* device) {
    for (const Woven& w : kWoven) {
        const std::string row = std::string("graph/woven-") + w.name;
        if (!bench.wants(row)) continue;
        const std::string text = textOf(bench.options().contentFolder + "/graphs/" + w.file);
        Playing native(text, hostMachine(1)), scalar(text, hostMachine(1, true));
        if (!native || !scalar) {
            bench.skip(row, std::string("needs graphs/") + w.file);
            continue;
        }
        WovenLoop loop(w.points, w.curves, w.samples, w.sides);
        const int repeats = bench.options().repeats;
        const Pair byHand = medianCpu(
            repeats, [&] { native.step(); }, [&] { loop.step(); });
        bench.add({row, "a frame by native loops; CPU time of one thread", "ms", 1e3 * byHand.a, "plain C++ -O3",
                   1e3 * byHand.b});
        const Pair byScalar = medianCpu(
            repeats, [&] { native.step(); }, [&] { scalar.step(); });
        bench.add({row + "/scalar", "the same", "ms", 1e3 * byScalar.a, "the shared text element by element",
                   1e3 * byScalar.b});
        if (!device) continue;
        Playing shaders(text, deviceMachine(*device, false));
        const Pair byShaders = medianCpu(
            repeats, [&] { native.step(); }, [&] { shaders.step(); });
        bench.add({row + "/shaders", "the same", "ms", 1e3 * byShaders.a, "by shaders", 1e3 * byShaders.b});
    }
}

struct Water {
    const char *name, *box;  // 8,000 particles a cubic metre
    double goal;             // ms a step
};
constexpr Water kWater[] = {{"10k", "high: (2, 2, 1), to: (1, 1.25, 1)", 7},
                            {"50k", "high: (5, 2, 2), to: (2.5, 1.25, 2)", 40}};

// A fluid that begins to flow; each pair starts anew.
void fluid(Bench& bench, Device* device) {
    constexpr int kSubsteps = 8;
    for (const Water& w : kWater) {
        const std::string row = std::string("graph/fluid-") + w.name;
        if (!bench.wants(row)) continue;
        const std::string text = std::string("graph 1\nt = Time\nwater = Fluid(low: (0, 0, 0), from: (0, 0, 0), ") +
                                 w.box + ", substeps: " + std::to_string(kSubsteps) + ", time: t.frame)\nshow water\n";
        const auto compared = [&](std::unique_ptr<NodeMachine> machine) {
            Playing native(text, hostMachine(1)), other(text, std::move(machine));
            const Pair frame = medianCpu(
                bench.options().repeats, [&] { native.step(); }, [&] { other.step(); }, 1);
            return Pair{1e3 * frame.a / kSubsteps, 1e3 * frame.b / kSubsteps};
        };
        const Pair byScalar = compared(hostMachine(1, true));
        bench.add({row, "a step by native loops; CPU time of one thread", "ms", byScalar.a, "goal", w.goal});
        bench.add({row + "/scalar", "the same", "ms", byScalar.a, "the shared text element by element", byScalar.b});
        if (!device) continue;
        const Pair byShaders = compared(deviceMachine(*device, false));
        bench.add({row + "/shaders", "the same", "ms", byShaders.a, "by shaders", byShaders.b});
    }
}

// Ten thousand nodes, of which none, one or all have to be made again.
void bookkeeping(Bench& bench) {
    const std::string row = "graph/nodes-10000";
    if (!bench.wants(row)) return;
    constexpr int kLength = 10000;
    std::string text = "graph 1\nt = Number\nn0 = Math(a: t.value, b: 1)\n";
    for (int i = 1; i + 2 < kLength; ++i)
        text += "n" + std::to_string(i) + " = Math(a: n" + std::to_string(i - 1) + ", b: 1)\n";
    text += "show n" + std::to_string(kLength - 3) + "\n";
    Result<NodeGraph> graph = parseGraph(text, "bench");
    NodeEvaluation evaluation(hostMachine(1));
    if (!graph || !evaluation.load(std::move(*graph)) || !evaluation.evaluate()) return bench.skip(row, "no graph");
    float value = 0;
    const std::string last = "n" + std::to_string(kLength - 3);
    const auto touch = [&](const char* node, const char* port) {
        (void)evaluation.setInput(node, port, Literal(++value));
        (void)evaluation.evaluate();
    };
    const Pair ends = medianCpu(
        bench.options().repeats, [&] { touch(last.c_str(), "b"); }, [&] { touch("t", "value"); });
    bench.add({row, "the last of a chain changes; one node is made", "us", 1e6 * ends.a, "the first; all are made",
               1e6 * ends.b});
    const Pair still = medianCpu(
        bench.options().repeats, [&] { (void)evaluation.evaluate(); }, [&] { touch(last.c_str(), "b"); });
    bench.add({row + "/still", "nothing changes", "us", 1e6 * still.a, "the last of a chain does", 1e6 * still.b});
}

}  // namespace

void graphCases(Bench& bench) {
    Result<std::unique_ptr<Device>> device = Device::create();
    woven(bench, device ? device->get() : nullptr);
    fluid(bench, device ? device->get() : nullptr);
    bookkeeping(bench);
}

}  // namespace espalier
