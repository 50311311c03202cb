#pragma once

namespace sample {

// When a window that shows a still picture gives back what memory work has left free: once, two seconds after its last
// frame. Not at once: the next frame would ask for it again. Times are seconds of one clock that doesn't go back.
class Rest {
  public:
    static constexpr double kAfter = 2;

    void drew(double now) {
        lastFrame_ = now;
        tidy_ = false;
    }
    // Asked while nothing is drawn. True once after each frame: now is the time.
    bool due(double now) {
        if (tidy_ || now - lastFrame_ < kAfter) return false;
        return tidy_ = true;
    }

  private:
    double lastFrame_ = 0;
    bool tidy_ = false;
};

}  // namespace sample
