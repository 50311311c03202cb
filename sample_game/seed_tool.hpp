#pragma once

#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Seeds: a click plants one that grows upward, a drag gives the direction. A click on a seed chooses it (Shift: one
// more), Shift and a drag those that it goes around; a drag of a chosen one moves all that are, a drag of its arrow
// turns them. Ctrl and a drag plant along the way, wherever they begin.
class SeedTool {
  public:
    bool take(Workspace& work, const PointerEvent& event);
    // Without a button held: the chosen ones follow the mouse, or turn towards it, until a click.
    void grab(Workspace& work, glm::vec2 at, bool turns);
    // Copies of the chosen ones, which are chosen then and follow the mouse. Each grows a plant of its own.
    void duplicate(Workspace& work, glm::vec2 at);
    void cancel(Workspace& work);     // what is under way, as if it hadn't been
    void finish(Workspace& work);     // it stays as it is by now; what isn't planted yet, isn't
    void remove(Workspace& work);     // those that are chosen
    void selectAll(Workspace& work);  // or none, if all are
    bool dragging() const { return drag_ != Drag::none; }
    bool followsMouse() const { return byKey_; }  // without a button held
    void draw(const Workspace& work) const;

  private:
    enum class Drag { none, direction, move, turn, row, box };
    espalier::document::SeedRecord newSeed(Workspace& work, const EspHit& hit) const;
    void plant(Workspace& work, const espalier::document::SeedRecord& seed, uint32_t gesture);
    uint32_t seedAt(const Workspace& work, glm::vec2 at) const;
    bool arrowAt(const Workspace& work, glm::vec2 at) const;  // of a chosen one
    void press(Workspace& work, const PointerEvent& event);
    void followMouse(Workspace& work, glm::vec2 at, bool turns);
    void beginRow(Workspace& work, glm::vec2 at);
    void follow(Workspace& work, glm::vec2 at);
    void plantRow(Workspace& work, glm::vec2 at);  // from where the mouse was
    void selectBox(Workspace& work) const;         // from where the drag began to where it is, besides what is chosen
    // The chosen ones, as `change` leaves them.
    template <class Change>
    void changeChosen(Workspace& work, Change&& change);

    Drag drag_ = Drag::none;
    glm::vec2 from_{0}, last_{0};
    glm::vec2 grip_{0};  // from the mouse to the one that G moves
    bool moved_ = false, changed_ = false;
    uint32_t alone_ = 0;         // the seed that a click without a move leaves as the only one chosen; 0: none
    bool byKey_ = false;         // no button is held
    std::set<uint32_t> copied_;  // what was chosen before its copies were; empty: nothing is duplicated
    uint32_t gesture_ = 0;
    espalier::document::SeedRecord pending_;  // planted on release
    std::optional<glm::vec3> lastInRow_;
    bool firstInRow_ = false;  // the row has one seed yet
};

}  // namespace sample
