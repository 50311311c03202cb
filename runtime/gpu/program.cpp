// SPIR-V in, pipelines out: set layout, push range and group size come from the module itself.
#include "runtime/gpu/program.hpp"

#include <algorithm>

#include "runtime/core/check.hpp"
#include "shaders/shader_table.hpp"

namespace espalier {
namespace {

std::span<const uint32_t> builtIn(std::string_view shader) {
    const std::span<const uint32_t> code = shaderCode(shader);
    require(!code.empty(), "there is no shader " + std::string(shader));
    return code;
}

// A shader module, for as long as a pipeline is being made of it.
class LoadedModule {
  public:
    static Result<LoadedModule> create(Device& device, std::string_view name, std::span<const uint32_t> code,
                                       const ProgramOptions& options) {
        Result<ShaderInterface> interface = reflect(name, code, options.constants);
        if (!interface) return interface.failure();
        LoadedModule m(device, std::move(*interface));
        std::vector<uint32_t> exact, together;
        if (options.exact) code = exact = withoutContraction(code);
        if (device.info().maximalReconvergence) code = together = reconverged(code);
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        info.codeSize = code.size_bytes();
        info.pCode = code.data();
        if (!device.succeeded(device.vk().vkCreateShaderModule(device.handle(), &info, nullptr, &m.handle_)))
            return gpuFailure(device, name, "loading a shader");
        device.setName(VK_OBJECT_TYPE_SHADER_MODULE, uint64_t(m.handle_), name);
        return m;
    }
    LoadedModule(LoadedModule&& other) noexcept
        : shape(std::move(other.shape)), device_(other.device_), handle_(std::exchange(other.handle_, nullptr)) {}
    ~LoadedModule() {
        if (handle_) device_->vk().vkDestroyShaderModule(device_->handle(), handle_, nullptr);
    }
    VkPipelineShaderStageCreateInfo stage(const VkSpecializationInfo& constants) const {
        VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        info.stage = shape.stage;
        info.module = handle_;
        info.pName = shape.entryPoint.c_str();
        info.pSpecializationInfo = &constants;
        return info;
    }

    ShaderInterface shape;

  private:
    LoadedModule(Device& device, ShaderInterface interface) : shape(std::move(interface)), device_(&device) {}
    Device* device_;
    VkShaderModule handle_ = VK_NULL_HANDLE;
};

// The map from SpecConstant to Vulkan's form; points into `constants`.
struct Specialization {
    explicit Specialization(const std::vector<SpecConstant>& constants) {
        for (uint32_t i = 0; i < constants.size(); ++i)
            entries.push_back({constants[i].id, uint32_t(i * sizeof(SpecConstant) + offsetof(SpecConstant, value)), 4});
        info = {uint32_t(entries.size()), entries.data(), constants.size() * sizeof(SpecConstant), constants.data()};
    }
    Specialization(const Specialization&) = delete;
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info{};
};

VkPipelineColorBlendAttachmentState blendState(Blend blend) {
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask = 0xF;
    if (blend == Blend::none) return state;
    state.blendEnable = VK_TRUE;
    state.srcColorBlendFactor = state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    state.srcAlphaBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    if (blend == Blend::multiply) {
        state.srcColorBlendFactor = state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
        state.dstColorBlendFactor = VK_BLEND_FACTOR_SRC_COLOR;
    } else if (blend == Blend::over) {
        state.dstColorBlendFactor = state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
    }
    return state;
}

// The fixed-function state of a graphics pipeline; create() fills the rest. Not copyable: it points into itself.
struct FixedFunctions {
    explicit FixedFunctions(const GraphicsDesc& d) : blends(d.colors.size()) {
        if (!blends.empty()) blends[0] = blendState(d.blend);  // writes to the others are masked out
        assembly.topology = d.topology;
        viewport.viewportCount = viewport.scissorCount = 1;
        raster.lineWidth = 1;
        raster.depthBiasEnable = d.depthBiasConstant != 0 || d.depthBiasSlope != 0;
        raster.depthBiasConstantFactor = d.depthBiasConstant;
        raster.depthBiasSlopeFactor = d.depthBiasSlope;
        multisample.rasterizationSamples = VkSampleCountFlagBits(d.samples);
        depth.depthTestEnable = d.depth != VK_FORMAT_UNDEFINED;
        depth.depthWriteEnable = d.depth != VK_FORMAT_UNDEFINED && d.depthWrite;
        depth.depthCompareOp = d.depthCompare;
        for (const VertexInput& input : d.inputs) attributes.push_back({input.location, 0, input.format, input.offset});
        vertices = {0, d.vertexBytes, VK_VERTEX_INPUT_RATE_VERTEX};
        vertexInput.vertexBindingDescriptionCount = attributes.empty() ? 0 : 1;
        vertexInput.pVertexBindingDescriptions = &vertices;
        vertexInput.vertexAttributeDescriptionCount = uint32_t(attributes.size());
        vertexInput.pVertexAttributeDescriptions = attributes.data();
        blend.attachmentCount = uint32_t(blends.size());
        blend.pAttachments = blends.data();
        dynamic.dynamicStateCount = uint32_t(std::size(dynamicStates));
        dynamic.pDynamicStates = dynamicStates;
        rendering.colorAttachmentCount = uint32_t(d.colors.size());
        rendering.pColorAttachmentFormats = d.colors.data();
        rendering.depthAttachmentFormat = d.depth;
        rendering.stencilAttachmentFormat = d.stencil;
    }
    FixedFunctions(const FixedFunctions&) = delete;

    static constexpr VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                                       VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
    VkPipelineVertexInputStateCreateInfo vertexInput{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    std::vector<VkPipelineColorBlendAttachmentState> blends;
    std::vector<VkVertexInputAttributeDescription> attributes;
    VkVertexInputBindingDescription vertices{};
};

}  // namespace

Status Program::makeLayout(Device& device, std::span<const ShaderInterface> shapes) {
    for (const ShaderInterface& shape : shapes) {
        stages_ |= shape.stage;
        pushBytes_ = std::max(pushBytes_, shape.pushBytes);
        slots_.insert(slots_.end(), shape.slots.begin(), shape.slots.end());
    }
    std::ranges::sort(slots_);
    slots_.erase(std::unique(slots_.begin(), slots_.end()), slots_.end());
    if (pushBytes_ > device.info().limits.maxPushConstantsSize)
        return deviceFailure(name_, std::to_string(pushBytes_) + " bytes of push data are more than the GPU takes (" +
                                        std::to_string(device.info().limits.maxPushConstantsSize) + ")");
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (const ShaderInterface::Slot& slot : slots_) {
        if (!bindings.empty() && bindings.back().binding == slot.binding)
            return Failure(name_, "binding " + std::to_string(slot.binding) + " has two types");
        bindings.push_back({slot.binding, slot.type, 1, stages_, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    set.bindingCount = uint32_t(bindings.size());
    set.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &setLayout)))
        return gpuFailure(device, name_, "making its set layout");
    setLayout_ = Owned(device, setLayout);
    const VkPushConstantRange range{stages_, 0, (pushBytes_ + 3) / 4 * 4};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &setLayout;
    info.pushConstantRangeCount = pushBytes_ ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout)))
        return gpuFailure(device, name_, "making its layout");
    layout_ = Owned(device, layout);
    device.setName(VK_OBJECT_TYPE_PIPELINE_LAYOUT, uint64_t(layout), name_);
    return Done{};
}

Result<Program> Program::compute(Device& device, std::string_view shader, const ProgramOptions& options) {
    Result<LoadedModule> module = LoadedModule::create(device, shader, builtIn(shader), options);
    if (!module) return module.failure();
    require(module->shape.stage == VK_SHADER_STAGE_COMPUTE_BIT, std::string(shader) + " is not a compute shader");
    Program p;
    p.name_ = shader;
    p.localSize_ = module->shape.localSize;
    if (Status status = p.makeLayout(device, {&module->shape, 1}); !status) return status.failure();
    const Specialization constants(options.constants);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = module->stage(constants.info);
    info.layout = p.layout();
    VkPipeline pipeline = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateComputePipelines(device.handle(), device.pipelineCache(), 1, &info,
                                                               nullptr, &pipeline)))
        return gpuFailure(device, shader, "making its pipeline");
    p.pipeline_ = Owned(device, pipeline);
    device.setName(VK_OBJECT_TYPE_PIPELINE, uint64_t(pipeline), shader);
    return p;
}

Result<Program> Program::graphics(Device& device, const GraphicsDesc& desc) {
    const Specialization constants(desc.options.constants);
    std::vector<LoadedModule> modules;
    std::vector<ShaderInterface> shapes;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (std::string_view shader : {desc.vertex, desc.fragment}) {
        if (shader.empty() && !modules.empty()) continue;  // depth only
        Result<LoadedModule> module = LoadedModule::create(device, shader, builtIn(shader), desc.options);
        if (!module) return module.failure();
        modules.push_back(std::move(*module));
        shapes.push_back(modules.back().shape);
    }
    for (const LoadedModule& module : modules) stages.push_back(module.stage(constants.info));
    Program p;
    p.name_ = desc.name;
    if (Status status = p.makeLayout(device, shapes); !status) return status.failure();

    const FixedFunctions fixed(desc);
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    if (desc.renderPass == VK_NULL_HANDLE) info.pNext = &fixed.rendering;
    info.renderPass = desc.renderPass;
    info.subpass = desc.subpass;
    info.stageCount = uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &fixed.vertexInput;
    info.pInputAssemblyState = &fixed.assembly;
    info.pViewportState = &fixed.viewport;
    info.pRasterizationState = &fixed.raster;
    info.pMultisampleState = &fixed.multisample;
    info.pDepthStencilState = &fixed.depth;
    info.pColorBlendState = &fixed.blend;
    info.pDynamicState = &fixed.dynamic;
    info.layout = p.layout();
    VkPipeline pipeline = VK_NULL_HANDLE;
    if (!device.succeeded(device.vk().vkCreateGraphicsPipelines(device.handle(), device.pipelineCache(), 1, &info,
                                                                nullptr, &pipeline)))
        return gpuFailure(device, desc.name, "making its pipeline");
    p.pipeline_ = Owned(device, pipeline);
    device.setName(VK_OBJECT_TYPE_PIPELINE, uint64_t(pipeline), desc.name);
    return p;
}

Status makeCompute(Device& device, std::initializer_list<ComputeDesc> kernels) {
    for (const ComputeDesc& kernel : kernels) {
        Result<Program> made = Program::compute(device, kernel.shader, kernel.options);
        if (!made) return made.failure();
        if (kernel.groupItems != 0)
            requireEqual(made->localSize()[0], kernel.groupItems, std::string("local size of ") + kernel.shader);
        kernel.program = std::move(*made);
    }
    return Done{};
}

}  // namespace espalier
