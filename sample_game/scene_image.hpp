#pragma once

#include <string>

#include "plugin_api/espalier.h"
#include "plugin_api/espalier.hpp"
#include "sample_game/host_image.hpp"

namespace sample {

// The picture of the scene, kept between frames: while only the panels change, it is copied into the window instead of
// being drawn anew, which on a software device is the difference between a sluggish panel and one that isn't felt.
// While the camera moves it may be drawn smaller and is enlarged. What the panel at the left covers isn't drawn.
class SceneImage {
  public:
    explicit SceneImage(const VulkanHost& host) : host_(host), image_(host) {}

    // Records into the frame. draw: what to look at; its size, image and frame are filled in. left: pixels of the
    // window's width that the picture leaves out, less than all; what they hold is undefined. scale: of the sides,
    // above 0, up to 1. redraw: false shows what was drawn last, if that had this size. Leaves the window's image in
    // COLOR_ATTACHMENT_OPTIMAL.
    bool show(EspContext* context, const Frame& frame, esp::DrawDef draw, uint32_t left, float scale, bool redraw);
    // Likewise, without the context: what was drawn last; black if that isn't of this size.
    void showAgain(const Frame& frame, uint32_t left);
    const std::string& error() const { return error_; }
    // Whether what was shown last was drawn for it.
    bool drew() const { return drew_; }

  private:
    bool fits(const Frame& frame, uint32_t left) const {
        return shown_.width == frame.extent.width - left && shown_.height == frame.extent.height && drawn_.width > 0;
    }
    void copy(const Frame& frame, uint32_t left) const;

    const VulkanHost& host_;
    std::string error_;
    HostImage image_;
    VkExtent2D drawn_{}, shown_{};  // the picture, and what of the window it fills
    bool drew_ = false;
};

}  // namespace sample
