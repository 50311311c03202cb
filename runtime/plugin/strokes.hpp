#pragma once

// What strokes of the brush, fills and imports do to surfaces' layers: they make those that are missing, keep what was
// there, are undone and done again.

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "runtime/plugin/context.hpp"

namespace espalier {

using TouchedBlocks = std::vector<std::pair<uint32_t, std::vector<uint32_t>>>;  // surface id, blocks

// Makes the layers that are missing, filled with `fill`, and what the painter asks for.
EspResult jobsFor(EspContext& context, PaintStroke& stroke, float fill, TouchedBlocks touched,
                  std::vector<PaintJob>& jobs);

// Is told of a part's blocks that aren't as they were, and which of their texels; of none: all of them.
using PartChanged = std::function<void(const PaintStroke::Part& part, const std::vector<uint64_t>& texels)>;

// From here on the stroke is one step of undo. Where there is no memory to look for what has changed, the record keeps
// all of its blocks. `changed` may be empty.
EspResult endStroke(EspContext& context, PaintStroke& stroke, const PartChanged& changed = {});
// Ends a stroke that painted in one go, tells growth of it, and gives it an id; on failure what it painted is taken
// back.
EspResult keepEnded(EspContext& context, PaintStroke stroke, EspStroke* out);
// Of a stroke that has painted nothing, or whose paint has been taken back: the layers that it made go.
void withdraw(EspContext& context, PaintStroke& stroke) noexcept;
// Undoes a stroke that has ended, or does it again: all of it or nothing.
EspResult swapStroke(EspContext& context, PaintStroke& stroke);

}  // namespace espalier
