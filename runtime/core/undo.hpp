#pragma once

#include <utility>

namespace espalier {

// Takes back what a scope has begun, unless it got as far as done(): where it is left before that, be it by an
// exception. `take` throws nothing.
template <class Take>
class Undo {
  public:
    explicit Undo(Take take) : take_(std::move(take)) {}
    ~Undo() {
        if (!done_) take_();
    }
    Undo(const Undo&) = delete;
    Undo& operator=(const Undo&) = delete;
    void done() { done_ = true; }

  private:
    Take take_;
    bool done_ = false;
};

}  // namespace espalier
