// ImDrawData in, draw calls into a frame out. Vertices and indices go to mapped buffers, one pair a frame in flight;
// pictures are the font atlas and what panels show. Colours stay in sRGB, as the window's UNORM format wants them.
#include "sample_game/ui_renderer.hpp"

#include <imgui.h>

#include <algorithm>
#include <cstddef>

namespace sample {
namespace {

const uint32_t kVertexCode[] = {
#include "ui.vert.inc"
};
const uint32_t kFragmentCode[] = {
#include "ui.frag.inc"
};

struct Push {
    float scale[2], offset[2];
};

VkShaderModule makeModule(VkDevice device, const uint32_t* code, size_t sizeBytes) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = sizeBytes;
    info.pCode = code;
    VkShaderModule module = VK_NULL_HANDLE;
    vkCreateShaderModule(device, &info, nullptr, &module);
    return module;
}

}  // namespace

bool UiRenderer::fail(const std::string& message) {
    error_ = "the panel: " + message;
    return false;
}

bool UiRenderer::check(VkResult result, const char* what) {
    return result == VK_SUCCESS || fail(std::string(what) + " failed (VkResult " + std::to_string(int(result)) + ")");
}

bool UiRenderer::create() {
    ImGui::GetIO().BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;  // large canvases need it
    return makePipeline() && updateFonts();
}

bool UiRenderer::makePipeline() {
    const VkDevice device = host_.device();
    VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
    sampler.addressModeU = sampler.addressModeV = sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (!check(vkCreateSampler(device, &sampler, nullptr, &sampler_), "making a sampler")) return false;
    VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT,
                                         nullptr};
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
    set.bindingCount = 1;
    set.pBindings = &binding;
    if (!check(vkCreateDescriptorSetLayout(device, &set, nullptr, &setLayout_), "making a layout")) return false;
    VkPushConstantRange range{VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof(Push)};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.setLayoutCount = layout.pushConstantRangeCount = 1;
    layout.pSetLayouts = &setLayout_;
    layout.pPushConstantRanges = &range;
    if (!check(vkCreatePipelineLayout(device, &layout, nullptr, &layout_), "making a layout")) return false;

    VkPipelineShaderStageCreateInfo stages[2] = {{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO},
                                                 {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO}};
    stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
    stages[0].module = makeModule(device, kVertexCode, sizeof kVertexCode);
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = makeModule(device, kFragmentCode, sizeof kFragmentCode);
    stages[0].pName = stages[1].pName = "main";
    const VkVertexInputBindingDescription buffer{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX};
    const VkVertexInputAttributeDescription attributes[3] = {
        {0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
        {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
        {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}};
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &buffer;
    input.vertexAttributeDescriptionCount = 3;
    input.pVertexAttributeDescriptions = attributes;
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = VK_CULL_MODE_NONE;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineColorBlendAttachmentState over{};
    over.blendEnable = VK_TRUE;
    over.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    over.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    over.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    over.colorWriteMask = 0xF;
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = 1;
    blend.pAttachments = &over;
    const VkDynamicState dynamics[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamics;
    const VkFormat format = host_.format();
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
    const bool made =
        check(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_), "making a pipeline");
    vkDestroyShaderModule(device, stages[0].module, nullptr);
    vkDestroyShaderModule(device, stages[1].module, nullptr);
    return made;
}

bool UiRenderer::updateFonts() {
    unsigned char* rgba = nullptr;
    int width = 0, height = 0;
    ImGui::GetIO().Fonts->GetTexDataAsRGBA32(&rgba, &width, &height);
    ImGui::GetIO().Fonts->SetTexID(&fonts_);
    return fonts_.show(rgba, uint32_t(width), uint32_t(height)) || fail(fonts_.error());
}

bool UiRenderer::draw(const Frame& frame, const ImDrawData& lists) {
    if (lists.TotalVtxCount == 0 || lists.DisplaySize.x <= 0 || lists.DisplaySize.y <= 0) return true;
    MappedBuffer& vertices = vertices_[frame.slot];
    MappedBuffer& indices = indices_[frame.slot];
    if (!vertices.reserve(VkDeviceSize(lists.TotalVtxCount) * sizeof(ImDrawVert), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT))
        return check(vertices.result(), "making room for vertices");
    if (!indices.reserve(VkDeviceSize(lists.TotalIdxCount) * sizeof(ImDrawIdx), VK_BUFFER_USAGE_INDEX_BUFFER_BIT))
        return check(indices.result(), "making room for indices");
    auto* vertex = static_cast<ImDrawVert*>(vertices.bytes());
    auto* index = static_cast<ImDrawIdx*>(indices.bytes());
    for (int i = 0; i < lists.CmdListsCount; ++i) {
        const ImDrawList& list = *lists.CmdLists[i];
        vertex = std::copy(list.VtxBuffer.begin(), list.VtxBuffer.end(), vertex);
        index = std::copy(list.IdxBuffer.begin(), list.IdxBuffer.end(), index);
    }
    record(frame, lists);
    return true;
}

void UiRenderer::record(const Frame& frame, const ImDrawData& lists) {
    const VkCommandBuffer commands = frame.commands;
    // After what the plugin has drawn.
    VkMemoryBarrier2 after{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    after.srcStageMask = after.dstStageMask = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
    after.srcAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    after.dstAccessMask = VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &after;
    vkCmdPipelineBarrier2(commands, &dependency);
    VkRenderingAttachmentInfo colour{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    colour.imageView = frame.view;
    colour.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    colour.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = frame.extent;
    rendering.layerCount = rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &colour;
    vkCmdBeginRendering(commands, &rendering);

    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
    const VkDeviceSize zero = 0;
    const VkBuffer vertices = vertices_[frame.slot].buffer();
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
    vkCmdBindIndexBuffer(commands, indices_[frame.slot].buffer(), 0,
                         sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    const VkViewport viewport{0, 0, float(frame.extent.width), float(frame.extent.height), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    Push push;
    push.scale[0] = 2 / lists.DisplaySize.x;
    push.scale[1] = 2 / lists.DisplaySize.y;
    push.offset[0] = -1 - lists.DisplayPos.x * push.scale[0];
    push.offset[1] = -1 - lists.DisplayPos.y * push.scale[1];
    vkCmdPushConstants(commands, layout_, VK_SHADER_STAGE_VERTEX_BIT, 0, sizeof push, &push);

    int firstVertex = 0;
    uint32_t firstIndex = 0;
    const float toX = lists.FramebufferScale.x, toY = lists.FramebufferScale.y;
    ImTextureID bound = nullptr;
    for (int i = 0; i < lists.CmdListsCount; ++i) {
        const ImDrawList& list = *lists.CmdLists[i];
        for (const ImDrawCmd& draw : list.CmdBuffer) {
            if (draw.UserCallback) continue;  // none of our widgets has one
            const float x0 = std::max(0.f, (draw.ClipRect.x - lists.DisplayPos.x) * toX);
            const float y0 = std::max(0.f, (draw.ClipRect.y - lists.DisplayPos.y) * toY);
            const float x1 = std::min(float(frame.extent.width), (draw.ClipRect.z - lists.DisplayPos.x) * toX);
            const float y1 = std::min(float(frame.extent.height), (draw.ClipRect.w - lists.DisplayPos.y) * toY);
            if (x1 <= x0 || y1 <= y0) continue;
            if (draw.TextureId != bound) bind(commands, *static_cast<const HostImage*>(bound = draw.TextureId));
            const VkRect2D scissor{{int32_t(x0), int32_t(y0)}, {uint32_t(x1 - x0), uint32_t(y1 - y0)}};
            vkCmdSetScissor(commands, 0, 1, &scissor);
            vkCmdDrawIndexed(commands, draw.ElemCount, 1, firstIndex + draw.IdxOffset,
                             firstVertex + int32_t(draw.VtxOffset), 0);
        }
        firstVertex += list.VtxBuffer.Size;
        firstIndex += uint32_t(list.IdxBuffer.Size);
    }
    vkCmdEndRendering(commands);
}

void UiRenderer::bind(VkCommandBuffer commands, const HostImage& picture) {
    const VkDescriptorImageInfo image{sampler_, picture.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    vkCmdPushDescriptorSetKHR(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, 1, &write);
}

UiRenderer::~UiRenderer() {
    if (!host_.device()) return;
    host_.waitIdle();
    vkDestroyPipeline(host_.device(), pipeline_, nullptr);
    vkDestroyPipelineLayout(host_.device(), layout_, nullptr);
    vkDestroyDescriptorSetLayout(host_.device(), setLayout_, nullptr);
    vkDestroySampler(host_.device(), sampler_, nullptr);
}

}  // namespace sample
