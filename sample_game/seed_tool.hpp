#pragma once

#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Seeds: a click plants one that grows upward, a drag gives the direction. A click on a seed chooses it (Shift: one
// more), a drag of a chosen one moves it. Ctrl and a drag plant along the way.
class SeedTool {
  public:
    bool take(Workspace& work, const PointerEvent& event);
    void remove(Workspace& work);     // those that are chosen
    void selectAll(Workspace& work);  // or none, if all are
    bool dragging() const { return drag_ != Drag::none; }
    void draw(const Workspace& work) const;

  private:
    enum class Drag { none, direction, move, row };
    espalier::document::SeedRecord newSeed(Workspace& work, const EspHit& hit) const;
    void plant(Workspace& work, const espalier::document::SeedRecord& seed, uint32_t gesture);
    uint32_t seedAt(const Workspace& work, glm::vec2 at) const;

    Drag drag_ = Drag::none;
    glm::vec2 from_{0}, last_{0};
    bool moved_ = false;
    uint32_t gesture_ = 0;
    espalier::document::SeedRecord pending_;  // planted on release
    glm::vec3 normal_{0, 1, 0};
    std::optional<glm::vec3> lastInRow_;
};

}  // namespace sample
