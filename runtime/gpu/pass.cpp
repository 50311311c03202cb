// Dispatches and draws: binding, push data and descriptors from what the program's SPIR-V says.
#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/core/check.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/timer.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMaxGroups = 65535;  // a dimension, on every device

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, bool clear, bool store) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = view;
    info.imageLayout = layout;
    info.loadOp = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
    info.storeOp = store ? VK_ATTACHMENT_STORE_OP_STORE : VK_ATTACHMENT_STORE_OP_DONT_CARE;
    return info;
}

void beginRendering(const DeviceFunctions& vk, VkCommandBuffer commands, const DrawTargets& targets) {
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const ColorTarget& target : targets.colors) {
        VkRenderingAttachmentInfo& info = colors.emplace_back(
            attachment(target.view, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, target.clear.has_value(), true));
        if (target.clear) std::ranges::copy(*target.clear, info.clearValue.color.float32);
    }
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea.extent = targets.extent;
    info.layerCount = 1;
    info.colorAttachmentCount = uint32_t(colors.size());
    info.pColorAttachments = colors.data();
    VkRenderingAttachmentInfo depth{};
    if (targets.depth) {
        depth = attachment(targets.depth->view, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                           targets.depth->clear.has_value(), targets.depth->store);
        depth.clearValue.depthStencil.depth = targets.depth->clear.value_or(0);
        info.pDepthAttachment = &depth;
    }
    vk.vkCmdBeginRendering(commands, &info);
}

}  // namespace

Pass::Pass(Commands& commands, std::string_view name, bool timed)
    : commands_(commands), vk_(commands.device().vk()), cmd_(commands.handle()) {
    if (vk_.vkCmdBeginDebugUtilsLabelEXT) {
        const std::string text(name);
        VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = text.c_str();
        vk_.vkCmdBeginDebugUtilsLabelEXT(cmd_, &label);
    }
    if (timed && !commands.within())
        timer_ = commands.device().timers().start(cmd_, commands.serial(), name, commands.hosted());
}

Pass::~Pass() {
    if (timer_) commands_.device().timers().stop(cmd_, *timer_);
    if (vk_.vkCmdEndDebugUtilsLabelEXT) vk_.vkCmdEndDebugUtilsLabelEXT(cmd_);
}

void Pass::bind(const Program& program, const Push& push, Bindings bindings) {
    vk_.vkCmdBindPipeline(cmd_, program.isCompute() ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS,
                          program.pipeline());
    // The struct's tail padding may make it longer than the shader's block.
    const uint32_t bytes = (program.pushBytes() + 3) / 4 * 4;
    if (push.size < bytes || push.size >= bytes + 8) requireEqual(push.size, bytes, "push bytes of " + program.name());
    if (bytes) vk_.vkCmdPushConstants(cmd_, program.layout(), program.stages(), 0, bytes, push.data);

    requireEqual(bindings.size(), program.slots().size(), "bindings of " + program.name());
    constexpr size_t kMaxBindings = 16;
    requireEqual(bindings.size() <= kMaxBindings, true, "few enough bindings");
    std::array<VkWriteDescriptorSet, kMaxBindings> writes;
    std::array<VkDescriptorImageInfo, kMaxBindings> images;
    std::array<VkDescriptorBufferInfo, kMaxBindings> buffers;
    for (size_t i = 0; i < bindings.size(); ++i) {
        const Binding& given = bindings[i];
        const ShaderInterface::Slot& slot = program.slots()[i];
        const bool storage = slot.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        images[i] = {given.sampler, given.view,
                     storage ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
        buffers[i] = {given.buffer, 0, VK_WHOLE_SIZE};
        const bool wantsBuffer =
            slot.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || slot.type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
        requireEqual(given.buffer != VK_NULL_HANDLE, wantsBuffer, "a buffer is bound where it belongs");
        requireEqual(given.texels != VK_NULL_HANDLE, slot.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                     "a texel view is bound where it belongs");
        writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
        writes[i].dstBinding = slot.binding;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType = slot.type;
        writes[i].pImageInfo = &images[i];
        writes[i].pBufferInfo = &buffers[i];
        writes[i].pTexelBufferView = &given.texels;
    }
    if (bindings.size())
        vk_.vkCmdPushDescriptorSetKHR(
            cmd_, program.isCompute() ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS,
            program.layout(), 0, uint32_t(bindings.size()), writes.data());
}

void Pass::dispatch(const Program& program, std::array<uint32_t, 3> groups, Push push, Bindings bindings) {
    if (groups[0] == 0 || groups[1] == 0 || groups[2] == 0) return;
    require(std::ranges::max(groups) <= kMaxGroups, "too many groups for " + program.name());
    bind(program, push, bindings);
    vk_.vkCmdDispatch(cmd_, groups[0], groups[1], groups[2]);
}

void Pass::dispatchItems(const Program& program, uint32_t items, Push push, Bindings bindings) {
    const uint32_t size = program.localSize()[0];
    const uint32_t groups = items / size + (items % size != 0);
    const uint32_t rows = groups / kMaxGroups + (groups % kMaxGroups != 0);
    dispatch(program, {rows > 1 ? kMaxGroups : groups, std::max(rows, 1u), 1}, push, bindings);
}

void Pass::dispatchIndirect(const Program& program, const Buffer& arguments, uint64_t offset, Push push,
                            Bindings bindings) {
    bind(program, push, bindings);
    vk_.vkCmdDispatchIndirect(cmd_, arguments.handle(), offset);
}

DrawPass::DrawPass(Commands& commands, std::string_view name, const DrawTargets& targets)
    : Pass(commands, name), begun_(true) {
    beginRendering(vk_, cmd_, targets);
    setViewport({0, 0, float(targets.extent.width), float(targets.extent.height), 0, 1});
    setScissor(0, 0, targets.extent.width, targets.extent.height);
    drawBacks(true);
    mirror(false);
}

DrawPass::DrawPass(Commands& commands, std::string_view name, const VkViewport& viewport)
    : Pass(commands, name, false) {
    setViewport(viewport);
    const float top = std::min(viewport.y, viewport.y + viewport.height);
    setScissor(int32_t(viewport.x), int32_t(top), uint32_t(viewport.width), uint32_t(std::abs(viewport.height)));
    drawBacks(true);
    mirror(false);
}

DrawPass::~DrawPass() {
    if (begun_) vk_.vkCmdEndRendering(cmd_);
}

void DrawPass::drawBacks(bool drawn) {
    vk_.vkCmdSetCullMode(cmd_, drawn ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
}

void DrawPass::mirror(bool mirrored) {
    mirrored_ = mirrored;
    mirrorPlaced(false);
}

void DrawPass::mirrorPlaced(bool mirrored) {
    const bool turned = mirrored != mirrored_;
    vk_.vkCmdSetFrontFace(cmd_, turned ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
}

void DrawPass::setScissor(int32_t x, int32_t y, uint32_t width, uint32_t height) {
    const VkRect2D scissor{{x, y}, {width, height}};
    vk_.vkCmdSetScissor(cmd_, 0, 1, &scissor);
}

void DrawPass::setViewport(const VkViewport& viewport) {
    vk_.vkCmdSetViewport(cmd_, 0, 1, &viewport);
}

void DrawPass::setVertices(const Buffer& vertices, uint64_t offset) {
    const VkBuffer handle = vertices.handle();
    vk_.vkCmdBindVertexBuffers(cmd_, 0, 1, &handle, &offset);
}

void DrawPass::setIndices(const Buffer& indices, VkIndexType type, uint64_t offset) {
    vk_.vkCmdBindIndexBuffer(cmd_, indices.handle(), offset, type);
}

void DrawPass::draw(const Program& program, uint32_t vertices, uint32_t instances, Push push, Bindings bindings) {
    if (vertices == 0 || instances == 0) return;
    bind(program, push, bindings);
    vk_.vkCmdDraw(cmd_, vertices, instances, 0, 0);
}

void DrawPass::drawIndexed(const Program& program, const IndexRange& range, Push push, Bindings bindings) {
    if (range.indices == 0 || range.instances == 0) return;
    bind(program, push, bindings);
    vk_.vkCmdDrawIndexed(cmd_, range.indices, range.instances, range.firstIndex, range.vertexOffset, 0);
}

void DrawPass::drawIndirect(const Program& program, const Buffer& arguments, uint64_t offset, uint32_t count, Push push,
                            Bindings bindings) {
    if (count == 0) return;
    bind(program, push, bindings);
    vk_.vkCmdDrawIndirect(cmd_, arguments.handle(), offset, count, sizeof(VkDrawIndirectCommand));
}

void DrawPass::drawIndexedIndirect(const Program& program, const Buffer& arguments, uint64_t offset, uint32_t count,
                                   Push push, Bindings bindings) {
    if (count == 0) return;
    bind(program, push, bindings);
    vk_.vkCmdDrawIndexedIndirect(cmd_, arguments.handle(), offset, count, sizeof(VkDrawIndexedIndirectCommand));
}

}  // namespace espalier
