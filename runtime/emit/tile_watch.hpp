#pragma once

// Which tiles of a picture edits have changed, so that only these are drawn again.

#include "runtime/gpu/commands.hpp"
#include "shaders/emit/emit_records.h"

namespace espalier {

class TileWatch {
  public:
    static Result<TileWatch> create(Device& device);

    // Recorded once all of `view`, a parallel one, was drawn: from now on its tiles are noted where edits change it.
    Status watch(Commands& commands, const EmitView& view);
    // The view of what lies in noted tiles, in at most so many; the others come next time. They count as drawn.
    // growthStands: what has been bound stands in memory, and native code may look at it: so it may take them at once,
    // if no recording looks at them.
    EmitView take(Commands& commands, uint32_t mostTiles, bool growthStands);
    void forget() { watched_ = {}; }

    const EmitView& watched() const { return watched_; }  // width 0: none
    const Buffer& record() const { return record_; }      // the same on the device

  private:
    Device* device_ = nullptr;
    Program take_;
    Buffer record_, tiles_, taken_;
    EmitView watched_{};
    uint64_t usedBy_ = 0;  // the recording that looked at them last
    uint64_t timesTaken_ = 0;
};

// How many tiles of tilePixels the picture has.
uint32_t tilesOf(const EmitView& view);

}  // namespace espalier
