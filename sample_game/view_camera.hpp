#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "plugin_api/espalier.h"

namespace sample {

struct Ray {
    glm::vec3 origin, direction;
};

// What a ray along the unit vector `along` meets within `reach`: hit's distance, position and normal are set; false:
// nothing.
using Meets = std::function<bool(glm::vec3 from, glm::vec3 along, float reach, EspHit& hit)>;

// The camera of the game and of the editor: it stands at `eye` and looks along yaw and pitch, at a point `distance`
// away, about which the editor turns it. Angles in radians, lengths in metres.
class ViewCamera {
  public:
    // reach: how large what is looked at is.
    void set(const EspCamera& camera, float reach);

    // ---- Editor. Moves of the mouse by fractions of the window's height; x to the right, y down.
    void orbit(float x, float y);
    void pan(float x, float y);
    // Positive: nearer, along `way` in place of ahead. What lies there, at the distance that focus() was told, stays
    // where it is seen and isn't passed through.
    void zoom(float steps, glm::vec3 way);
    void zoom(float steps) { zoom(steps, ahead()); }
    float stepsFrom(float distance) const;  // that led from such a distance to the one that there is
    // Likewise where nothing lies: each step leads as far, in the measure of `distance`, and nothing stops one.
    void advance(float steps, glm::vec3 way, float distance);
    void turnTo(float yaw, float pitch);  // about what is looked at; 0, 0: from the front, +z
    void turnBy(float yaw, float pitch);  // likewise, radians
    // What is turned about, stays under the mouse and is gone nearer to lies that far ahead. The view stays.
    void focus(float distance);
    // So that the points fill the view, from where they are seen now. aspect: width by height of what nothing lies
    // over.
    void frame(std::span<const glm::vec3> points, float aspect);
    void frame(glm::vec3 low, glm::vec3 high, float aspect);  // a box
    // By a lens so long that lines which are parallel look so, as in a drawing; and back. What is looked at stays as
    // large as it is seen.
    void toggleFlat();
    bool flat() const;
    // ---- Both
    void look(float x, float y);
    // By `steps` right, up (of the world) and ahead, each -1 to 1, over `seconds`; several together are no faster.
    void fly(glm::vec3 steps, float seconds, bool fast);
    float hurry(float steps);  // flies faster (positive) or slower from now on; returns how fast, metres a second
    // ---- Game: on the ground, with a body that walls stop and steps don't. Falls if there is nothing below.
    // Before the first step: feet that would be in the ground are put onto it; who is below all ground, above.
    void stand(const Meets& meets);
    void walk(const Meets& meets, glm::vec2 rightAhead, float seconds, bool fast, bool jump);
    bool inAir() const { return fall_ != 0; }  // jumping or falling, so that there is more to walk without steps

    EspCamera camera() const;
    // Through a point of the window, 0 to 1, the first at the left and top. shift: how far right of its middle the
    // view's middle is, in halves of its width.
    Ray ray(glm::vec2 at, float aspect, float shift) const;
    // Where a point is seen, as for ray(); false: behind the camera.
    bool project(glm::vec3 point, float aspect, float shift, glm::vec2& at) const;

    glm::vec3 eye() const { return eye_; }
    glm::vec3 ahead() const;
    float distance() const { return distance_; }
    float pixelsPerMetre(float distance, float height) const;

  private:
    glm::vec3 right() const;
    glm::vec3 above() const;

    glm::vec3 eye_{0, 1.7f, 5};
    float yaw_ = 0, pitch_ = 0, distance_ = 5, fovY_ = .7f, reach_ = 1;
    float deepFovY_ = .7f;  // of the view that isn't flat
    float fall_ = 0;        // metres a second upward
    float haste_ = 1;       // of the speed that the scene's size makes usual
};

}  // namespace sample
