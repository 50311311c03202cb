#pragma once

#include <string_view>
#include <vector>

#include <imgui.h>

#include "sample_game/grammar_completion.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// The list of names that a grammar's window offers for the letters before the cursor.
class Offer {
  public:
    bool open() const { return open_; }
    // Once a frame, after the text's widget: the list comes after two letters of a name, or by Ctrl+Space, which then
    // marks the next name. cursor: bytes before it; typing: the widget has the keys; changed: by typing, in this frame.
    void follow(const Workspace& work, std::string_view text, size_t cursor, bool typing, bool changed);
    // Within the widget's callback for Tab: the marked name takes the place of the letters.
    void take(ImGuiInputTextCallbackData& data);
    // below: of the window, under the cursor.
    void draw(const Workspace& work, ImVec2 below) const;

  private:
    bool open_ = false, taken_ = false;
    size_t marked_ = 0, cursor_ = 0;
    std::vector<Completion> list_;
};

}  // namespace sample
