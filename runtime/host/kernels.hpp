#pragma once

// The kernels of plants, roofs, patterns and the graph as native code, a row each by the name of their shader: their
// own text compiled as C++ (-ffp-contract=off), so they leave the same bits. On devices that run shaders on the CPU
// native code runs over the very memory that shaders would use: lanes of such a device share one core, and code that
// can leave out what a lane doesn't need is faster there.

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/core/growth_watch.hpp"
#include "runtime/core/jobs.hpp"

namespace espalier {

// What a kernel runs with.
struct HostRun {
    Crew& crew;
    GrowthWatch* watch = nullptr;  // null: nobody may stop it
    uint32_t groups = 1;           // that its shader would be dispatched for
    bool plain = false;            // items go one by one
};

// env: the kernel's environment, whose addresses are all pointers. Nothing else may use that memory meanwhile; what
// `watch` stops isn't whole. Returns when all is done: false if the kernel is of waves and nothing waits in its wave.
using HostKernel = bool (*)(const void* env, const HostRun& run);

// Null: there is no native code of it.
HostKernel hostKernel(std::string_view shader);

// A row of a file's table.
struct HostRow {
    std::string_view shader;
    HostKernel run;
};
extern const std::span<const HostRow> kGrowthRows, kRegrowthRows, kGapRows, kRoofRows, kPatternRows, kNodeRows,
    kFluidRows;

// The kernel of a function over all of a pass, or over one wave.
template <class Env, void (*Pass)(Env, const HostRun&)>
bool passOf(const void* env, const HostRun& run) {
    Pass(*static_cast<const Env*>(env), run);
    return true;
}
template <class Env, bool (*Wave)(Env, const HostRun&)>
bool waveOf(const void* env, const HostRun& run) {
    return Wave(*static_cast<const Env*>(env), run);
}

}  // namespace espalier
