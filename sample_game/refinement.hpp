#pragma once

#include <algorithm>
#include <cstdint>

namespace sample {

// What becomes of a picture while nothing changes: it takes over from the coarse one of a camera that has stopped, and
// then pictures that lie fractions of a pixel beside it are averaged with it, one a frame, so that edges, twigs and
// leaves become smooth. Times are seconds of one clock that doesn't go back.
class Refinement {
  public:
    static constexpr uint32_t kPictures = 16;
    static constexpr double kFade = .2;

    // A picture of something else was drawn. coarse: of what moves; the next one that isn't fades in over it.
    void drew(bool coarse) {
        if (coarse_ && !coarse) faded_ = kWaits;
        if (coarse) faded_ = kNever;
        coarse_ = coarse;
        pictures_ = 1;
    }
    // Another one was averaged with it.
    void refined() { ++pictures_; }

    // Pictures that what is shown is the mean of; the next one's number.
    uint32_t pictures() const { return pictures_; }
    bool coarse() const { return coarse_; }
    // There is more to be had of drawing another one.
    bool due() const { return pictures_ > 0 && pictures_ < kPictures && !coarse_; }
    // A frame begins. Only the one after a whole picture lets it begin to fade in: drawing it may take longer than the
    // fading does.
    void begin(double now) {
        if (faded_ == kWaits) faded_ = now;
    }
    // What is left of the coarse picture, 1 to 0.
    float before(double now) const {
        return faded_ == kWaits ? 1 : float(std::clamp(1 - (now - faded_) / kFade, 0., 1.));
    }
    // Nothing can take over from what was shown: its size is another.
    void cut() { faded_ = kNever; }

  private:
    static constexpr double kNever = -1e9, kWaits = 1e9;
    uint32_t pictures_ = 0;
    bool coarse_ = false;
    double faded_ = kNever;  // since when
};

}  // namespace sample
