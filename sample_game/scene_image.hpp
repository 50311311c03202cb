#pragma once

#include <string>

#include "plugin_api/espalier.h"
#include "plugin_api/espalier.hpp"
#include "sample_game/host_image.hpp"
#include "sample_game/picture_blend.hpp"
#include "sample_game/refinement.hpp"

namespace sample {

// The picture of the scene, kept between frames: while only the panels change, it is copied into the window instead of
// being drawn anew, which on a software device is the difference between a sluggish panel and one that isn't felt.
// While the camera moves it may be drawn smaller and is enlarged; when the camera stops the picture fades over into the
// whole one, and while nothing changes at all that is refined (refinement.hpp). What the panel at the left covers isn't
// drawn.
class SceneImage {
  public:
    explicit SceneImage(const VulkanHost& host)
        : host_(host), image_(host), mean_(host), before_(host), average_(host), fade_(host) {}

    // Pixels of the window's width and height that the picture leaves out, less than all; what they hold is undefined.
    struct Margins {
        uint32_t left = 0, below = 0;
    };
    // What of a frame's picture the window asks for.
    struct Wish {
        Margins margins;
        float scale = 1;       // of the sides, above 0, up to 1
        bool redraw = false;   // else what was drawn last is shown, if that had this size
        bool coarse = false;   // of what moves
        bool fades = false;    // a whole one may take over from a coarse one little by little
        bool refines = false;  // there is time to draw another one that makes it smoother, where redraw is false
        double now = 0;        // seconds
    };
    // Records into the frame. draw: what to look at; its size, image and frame are filled in. Leaves the window's image
    // in COLOR_ATTACHMENT_OPTIMAL.
    bool show(EspContext* context, const Frame& frame, esp::DrawDef draw, const Wish& wish);
    // Likewise, without the context: what was drawn last; black if that isn't of this size.
    void showAgain(const Frame& frame, Margins margins);
    const std::string& error() const { return error_; }
    // Whether what was shown last was drawn for it, as the scene is, not to make it smoother.
    bool drew() const { return drew_; }
    // There is something to be had of another frame: at once, and of one when there is time.
    bool fading(double now) const { return refinement_.before(now) > 0; }
    bool refinable() const { return refinement_.due(); }

  private:
    static VkExtent2D roomOf(const Frame& frame, Margins margins) {
        return {frame.extent.width - margins.left, frame.extent.height - margins.below};
    }
    bool fits(const Frame& frame, Margins margins) const {
        const VkExtent2D room = roomOf(frame, margins);
        return shown_.width == room.width && shown_.height == room.height && drawn_.width > 0;
    }
    bool fail(const std::string& message);
    bool draw(EspContext* context, const Frame& frame, esp::DrawDef draw);
    bool drawAnew(EspContext* context, const Frame& frame, const esp::DrawDef& draw, const Wish& wish);
    bool refine(EspContext* context, const Frame& frame, const esp::DrawDef& draw);
    bool keepBefore(const Frame& frame);
    void average(const Frame& frame, float share);
    void copy(const Frame& frame, Margins margins) const;
    void layBefore(const Frame& frame, Margins margins, float share);

    const VulkanHost& host_;
    std::string error_;
    HostImage image_;              // the latest picture, in its corner; in TRANSFER_SRC_OPTIMAL
    HostImage mean_;               // of several pictures, likewise
    HostImage before_;             // the latest coarse one as the window showed it; in SHADER_READ_ONLY_OPTIMAL
    PictureBlend average_, fade_;  // into mean_, into the window
    Refinement refinement_;
    VkExtent2D drawn_{}, shown_{};  // the picture, and what of the window it fills
    bool drew_ = false;
};

}  // namespace sample
