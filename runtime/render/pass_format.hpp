#pragma once

// How a pass was begun, and what it holds: pipelines are made for one.

#include <compare>
#include <vector>

#include "runtime/gpu/program.hpp"
#include "runtime/render/targets.hpp"
#include "shaders/shared/constants.h"

namespace espalier {

struct PassFormat {
    std::vector<VkFormat> colors;  // the first is drawn into; none: depths only
    VkFormat depth = kDepthFormat, stencil = VK_FORMAT_UNDEFINED;
    uint32_t samples = 1;
    bool reversed = true;  // nearer is more
    uint32_t output = kOutputStored;
    bool windy = false;  // leaves bend in the wind
    float biasConstant = 0, biasSlope = 0;
    VkRenderPass renderPass = VK_NULL_HANDLE;  // null: dynamic rendering
    uint32_t subpass = 0;

    auto operator<=>(const PassFormat&) const = default;
};

// The scene's own, and that of its map of shadows.
inline PassFormat scenePass(uint32_t samples) {
    return {.colors = {kSceneFormat}, .samples = samples};
}
inline PassFormat shadowPass() {
    return {.colors = {}, .reversed = false, .biasConstant = 2, .biasSlope = 1.8f};
}

// A program for such a pass. constants: besides what the pass says itself.
inline GraphicsDesc inPass(const PassFormat& pass, const char* name, const char* vertex, const char* fragment,
                           std::vector<SpecConstant> constants) {
    GraphicsDesc desc;
    desc.name = name;
    desc.vertex = vertex;
    desc.fragment = fragment;
    desc.colors = pass.colors;
    desc.depth = pass.depth;
    desc.stencil = pass.stencil;
    desc.samples = pass.samples;
    desc.renderPass = pass.renderPass;
    desc.subpass = pass.subpass;
    desc.depthCompare = pass.reversed ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL;
    desc.depthBiasConstant = pass.biasConstant;
    desc.depthBiasSlope = pass.biasSlope;
    desc.options.constants = std::move(constants);
    desc.options.constants.push_back({kConstantOutput, pass.output});
    desc.options.constants.push_back({kConstantWindy, pass.windy ? 1u : 0u});
    return desc;
}

}  // namespace espalier
