#pragma once

// Mesa's compiler for AMD's GPUs, without a GPU: RADV offers a device for a chip that isn't there, on which pipelines
// can be made and nothing run.

#include <vulkan/vulkan.h>  // before what declares no functions: this program links the loader

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "runtime/core/result.hpp"
#include "runtime/gpu/spirv.hpp"

namespace espalier {

// What the compiler says of a kernel. Registers are 32 bits wide.
struct KernelCost {
    uint32_t lanes = 0;  // of a subgroup
    uint32_t vectorRegisters = 0, scalarRegisters = 0;
    uint32_t spilledVector = 0, spilledScalar = 0;  // registers that went to memory
    uint32_t scratchBytes = 0;                      // of a lane: spills, and arrays that are indexed
    uint32_t subgroups = 0;                         // that fit on a SIMD unit together
    uint32_t instructions = 0, codeBytes = 0;
};

class NullDevice {
  public:
    // chip: as Mesa calls it, "navi21". Fails where this Mesa has no such chip, and where RADV isn't installed. At most
    // one in a process: RADV reads the name once.
    static Result<NullDevice> open(const std::string& chip);
    NullDevice(NullDevice&& other) noexcept;
    NullDevice& operator=(NullDevice&&) = delete;
    ~NullDevice();

    // name: "AMD RADV NAVI21 (…)". driver: "Mesa 22.3.6".
    const std::string& name() const { return name_; }
    const std::string& driver() const { return driver_; }
    // Compiles a compute module with its specialization constants' defaults.
    Result<KernelCost> compile(std::string_view name, std::span<const uint32_t> code) const;

  private:
    NullDevice() = default;
    Status openInstance();
    Status openDevice(const std::string& chip);
    Result<KernelCost> costOf(std::string_view name, VkPipeline pipeline) const;

    VkInstance instance_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    std::string name_, driver_;
};

}  // namespace espalier
