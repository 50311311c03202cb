#pragma once

#include <utility>

namespace sample {

// When what was changed is grown. Growth that takes longer than a blink, judged by the last time when most plants grew,
// is announced one frame before, and doesn't follow every step of a drag: the next step would wait for it.
class GrowthPace {
  public:
    static constexpr double kSlowMs = 500;

    enum class Step { grow, announce, wait };
    // changed: something isn't grown yet; wide: most plants may grow anew by it; dragged: a control that is still held
    // changes it; painting: a stroke goes on, whose dabs are grown in their own frames.
    Step next(bool changed, bool wide, bool dragged, bool painting) {
        const bool slow = changed && wide && !painting && wholeMs_ > kSlowMs;
        if (slow && dragged) return Step::wait;
        if (slow && !std::exchange(announced_, true)) return Step::announce;
        announced_ = false;
        return Step::grow;
    }
    void grewWhole(double ms) { wholeMs_ = ms; }

  private:
    bool announced_ = false;
    double wholeMs_ = 0;
};

}  // namespace sample
