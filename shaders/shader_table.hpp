#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace espalier {

struct Shader {
    std::string_view name;           // its path below shaders/
    std::span<const uint32_t> code;  // SPIR-V words, which live as long as the program
};
std::span<const Shader> allShaders();

// The SPIR-V words of the shader at `name`, its path below shaders/ ("expand/march.comp").
// The words live as long as the program. Empty if there is no such shader.
std::span<const uint32_t> shaderCode(std::string_view name);

}  // namespace espalier
