#pragma once

// Brushes (brush.cpp) and painted layers (api_layers.cpp; replaceLayer: api_paint.cpp).

#include <optional>
#include <span>
#include <string>

#include "runtime/plugin/context.hpp"

namespace espalier {

// What is wrong with a brush; null: nothing.
const char* mistakeIn(const EspBrush& brush);
// To slopes and heights.
BrushLimits limitsOf(const EspBrush& brush);
// The numbers by which a kernel applies the brush; `fill` is the layer's.
BrushRecord recordOf(const EspBrush& brush, float fill);

EspResult makePainter(EspContext& context);  // if there is none

// The number of the layer that a grammar's context reads; made if need be, from one that no grammar but `without` reads
// any more and that isn't among `kept` where there are kMaxLayers already. Nothing: all of those are read.
std::optional<uint32_t> sceneLayer(EspContext& context, const std::string& name, float fill,
                                   std::span<const uint32_t> kept = {}, uint32_t without = 0);
// Until a layer comes or goes; null: the surface isn't painted with it.
PaintedLayer* paintedLayer(EspContext& context, uint32_t surface, const std::string& name);
// What the first grammar that declares the layer fills it with; nothing if none does.
std::optional<float> declaredFill(const EspContext& context, const std::string& name);
// Tells growth that these 8×8 blocks of a layer have changed; where `texels` are given, of each block only those whose
// bit 8 y + x is set.
void layerChanged(EspContext& context, uint32_t surface, const std::string& name, std::span<const uint32_t> blocks,
                  std::span<const uint64_t> texels = {});
// Sets all texels of a layer (texelIndex order), and makes an ended stroke of it.
EspResult replaceLayer(EspContext& context, uint32_t surface, const std::string& name, std::span<const float> texels,
                       EspStroke* out);
void wholeLayerChanged(EspContext& context, uint32_t surface, const std::string& name);

}  // namespace espalier
