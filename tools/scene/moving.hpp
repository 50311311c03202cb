#pragma once

// How coarsely growth is drawn while the camera moves, or a stroke goes on, on a device that is slow: what counts then
// is that the picture follows the hand.

#include <algorithm>
#include <cstdint>
#include <utility>

#include "plugin_api/espalier.h"

namespace espalier::scene {

class MovingDetail {
  public:
    // Times the errors that are allowed otherwise: at first, and where the smallest pictures are late all the same.
    static constexpr float kLod = 4, kMostLod = 8;
    static constexpr double kFrameMs = 1e3 / 15;
    static constexpr uint32_t kLeaves = 20'000;  // in view: more aren't given up for speed
    static constexpr float kShare = 0.5f;        // of the window's width, in whose pixels errors are meant

    // Times the pixels from which on all leaves are drawn: fewer and larger leaves, and fewer twigs.
    float leaf() const { return leaf_; }

    // Makes a picture as coarse as that. share: of the window's width that is drawn; pictures of all sizes show the
    // same detail, so that larger ones cost more pixels and nothing else.
    void apply(EspLook& look, float share = kShare) const {
        look.lodPixels *= lod_ * share / kShare;
        look.leafPixels *= leaf_ * share / kShare;
        look.quick = 1;
    }

    // After each such frame: its time, the leaves that it drew, its share; 1 where it needn't be in time. Steps are
    // small, so that nothing pops. What else is drawn becomes coarser where leaves are given up already, and a picture
    // that is smaller than kShare grows before they come back.
    void follow(double frameMs, uint32_t leaves, float share = 1) {
        const bool late = frameMs > kFrameMs, spare = leaves > kLeaves + kLeaves / 10 && leaf_ < kMostLeaf;
        if (leaves < kLeaves || (frameMs < 0.7 * kFrameMs && share >= kShare))
            leaf_ = std::max(1.0f, leaf_ * 0.95f);
        else if (late && spare)
            leaf_ = std::min(kMostLeaf, leaf_ * 1.04f);
        if (share <= kShare && late && !spare)
            lod_ = std::min(kMostLod, lod_ * 1.04f);
        else if (frameMs < 0.8 * kFrameMs)
            lod_ = std::max(kLod, lod_ * 0.96f);
        spent_ = late && !spare && lod_ == kMostLod;
    }
    // Pictures are late at all that may be given up of their detail.
    bool spent() const { return spent_; }

  private:
    static constexpr float kMostLeaf = 4;
    float leaf_ = 1.5f, lod_ = kLod;
    bool spent_ = false;
};

// Which share of the window's width a picture is drawn with while the camera moves: as much as lets frames be in time.
class MovingShare {
  public:
    float share() const { return share_; }

    // The camera begins to move.
    void begin() { frames_ = -kLag; }
    // After each such frame: the time of the latest one that is known, and whether its detail is spent: else no picture
    // is smaller than MovingDetail::kShare. A step up makes a frame at most kStep² as dear, which leaves it in time.
    void follow(double frameMs, bool spent) {
        if (frames_++ < 0) return;
        mean_ = frames_ == 1 ? frameMs : mean_ + kFollow * (frameMs - mean_);
        const float least = share_ <= MovingDetail::kShare && spent ? kLeast : MovingDetail::kShare;
        if (frames_ >= kFramesDown && mean_ > kLate * MovingDetail::kFrameMs && share_ > least)
            change(std::max(least, share_ / kStep));
        else if (frames_ >= kFramesUp && mean_ < kEarly * MovingDetail::kFrameMs)
            change(std::min(share_ * kStep, share_ < MovingDetail::kShare ? MovingDetail::kShare : 1));
    }

  private:
    static constexpr float kStep = 1.2f, kLeast = MovingDetail::kShare / kStep;
    static constexpr double kEarly = 0.6, kLate = 0.95, kFollow = 0.2;
    static constexpr int kLag = 3;  // frames whose times are of others: known late, or of one that made its images
    static constexpr int kFramesDown = 4, kFramesUp = 12;  // at a share, before it may change

    void change(float share) {
        const float before = std::exchange(share_, share);
        if (share_ != before) begin();
    }

    float share_ = MovingDetail::kShare;
    double mean_ = 0;  // of the frames at this share, the latest weighing most
    int frames_ = 0;   // that were followed at this share
};

// What a window asks for in each frame; it draws as it is told.
class MovingPicture {
  public:
    static constexpr double kSlowDrawMs = 40;  // a device that takes longer over a whole picture is slow

    // Before a frame: moving: the camera does, or a stroke goes on; drawMs: what the last picture took; smaller: such
    // pictures may be smaller. Makes `look` coarser if need be; returns the share of the window's width to draw.
    float prepare(EspLook& look, bool moving, double drawMs, bool smaller) {
        hurried_ = moving && (coarse_ || drawMs > kSlowDrawMs);
        shown_ = hurried_ && smaller ? share_.share() : 1;
        if (hurried_) detail_.apply(look, smaller ? shown_ : MovingDetail::kShare);
        return shown_;
    }

    // After it, if it was drawn: the time of the latest whole frame that is known, the leaves in it. strokes: a stroke
    // goes on, whose frames may take longer: they are as large as the last that a camera moved in.
    void drew(double frameMs, uint32_t leaves, bool strokes = false) {
        if (hurried_) detail_.follow(frameMs, leaves, strokes ? 1 : shown_);
        if (!hurried_ || !coarse_ || strokes)
            share_.begin();
        else
            share_.follow(frameMs, detail_.spent());
        coarse_ = hurried_;
    }

    // Before drew(): the picture that prepare() was told of is a coarse one.
    bool hurried() const { return hurried_; }
    // As prepare() gave it last.
    float share() const { return shown_; }
    // The picture that is shown is a coarse one, to be drawn again when nothing moves.
    bool coarse() const { return coarse_; }

  private:
    MovingDetail detail_;
    MovingShare share_;
    float shown_ = 1;
    bool coarse_ = false, hurried_ = false;
};

}  // namespace espalier::scene
