#pragma once

#include <optional>
#include <vector>

#include "sample_game/input.hpp"
#include "sample_game/path_line.hpp"

namespace sample {

// One drag, one plant: ivy that follows the line which the mouse has drawn over whatever lies under it. Lines can be
// changed afterwards: the chosen one shows its points, which are dragged; a drag of the line between two points makes
// one more.
class PathTool {
  public:
    // In order; true: it was the tool's.
    bool take(Workspace& work, const PointerEvent& event);
    void cancel();  // what is drawn or dragged is forgotten
    bool dragging() const { return !line_.empty() || held_; }
    void removePoint(Workspace& work);  // the chosen one, or the chosen line with its plant
    void draw(const Workspace& work) const;

  private:
    void moveTo(const Workspace& work, glm::vec2 at);
    bool takeUp(Workspace& work, glm::vec2 at);
    void follow(const Workspace& work, glm::vec2 at);
    void letGo(Workspace& work);

    std::vector<EspHit> line_;  // that is being drawn
    glm::vec2 last_{0};
    // Of the chosen seed's line: its points, while one of them is dragged; and which is or was.
    std::vector<LinePoint> points_;
    uint32_t of_ = 0;  // key of the seed
    std::optional<size_t> point_;
    bool held_ = false, moved_ = false;
};

}  // namespace sample
