#pragma once

// The stage's ground: a level meadow that reaches the horizon, for pictures of a thing that would float otherwise.
// Nothing grows on it.

#include <vector>

#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/image.hpp"
#include "runtime/render/shading.hpp"

namespace espalier {

// A meadow to the horizon, or a studio's floor: a soft disc around all models, which goes over into the sky.
enum class GroundKind : uint32_t { none = 0, meadow = 1, studio = 2 };

struct GroundLook {
    GroundKind kind = GroundKind::none;
    float height = 0;                          // world, metres
    glm::vec3 colour{0.085f, 0.105f, 0.045f};  // of a meadow's grass, linear
    bool overgrows = true;                     // a meadow: what of models lies almost as low
};

// What lies on the meadow of a site, seen from above: 8-bit RGBA, the first row at low.y (world z). Red: 0.5 at a
// street's edge, 1 a metre inside, 0 a metre outside; green: trodden earth; blue: share of the sky that is
// seen.
struct SiteMap {
    uint32_t width = 0, height = 0;
    std::vector<uint8_t> rgba;
    glm::vec2 low{0}, high{0};  // world x and z, metres
};

class Ground {
  public:
    // Formats and samples of the images that it draws into. Uploads a tile of noise and waits.
    static Result<Ground> create(Device& device, VkFormat color, VkFormat depth, uint32_t samples);

    // Without texels: none. Uploads and waits.
    Status setSite(Device& device, const SiteMap& map);
    // Sets FrameRecord::siteLow and siteRcp.
    void describe(FrameRecord& frame) const;

    // In FrameRecord::groundLevel; what is nearer hides it.
    void draw(DrawPass& pass, const PostPush& push, const Buffer& frame, const Image& shadowMap,
              const Sampler& shadowSampler, Shading shading) const;

    // Four octave sums of noise that repeat at the border: see ground.frag.
    // quick: with samplers that take the nearer of two mips.
    Binding noiseBinding(bool quick = false) const { return {noise_, samplers_[quick]}; }
    // Crests of hills around the horizon.
    Binding skylineBinding() const { return {skyline_, samplers_[1]}; }
    Binding siteBinding(bool quick = false) const { return {site_ ? site_ : noise_, siteSamplers_[quick]}; }
    // A tile of setts: brightness, stone or joint, slopes.
    Binding pavingBinding(bool quick = false) const { return {paving_ ? paving_ : noise_, samplers_[quick]}; }

  private:
    Program programs_[kShadings];
    Image noise_, skyline_;
    Image site_, paving_;                    // empty: there is no map
    Sampler samplers_[2], siteSamplers_[2];  // blending mips or not
    glm::vec2 siteLow_{0}, siteRcp_{0};
};

}  // namespace espalier
