#pragma once

#include "sample_game/field_brush.hpp"
#include "sample_game/input.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

// Elements of the field in hand: a click places one, a drag gives its direction. A click on one chooses it, a drag of
// it moves it, a drag of its arrow turns it. Where a stroke is asked for, a drag lays elements along its way; with a
// brush it combs or smooths.
class FieldTool {
  public:
    bool take(Workspace& work, const PointerEvent& event);
    void cancel(Workspace& work);  // what is under way, as if it hadn't been
    void finish() { drag_ = Drag::none; }
    void forget(Workspace& work);  // of the scene that was open before
    void remove(Workspace& work);  // the chosen element
    bool dragging() const { return drag_ != Drag::none; }
    void draw(const Workspace& work);

  private:
    void drawIndices(const Workspace& work);
    enum class Drag { none, direction, move, stroke, brush };
    void press(Workspace& work, glm::vec2 at);
    void follow(Workspace& work, glm::vec2 at);
    void place(Workspace& work, const EspHit& hit);
    void layStroke(Workspace& work, const EspHit& hit);

    FieldBrush brush_;
    // Where the field that is seen turns, and the state of the document that this is of.
    struct {
        std::string name;
        uint64_t revision = ~0ull;
        std::vector<EspSingularity> all;
    } turns_;
    Drag drag_ = Drag::none;
    glm::vec2 from_{0};
    glm::vec3 laid_{0};  // where the stroke's last element ends
    bool moved_ = false, changed_ = false;
    uint32_t gesture_ = 0;
};

// An index of whole turns, as "+1/2".
std::string indexText(float index);

// In the place of a kind of element: a drag lays regular ones that point along its way.
inline constexpr const char* kStroke = "stroke";

// The fields that the scene's grammars read and that elements may form.
std::vector<std::string> designedFields(const Workspace& work);
// What the document says of the field in hand on a surface, or what holds where it says nothing.
espalier::scene::SceneField fieldNow(const Workspace& work, size_t surface);
// The element that is chosen; null: none.
const espalier::scene::SceneElement* chosenElement(const Workspace& work);
// Gives the chosen element's surface the field with that element as `change` leaves it.
void changeElement(Workspace& work, uint32_t gesture,
                   const std::function<void(espalier::scene::SceneElement&)>& change);

}  // namespace sample
