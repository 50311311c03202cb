#pragma once

#include <utility>

namespace sample {

// When what was changed is grown. Growth that takes longer than a blink is announced one frame before, judged by the
// last time when most plants grew. A drag whose last step took as long isn't followed any further: it grows as it is
// let go.
class GrowthPace {
  public:
    static constexpr double kSlowMs = 500;

    enum class Step { grow, announce, wait };
    // changed: something isn't grown yet; wide: most plants may grow anew by it; dragged: a control that is still held
    // changes it; painting: a stroke goes on, whose dabs are grown in their own frames.
    Step next(bool changed, bool wide, bool dragged, bool painting) {
        if (!dragged) stepMs_ = 0;
        if (changed && dragged && !painting && stepMs_ > kSlowMs) return Step::wait;
        const bool slow = changed && wide && !painting && wholeMs_ > kSlowMs;
        if (slow && !std::exchange(announced_, true)) return Step::announce;
        announced_ = false;
        return Step::grow;
    }
    // What the last step's growth took. whole: most plants grew.
    void grew(double ms, bool whole) {
        stepMs_ = ms;
        if (whole) wholeMs_ = ms;
    }

  private:
    bool announced_ = false;
    double stepMs_ = 0, wholeMs_ = 0;
};

}  // namespace sample
