#pragma once

#include <array>

#include "runtime/emit/emit.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/image.hpp"

namespace espalier {

// The farthest depths that models leave in the tiles of a picture, this one or some before it: what lies behind them
// is hidden. `models`: of what has made the depths, another number where that is something else.
class DepthTiles {
  public:
    static Result<DepthTiles> create(Device& device, uint32_t samples);

    // Finds those of this picture, and notes in the view where they are. Leaves the depths in `sampled`.
    Status find(Commands& commands, Image& depths, const Sampler& sampler, uint64_t models, EmitView& view);
    // Takes those of the newest picture of the view's size that has finished, if there is one: what they say stands, so
    // that native code can cull.
    void lookBack(const Device& device, uint64_t models, EmitView& view) const;
    // What was recorded last didn't run.
    void forget() { pictures_ = {}; }

  private:
    struct Picture {
        Buffer buffer;
        EmitView view{};
        uint64_t serial = 0, models = 0;  // serial: of its recording
    };
    Program program_;
    std::array<Picture, 4> pictures_;
};

}  // namespace espalier
