#pragma once

#include <cstdint>

namespace espalier {

inline constexpr uint32_t kContextBits = 6;

// Tells the contexts of a process apart in their ids. Up to 2^kContextBits contexts that live at a time have unlike
// numbers; any more share numbers. A number is free again when its context is gone, and is taken last, so that the ids
// of a destroyed context are refused for long. May be used by any thread.
class ContextNumber {
  public:
    ContextNumber();
    ~ContextNumber();
    ContextNumber(const ContextNumber&) = delete;
    uint32_t value() const { return number_; }

  private:
    uint32_t number_;
};

}  // namespace espalier
