#pragma once

// The stage's ground: a level meadow that reaches the horizon, for pictures of a thing that would float otherwise.
// Nothing grows on it.

#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/image.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

struct GroundLook {
    bool drawn = false;
    float height = 0;                          // world, metres
    glm::vec3 colour{0.085f, 0.105f, 0.045f};  // of its grass, linear
};

class Ground {
  public:
    // Formats and samples of the images that it draws into. Uploads a tile of noise and waits.
    static Result<Ground> create(Device& device, VkFormat color, VkFormat depth, uint32_t samples);

    // In FrameRecord::groundLevel; what is nearer hides it.
    void draw(DrawPass& pass, const PostPush& push, const Buffer& frame, const Image& shadowMap,
              const Sampler& shadowSampler, bool explains) const;

    // Four octave sums of noise that repeat at the border: see ground.frag.
    const Image& noise() const { return noise_; }
    const Sampler& sampler() const { return sampler_; }

  private:
    Program programs_[2];  // of the shaded view, of others
    Image noise_;
    Sampler sampler_;
};

}  // namespace espalier
