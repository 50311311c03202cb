#pragma once

#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// The stroke that would begin now, while its limits are to be seen on the model: with the layer, and if there are any.
std::optional<espalier::document::StrokeBegin> limitingStroke(const Workspace& work);

// Painting: a drag with the left button lays dabs along the way of the mouse over whatever surfaces lie under it.
// Ctrl erases, Shift smooths, for as long as the stroke lasts. F, then a move sets the radius, with Shift the strength.
class BrushTool {
  public:
    // In order; true: it was the brush's.
    bool take(Workspace& work, const PointerEvent& event);
    // After the events of a frame: what they laid goes to the document at once.
    void flush(Workspace& work);
    void startSizing(Workspace& work, glm::vec2 at, bool strength);
    void cancel(Workspace& work);
    // Ends the stroke and undoes it.
    void takeBack(Workspace& work);
    bool painting() const { return painting_; }
    bool sizing() const { return sizing_ != Sizing::none; }
    // The circle on the surface, in what the stroke does or, before it, the keys would do now; with limits also the
    // place's slope and height.
    void draw(const Workspace& work, int mods) const;

  private:
    enum class Sizing { none, radius, strength };
    void begin(Workspace& work, int mods);
    void end(Workspace& work);
    void endSizing(Workspace& work);
    void moveTo(Workspace& work, glm::vec2 at);
    void drawCircle(const Workspace& work, int mods, const EspHit& hit) const;
    void layDab(const Workspace& work, glm::vec2 at);

    bool painting_ = false;
    espalier::document::StrokeBegin stroke_;  // the one that goes on, or went on last
    glm::vec2 last_{0};
    std::optional<glm::vec3> lastDab_;
    espalier::document::StrokeDabs dabs_;
    uint32_t gesture_ = 0;
    uint64_t stateBefore_ = 0;  // the stroke, of the document
    Sizing sizing_ = Sizing::none;
    glm::vec2 sizingFrom_{0};
    float before_ = 0;
    std::optional<EspHit> sizingAt_;
};

}  // namespace sample
