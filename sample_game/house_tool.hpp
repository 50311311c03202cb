#pragma once

#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Roofs: a click chooses a house, or an edge of the chosen one; a drag of one of its corners, or of a courtyard's,
// moves the outline, and the roof follows. Ctrl and a drag put a new corner into an edge.
class HouseTool {
  public:
    bool take(Workspace& work, const PointerEvent& event);
    void removeCorner(Workspace& work);  // where the chosen edge begins
    void cancel(Workspace& work);        // a drag, as if it hadn't been
    void finish(Workspace& work);        // it stays as it is by now, unless no roof can be there
    bool dragging() const { return corner_.has_value(); }
    void draw(const Workspace& work) const;

  private:
    void press(Workspace& work, glm::vec2 at, bool insert);
    void beginDrag(Workspace& work, espalier::scene::House house, size_t corner, glm::vec2 at);
    void dragTo(Workspace& work, glm::vec2 mouse);

    // The corner that is being dragged, and its house as it is asked for: what stands may have its
    // corners in another order, or fewer of them.
    std::optional<size_t> corner_;
    espalier::scene::House dragged_;
    glm::vec2 from_{0}, grip_{0};  // where it was pressed; from there to where the corner was seen
    glm::vec3 hold_{0};            // and where the corner was
    bool refused_ = false;         // by the last move
    bool moved_ = false;           // further than a hand trembles in a click
    bool changed_ = false;         // by this drag
    uint32_t gesture_ = 0;
};

}  // namespace sample
