#pragma once

// What strokes of the brush, fills and imports do to layers of surfaces and of a town: they make those that are
// missing, keep what was there, are undone and done again.

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

// What a stroke paints on; the surface has a layer of this name.
Canvas canvasOf(EspContext& context, uint32_t surface, const std::string& name);
// The layer that a part has painted; null if it is gone, though there may be another of its name.
PaintedLayer* layerOf(EspContext& context, const PaintStroke& stroke, const PaintStroke::Part& part);

// Paints surfaces once more with all dabs of an open stroke, whose paint the host has no copy of.
EspResult paintAgain(EspContext& context, PaintStroke& stroke);

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

// Whether strokes of this name reach a layer of the town: one that it has, or that its grammar reads. Its grammar may
// be none yet.
bool townTakes(const EspContext& context, const std::string& name);
// What strokes do to that layer, if there is one. True: there is.
void paintTown(EspContext& context, PaintStroke& stroke, std::span<const DabRecord> dabs);
bool fillTown(EspContext& context, PaintStroke& stroke, float value);
void closeTown(EspContext& context, PaintStroke& stroke);
// The layer that the stroke has made is there once more, before it is done again.
void makeTownAgain(EspContext& context, const PaintStroke& stroke);
void swapTown(EspContext& context, PaintStroke& stroke);
// Notes that the stroke has been undone, or done again.
void turnTown(EspContext& context, PaintStroke& stroke) noexcept;
// A layer that the stroke has made goes while it is undone, unless something else has been painted on it.
void dropTownMade(EspContext& context, const PaintStroke& stroke) noexcept;

// Whether what the stroke has painted on a layer is there: from its first dab on, while it is open too.
template <class Layer>
void countStroke(Layer* layer, PaintStroke::Hold& hold, bool counts) noexcept {
    if (layer && hold.counts != counts) layer->strokes += counts ? 1 : -1;
    hold.counts = counts;
}
template <class Layer>
void turnStroke(Layer* layer, PaintStroke::Hold& hold) noexcept {
    if (!layer) return;
    hold.undone = !hold.undone;
    countStroke(layer, hold, !hold.undone);
}

}  // namespace espalier
