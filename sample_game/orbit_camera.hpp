#pragma once

#include <array>

#include "plugin_api/espalier.h"

namespace sample {

struct Ray {
    float origin[3], direction[3];
};

// A camera on a sphere around what it looks at, turned, moved and brought nearer by the mouse. Angles in radians.
class OrbitCamera {
  public:
    // Takes over eye, target and angle of view; `reach` (metres): how large what is looked at is.
    void set(const EspCamera& camera, float reach);

    // By fractions of the window's height; x to the right, y down.
    void turn(float x, float y);
    void pan(float x, float y);
    // Positive: nearer.
    void zoom(float steps);

    // shift: of the lens, to the right; see EspCamera.
    EspCamera camera(float shift) const;
    // Through a point of the window, x and y from 0 to 1, the first at the left and top.
    Ray ray(float x, float y, float aspect, float shift) const;

  private:
    struct Frame {
        std::array<float, 3> back, right, up;
    };
    Frame frame() const;

    std::array<float, 3> target_{0, 1, 0};
    float yaw_ = 0, pitch_ = 0, distance_ = 5, fovY_ = .7f, reach_ = 1;
};

}  // namespace sample
