#pragma once

struct ImFont;

namespace sample {

// Fonts and colours of the current ImGui context for a display of this scale (1: 96 dpi). May be called again when
// the scale changes; the renderer has to take in the new font atlas then.
void applyTheme(float scale);

// Letters of one width, for texts of grammars. Until the next applyTheme.
ImFont* textFont();

}  // namespace sample
