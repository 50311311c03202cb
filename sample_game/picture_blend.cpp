// A picture and a share in, a triangle over the viewport out, which the blend unit mixes with what is there.
#include "sample_game/picture_blend.hpp"

namespace sample {
namespace {

const uint32_t kWholeCode[] = {
#include "whole.vert.inc"
};
const uint32_t kLaidCode[] = {
#include "laid.frag.inc"
};

VkPipelineShaderStageCreateInfo stageOf(VkDevice device, VkShaderStageFlagBits stage, const uint32_t* code,
                                        size_t sizeBytes) {
    VkShaderModuleCreateInfo module{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    module.codeSize = sizeBytes;
    module.pCode = code;
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.pName = "main";
    vkCreateShaderModule(device, &module, nullptr, &info.module);
    return info;
}

}  // namespace

bool PictureBlend::check(VkResult result, const char* what) {
    if (result == VK_SUCCESS) return true;
    error_ =
        std::string("blending pictures: making a ") + what + " failed (VkResult " + std::to_string(int(result)) + ")";
    return false;
}

bool PictureBlend::makeLayouts() {
    const VkDevice device = host_.device();
    VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (!check(vkCreateSampler(device, &sampler, nullptr, &sampler_), "sampler")) return false;
    const VkDescriptorSetLayoutBinding picture{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1,
                                               VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    set.bindingCount = 1;
    set.pBindings = &picture;
    if (!check(vkCreateDescriptorSetLayout(device, &set, nullptr, &setLayout_), "layout")) return false;
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &setLayout_;
    return check(vkCreatePipelineLayout(device, &layout, nullptr, &layout_), "layout");
}

bool PictureBlend::create(VkFormat format) {
    if (!makeLayouts()) return false;
    const VkPipelineShaderStageCreateInfo stages[2] = {
        stageOf(host_.device(), VK_SHADER_STAGE_VERTEX_BIT, kWholeCode, sizeof kWholeCode),
        stageOf(host_.device(), VK_SHADER_STAGE_FRAGMENT_BIT, kLaidCode, sizeof kLaidCode)};
    const VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState mix{};
    mix.blendEnable = VK_TRUE;
    mix.srcColorBlendFactor = mix.srcAlphaBlendFactor = VK_BLEND_FACTOR_CONSTANT_ALPHA;
    mix.dstColorBlendFactor = mix.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_CONSTANT_ALPHA;
    mix.colorWriteMask = 0xF;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &mix;
    const VkDynamicState dynamics[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                       VK_DYNAMIC_STATE_BLEND_CONSTANTS};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 3;
    dynamic.pDynamicStates = dynamics;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &format;
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &rendering;
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = layout_;
    const bool good =
        check(vkCreateGraphicsPipelines(host_.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_), "pipeline");
    for (const auto& stage : stages) vkDestroyShaderModule(host_.device(), stage.module, nullptr);
    return good;
}

void PictureBlend::lay(VkCommandBuffer commands, const HostImage& from, VkImageView onto, const VkRect2D& where,
                       float share) const {
    VkRenderingAttachmentInfo colour{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    colour.imageView = onto;
    colour.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    colour.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea = where;
    rendering.layerCount = rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &colour;
    vkCmdBeginRendering(commands, &rendering);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    const VkDescriptorImageInfo image{sampler_, from.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkCmdPushDescriptorSetKHR(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &write);
    const VkViewport viewport{
        float(where.offset.x), float(where.offset.y), float(where.extent.width), float(where.extent.height), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &where);
    const float constants[4] = {share, share, share, share};
    vkCmdSetBlendConstants(commands, constants);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRendering(commands);
}

PictureBlend::~PictureBlend() {
    if (!host_.device()) return;
    host_.waitIdle();
    vkDestroyPipeline(host_.device(), pipeline_, nullptr);
    vkDestroyPipelineLayout(host_.device(), layout_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device(), setLayout_, nullptr);
    vkDestroySampler(host_.device(), sampler_, nullptr);
}

}  // namespace sample
