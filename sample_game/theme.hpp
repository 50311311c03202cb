#pragma once

#include <imgui.h>

namespace sample {

// Of news: what has failed, what the user may not have meant, what was done.
inline const ImVec4 kBad{1, .55f, .45f, 1}, kWarning{1, .8f, .45f, 1}, kGood{.62f, .85f, .5f, 1};

// Fonts and colours of the current ImGui context for a display of this scale (1: 96 dpi). May be called again when
// the scale changes; the renderer has to take in the new font atlas then.
void applyTheme(float scale);

// Letters of one width, for texts of grammars. Until the next applyTheme.
ImFont* textFont();

}  // namespace sample
