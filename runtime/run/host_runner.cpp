#include "runtime/run/host_runner.hpp"

#include <chrono>

#include "runtime/host/kernels.hpp"

namespace espalier {

bool HostRunner::run(StageList& list, GrowthWatch* watch, PassTimes* times) {
    using Clock = std::chrono::steady_clock;
    for (Stage& stage : list) {
        const HostKernel kernel = hostKernel(stage.kernel.shader);
        require(kernel != nullptr, "a kernel that native code runs");
        GrowthWatch* const watching = stage.watched ? watch : nullptr;
        const Clock::time_point start = Clock::now();
        bool waiting = true, stopped = watching && watching->stopped();
        for (uint32_t wave = stage.firstWave; wave < stage.lastWave && waiting && !stopped; ++wave) {
            if (stage.turn) stage.turn(stage, wave);
            const Environment& given = stage.native.size() > 0 ? stage.native : stage.push;
            waiting = kernel(given.data(), {crew_, watching, stage.groups.count[0], plain_});
            stopped = watching && watching->stopped();
        }
        if (times) (*times)[stage.pass] += std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        if (stopped) return false;
    }
    return true;
}

}  // namespace espalier
