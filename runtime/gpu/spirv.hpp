#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/gpu/functions.hpp"

namespace espalier {

struct SpecConstant {
    uint32_t id;
    uint32_t value;  // the bits
};

// What a module of one entry point tells of itself.
struct ShaderInterface {
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
    std::string entryPoint;
    std::array<uint32_t, 3> localSize{1, 1, 1};  // with the specialization constants applied
    uint32_t pushBytes = 0;                      // to the end of the last member
    struct Slot {
        uint32_t binding;
        VkDescriptorType type;
        auto operator<=>(const Slot&) const = default;
    };
    std::vector<Slot> slots;  // of set 0, sorted
    // Layout of every struct that has one, "Node" -> (member, byte offset), in order; needs debug names.
    std::map<std::string, std::vector<std::pair<std::string, uint32_t>>> layouts;
    // Bytes from one to the next in arrays of a struct.
    std::map<std::string, uint32_t> strides;
};

// Fails if the words aren't a well-formed module, or use what we don't: sets other than 0, arrays of descriptors.
// Checks the form only; whether a module is valid is the validation layer's matter.
Result<ShaderInterface> reflect(std::string_view name, std::span<const uint32_t> code,
                                std::span<const SpecConstant> constants = {});

// The module with NoContraction on the result of every float operation that could be fused or reassociated. `code`
// must have passed reflect().
std::vector<uint32_t> withoutContraction(std::span<const uint32_t> code);

// The module with the mode in which lanes of a subgroup that have parted meet again where their ways meet
// (VK_KHR_shader_maximal_reconvergence), if it has operations of subgroups; else as it is. `code` must have passed
// reflect().
std::vector<uint32_t> reconverged(std::span<const uint32_t> code);

}  // namespace espalier
