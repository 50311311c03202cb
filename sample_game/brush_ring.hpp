#pragma once

#include <imgui.h>

#include "sample_game/workspace.hpp"

namespace sample {

inline constexpr ImU32 kSmoothRing = IM_COL32(110, 180, 255, 255);  // of brushes that smooth

struct BrushRing {
    float radius = 0;    // metres
    float hardness = 0;  // share of the radius at which a second ring lies; about 0: none
    bool flat = false;   // over a town, which is painted from above
};
// What a brush reaches around a place of the scene.
void drawBrushRing(const Workspace& work, const EspHit& hit, const BrushRing& ring, ImU32 colour);

}  // namespace sample
