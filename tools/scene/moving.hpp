#pragma once

// How coarsely growth is drawn while the camera moves, or a stroke goes on, on a device that is slow: what counts then
// is that the picture follows the hand.

#include <algorithm>
#include <cstdint>

namespace espalier::scene {

class MovingDetail {
  public:
    static constexpr float kLod = 4;  // times the errors that are allowed otherwise
    static constexpr double kFrameMs = 1e3 / 15;
    static constexpr uint32_t kLeaves = 20'000;  // in view: more aren't given up for speed

    // Times the pixels from which on all leaves are drawn: fewer and larger leaves, and fewer twigs.
    float leaf() const { return leaf_; }

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

}  // namespace espalier::scene
