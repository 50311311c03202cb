#pragma once

// The host's copies of what is painted on surfaces, from which another device gets it when one is lost. Layers and
// records of strokes are copied when a stroke ends; what an open one has painted is known by its dabs.

#include "runtime/plugin/context.hpp"

namespace espalier {

// Copies what a stroke has changed that has just ended. Fails only where the device is lost: then the stroke's
// dabs stay. Where memory is short, keepBehind() copies it later.
Status keepStroke(EspContext& context, PaintStroke& stroke);
// The copies follow what Painter::swap has just done.
void swapKept(EspContext& context, PaintStroke& stroke) noexcept;
// Makes the copies for which there was no memory.
Status keepBehind(EspContext& context);
// Puts layers and strokes on the context's device by these copies, and by the dabs of strokes that are open.
EspResult restorePaint(EspContext& context);

}  // namespace espalier
