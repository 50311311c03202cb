// Mouse moves in, a camera out. Pitch stops short of the poles, so that up stays up.
#include "sample_game/orbit_camera.hpp"

#include <algorithm>
#include <cmath>

namespace sample {
namespace {

constexpr float kMaxPitch = 1.55f;

}  // namespace

void OrbitCamera::set(const EspCamera& camera, float reach) {
    float d[3];
    for (int i = 0; i < 3; ++i) {
        target_[i] = camera.target[i];
        d[i] = camera.eye[i] - camera.target[i];
    }
    distance_ = std::max(std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), 1e-4f);
    yaw_ = std::atan2(d[0], d[2]);
    pitch_ = std::clamp(std::asin(std::clamp(d[1] / distance_, -1.f, 1.f)), -kMaxPitch, kMaxPitch);
    fovY_ = camera.fovY;
    reach_ = std::max(reach, 1e-3f);
}

OrbitCamera::Frame OrbitCamera::frame() const {
    const float cy = std::cos(yaw_), sy = std::sin(yaw_), cp = std::cos(pitch_), sp = std::sin(pitch_);
    return {{cp * sy, sp, cp * cy}, {cy, 0, -sy}, {-sp * sy, cp, -sp * cy}};
}

void OrbitCamera::turn(float x, float y) {
    yaw_ -= 4 * x;
    pitch_ = std::clamp(pitch_ + 4 * y, -kMaxPitch, kMaxPitch);
}

void OrbitCamera::pan(float x, float y) {
    // What is under the mouse stays under it, at the target's depth.
    const float metres = 2 * distance_ * std::tan(fovY_ / 2);
    const Frame f = frame();
    for (int i = 0; i < 3; ++i) target_[i] += metres * (-x * f.right[i] + y * f.up[i]);
}

void OrbitCamera::zoom(float steps) {
    distance_ = std::clamp(distance_ * std::pow(.88f, steps), reach_ * 1e-3f, reach_ * 50);
}

EspCamera OrbitCamera::camera(float shift) const {
    EspCamera camera{};
    camera.shift[0] = shift;
    const Frame f = frame();
    for (int i = 0; i < 3; ++i) {
        camera.eye[i] = target_[i] + distance_ * f.back[i];
        camera.target[i] = target_[i];
    }
    camera.up[1] = 1;
    camera.fovY = fovY_;
    camera.nearPlane = std::clamp(distance_ * .02f, reach_ * 1e-4f, reach_ * .02f);
    return camera;
}

Ray OrbitCamera::ray(float x, float y, float aspect, float shift) const {
    const Frame f = frame();
    const float t = std::tan(fovY_ / 2);
    Ray ray;
    for (int i = 0; i < 3; ++i) {
        ray.origin[i] = target_[i] + distance_ * f.back[i];
        ray.direction[i] = (2 * x - 1 - shift) * t * aspect * f.right[i] + (1 - 2 * y) * t * f.up[i] - f.back[i];
    }
    return ray;
}

}  // namespace sample
