#pragma once

#include "sample_game/workspace.hpp"

namespace sample {

// In the place of a kind of element: a drag combs the field in hand, or smooths it. As of scene::SceneStroke::brush.
inline constexpr const char *kComb = "comb", *kSmooth = "smooth";
bool brushesField(const Workspace& work);  // one of them is what comes next

// How far the next element is felt, or the brush; metres, world.
float fieldReach(const Workspace& work);
// The largest that it can be made, by whatever means; kSmallestBrush is the smallest.
float mostFieldReach(const Workspace& work);
// Which of the scene's surfaces a hit is on; nothing: none.
std::optional<size_t> surfaceUnder(const Workspace& work, const EspHit& hit);

// One stroke of such a brush, shown while it goes on, and one step of undo. The way of the mouse is walked in steps of
// a few pixels, so that the stroke doesn't depend on how fast mouse or frames are.
class FieldBrush {
  public:
    // On which of the scene's surfaces; nothing: there is none.
    std::optional<size_t> begin(Workspace& work, glm::vec2 at, uint32_t gesture);
    void follow(Workspace& work, glm::vec2 at);
    bool changed() const { return changed_; }
    void draw(const Workspace& work) const;

  private:
    void lay(const Workspace& work, glm::vec2 at);
    void perform(Workspace& work);

    size_t surface_ = 0;
    uint32_t gesture_ = 0;
    espalier::scene::SceneStroke stroke_;  // the brush, and points that the document hasn't got
    glm::vec2 walked_{0};
    std::optional<glm::vec3> last_;  // world
    bool begun_ = false;             // the document has the stroke
    bool changed_ = false;
};

}  // namespace sample
