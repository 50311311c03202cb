#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/gpu/buffer.hpp"
#include "runtime/gpu/image.hpp"
#include "runtime/gpu/spirv.hpp"

namespace espalier {

struct ProgramOptions {
    // No float operation of the module is fused or reassociated: the same bits as C++ with -ffp-contract=off.
    bool exact = false;
    std::vector<SpecConstant> constants;
};
inline ProgramOptions exactly(std::vector<SpecConstant> constants = {}) {
    return {true, std::move(constants)};
}

// over: colours are premultiplied by alpha and go over what is there; alpha takes of what is there, and adds nothing.
// multiply: of colours; alpha stays.
enum class Blend { none, additive, over, multiply };

// Input `location` of a vertex shader: so many bytes into a vertex.
struct VertexInput {
    uint32_t location = 0;
    VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
    uint32_t offset = 0;
};

struct GraphicsDesc {
    std::string_view name;
    std::string_view vertex;
    std::string_view fragment;        // empty: depth only
    std::vector<VertexInput> inputs;  // of DrawPass::setVertices; none: vertices are pulled by gl_VertexIndex
    uint32_t vertexBytes = 0;         // from one vertex to the next
    std::vector<VkFormat> colors;     // the fragment shader writes the first; others stay as they are
    VkFormat depth = VK_FORMAT_UNDEFINED;
    VkFormat stencil = VK_FORMAT_UNDEFINED;    // of an attachment that is there and left alone
    VkRenderPass renderPass = VK_NULL_HANDLE;  // of a host's; null: dynamic rendering
    uint32_t subpass = 0;
    bool depthWrite = true;
    VkCompareOp depthCompare = VK_COMPARE_OP_LESS_OR_EQUAL;
    float depthBiasConstant = 0;
    float depthBiasSlope = 0;
    Blend blend = Blend::none;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    uint32_t samples = 1;
    ProgramOptions options;
};

// What one binding of set 0 gets; written as a braced list in the order of the binding numbers.
struct Binding {
    Binding(const Image& image, const Sampler& with) : view(image.view()), sampler(with.handle()) {}
    Binding(const Image& storage) : view(storage.view()) {}
    Binding(VkImageView imageView, VkSampler imageSampler) : view(imageView), sampler(imageSampler) {}
    Binding(const Buffer& whole) : buffer(whole.handle()) {}
    Binding(const TexelView& given) : texels(given.handle()) {}
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
    VkBuffer buffer = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE;
};

// A compute or graphics pipeline with all that its SPIR-V tells of itself.
class Program {
  public:
    Program() = default;
    // `shader`: its path below shaders/, "expand/march.comp". A name that isn't there is a programming mistake.
    // Fails when memory has run out.
    static Result<Program> compute(Device& device, std::string_view shader, const ProgramOptions& options = {});
    static Result<Program> graphics(Device& device, const GraphicsDesc& desc);

    VkPipeline pipeline() const { return pipeline_.get(); }
    VkPipelineLayout layout() const { return layout_.get(); }
    VkShaderStageFlags stages() const { return stages_; }
    bool isCompute() const { return stages_ == VK_SHADER_STAGE_COMPUTE_BIT; }
    const std::string& name() const { return name_; }
    std::array<uint32_t, 3> localSize() const { return localSize_; }
    uint32_t pushBytes() const { return pushBytes_; }
    const std::vector<ShaderInterface::Slot>& slots() const { return slots_; }  // sorted by binding
    explicit operator bool() const { return bool(pipeline_); }

  private:
    Status makeLayout(Device& device, std::span<const ShaderInterface> stages);

    Owned<VkDescriptorSetLayout> setLayout_;
    Owned<VkPipelineLayout> layout_;
    Owned<VkPipeline> pipeline_;
    VkShaderStageFlags stages_ = 0;
    std::array<uint32_t, 3> localSize_{1, 1, 1};
    uint32_t pushBytes_ = 0;
    std::vector<ShaderInterface::Slot> slots_;
    std::string name_;
};

// A compute program to be made, and where it goes.
struct ComputeDesc {
    Program& program;
    const char* shader;
    ProgramOptions options{};
    uint32_t groupItems = 0;  // its local size along x, where somebody relies on that; 0: any
};
// Fails with the first that fails.
Status makeCompute(Device& device, std::initializer_list<ComputeDesc> kernels);

}  // namespace espalier
