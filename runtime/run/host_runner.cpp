#include "runtime/run/host_runner.hpp"

#include <chrono>

#include "runtime/host/kernels.hpp"

namespace espalier {

bool HostRunner::run(StageList& list, GrowthWatch* watch, PassTimes* times) {
    using Clock = std::chrono::steady_clock;
    for (size_t i = 0; i < list.size(); i += list[i].together) {
        const std::span<Stage> group(&list[i], list[i].together);
        GrowthWatch* const watching = group[0].watched ? watch : nullptr;
        const Clock::time_point start = Clock::now();
        bool waiting = true, stopped = watching && watching->stopped();
        for (uint32_t wave = group[0].firstWave; wave < group[0].lastWave && waiting && !stopped; ++wave) {
            for (size_t k = 0; k < group.size() && waiting; ++k) waiting = runOnce(group[k], wave, watching);
            stopped = watching && watching->stopped();
        }
        if (times) (*times)[group[0].pass] += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        if (stopped) return false;
    }
    return true;
}

// False: it is a kernel of waves, and nothing waits in this one.
bool HostRunner::runOnce(Stage& stage, uint32_t wave, GrowthWatch* watch) {
    const HostKernel kernel = hostKernel(stage.kernel.shader);
    require(kernel != nullptr, "a kernel that native code runs");
    if (stage.turn) stage.turn(stage, wave);
    const Environment& given = stage.native.size() > 0 ? stage.native : stage.push;
    return kernel(given.data(), {crew_, watch, stage.groups.count[0], plain_});
}

}  // namespace espalier
