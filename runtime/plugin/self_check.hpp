#pragma once

#include <array>
#include <cstdint>

#include "runtime/core/result.hpp"

namespace espalier {

class Device;

// Whether the device runs our kernels as they are written. Grows a small plant and a roof by shaders and compares them
// with the CPU reference to the bit, writes the plant's triangles, and draws a picture whose blocks of pixels have to
// have known colours. Waits for the GPU. Takes some 0.1 s, beside what the driver's compiler takes the first time.
// Fails with the device's and the driver's names and with what came out wrong (Device::fault), or for want of memory.
Status runSelfCheck(Device& device);

// The picture as the check looks at it: means of its blocks, rows top to bottom, 8 bits a colour.
inline constexpr uint32_t kCheckBlocks = 8;  // a side
using CheckPicture = std::array<std::array<uint8_t, 3>, kCheckBlocks * kCheckBlocks>;
// What runSelfCheck() draws, all but the picture compared before.
Result<CheckPicture> drawCheckPicture(Device& device);

}  // namespace espalier
