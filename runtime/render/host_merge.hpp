#pragma once

#include <map>

#include "runtime/gpu/commands.hpp"
#include "runtime/render/draw_data.hpp"
#include "runtime/render/targets.hpp"
#include "shaders/render/host_records.h"

namespace espalier {

// Draws into a picture that a host has begun. Its colours and depths are laid under the scene, which so is culled,
// shaded at its edges and hidden as if it were all one; then only pixels that growth has changed go back into the
// host's images. Stays the same between frames of one size and format.
class HostMerge {
  public:
    static Result<std::unique_ptr<HostMerge>> create(Device& device, uint32_t samples);

    // Before the scene is drawn: fills targets.color and targets.depth, leaves both as targets.
    Status begin(Commands& commands, const DrawTarget& target, Targets& targets, const Buffer& frame, float nearPlane);
    // After it was resolved into targets.own, with targets.depth in `sampled`.
    Status end(Commands& commands, Targets& targets);

  private:
    explicit HostMerge(Device& device) : device_(device) {}
    Status makeImages(uint32_t width, uint32_t height);
    Result<const Program*> output(const char* fragment, VkFormat color, VkFormat depth);

    Device& device_;
    Program near_, begin_, grown_;
    std::map<std::pair<VkFormat, VkFormat>, Program> outputs_;  // by the formats of colour and depth, one of them none
    Sampler sampler_;
    Image hostNear_, grownNear_;   // depths as ours: the host's; growth where it is nearer, else 0
    Image hostColor_, hostDepth_;  // of this recording
    HostPush push_{};
};

}  // namespace espalier
