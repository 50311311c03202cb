#pragma once

#include "runtime/gpu/commands.hpp"
#include "runtime/run/stage.hpp"

namespace espalier {

// Which barriers the stages of a recording need, from what they read and write.
class Hazards {
  public:
    // Fills, copies or uploads have been recorded, of anything.
    void sent() { sent_ = true; }
    // What has to be waited for before this stage; nothing: it may run beside those before it. Then the stage counts as
    // recorded behind that wait, which makes everything written visible to kernels, indirect arguments and copies.
    struct Wait {
        bool any = false;
        Use before{};
    };
    Wait add(const Kernel& kernel, const Groups& groups);
    static constexpr Use kAfter = Use::compute | Use::indirect | Use::transfer;

  private:
    bool sent_ = false;
    Things written_ = 0, read_ = 0, asked_ = 0;  // since the last wait; asked: for numbers of groups
};

}  // namespace espalier
