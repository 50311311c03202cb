#pragma once

#include "runtime/gpu/buffer.hpp"

namespace espalier {

// Whether native code does at once what kernels would: where a device runs kernels on the CPU and its memory is the
// process's own. wanted: by the caller. memory: any device buffer of those that kernels use.
inline bool runsAtOnce(const Device& device, bool wanted, const Buffer& memory) {
    return wanted && device.info().cpu && memory && uintptr_t(memory.mapped()) == memory.address();
}

}  // namespace espalier
