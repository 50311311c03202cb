#pragma once

// How coarsely growth is drawn while the camera moves, or a stroke goes on, on a device that is slow: what counts then
// is that the picture follows the hand.

#include <algorithm>
#include <cstdint>

#include "plugin_api/espalier.h"

namespace espalier::scene {

class MovingDetail {
  public:
    static constexpr float kLod = 4;  // times the errors that are allowed otherwise
    static constexpr double kFrameMs = 1e3 / 15;
    static constexpr uint32_t kLeaves = 20'000;  // in view: more aren't given up for speed

    // Times the pixels from which on all leaves are drawn: fewer and larger leaves, and fewer twigs.
    float leaf() const { return leaf_; }

    // Makes a picture as coarse as that.
    void apply(EspLook& look) const {
        look.windowLodPixels *= kLod;
        look.leafPixels *= leaf_;
        look.quick = 1;
    }

    // After each such frame: its time, and the leaves that it drew. Steps are small, so that nothing pops.
    void follow(double frameMs, uint32_t leaves) {
        if (leaves < kLeaves || frameMs < 0.7 * kFrameMs)
            leaf_ = std::max(1.0f, leaf_ * 0.95f);
        else if (frameMs > kFrameMs && leaves > kLeaves + kLeaves / 5)
            leaf_ = std::min(4.0f, leaf_ * 1.08f);
    }

  private:
    float leaf_ = 1.5f;
};

// What a window asks for in each frame; it draws as it is told.
class MovingPicture {
  public:
    static constexpr double kSlowDrawMs = 40;  // a device that takes longer over a whole picture is slow

    // Before a frame: moving: the camera does, or a stroke goes on; drawMs: what the last picture took; half: such
    // pictures may be smaller. Makes `draw` coarser if need be; returns the share of the window's width to draw.
    float prepare(EspDrawDef& draw, bool moving, double drawMs, bool half) {
        hurried_ = moving && (coarse_ || drawMs > kSlowDrawMs);
        if (!hurried_) return 1;
        detail_.apply(draw.look);
        return half ? 0.5f : 1.0f;
    }

    // After it, if it was drawn: the whole frame's time, and the leaves in it.
    void drew(double frameMs, uint32_t leaves) {
        coarse_ = hurried_;
        if (hurried_) detail_.follow(frameMs, leaves);
    }

    // The picture that is shown is a coarse one, to be drawn again when nothing moves.
    bool coarse() const { return coarse_; }

  private:
    MovingDetail detail_;
    bool coarse_ = false, hurried_ = false;
};

}  // namespace espalier::scene
