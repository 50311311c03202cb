// Mouse and keys in, a camera out. Pitch stops short of the poles, so that up stays up. Walking asks the
// host for the ground and for walls, as any game asks its physics.
#include "sample_game/view_camera.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace sample {
namespace {

constexpr float kMaxPitch = 1.55f;
constexpr float kFlatFov = .0349066f;  // 2 degrees
constexpr float kWheel = .88f;         // of the distance that a step of the wheel leaves
constexpr float kEyeHeight = 1.65f, kBody = .3f, kStep = .45f, kGravity = 9.81f;

}  // namespace

void ViewCamera::set(const EspCamera& camera, float reach) {
    eye_ = {camera.eye[0], camera.eye[1], camera.eye[2]};
    const glm::vec3 d = glm::vec3(camera.target[0], camera.target[1], camera.target[2]) - eye_;
    distance_ = std::max(glm::length(d), 1e-4f);
    yaw_ = std::atan2(-d.x, -d.z);
    pitch_ = std::clamp(std::asin(std::clamp(d.y / distance_, -1.f, 1.f)), -kMaxPitch, kMaxPitch);
    fovY_ = camera.fovY;
    reach_ = std::max(reach, 1e-3f);
    fall_ = 0;
}

glm::vec3 ViewCamera::ahead() const {
    const float c = std::cos(pitch_);
    return {-c * std::sin(yaw_), std::sin(pitch_), -c * std::cos(yaw_)};
}
glm::vec3 ViewCamera::right() const {
    return {std::cos(yaw_), 0, -std::sin(yaw_)};
}
glm::vec3 ViewCamera::above() const {
    return glm::cross(right(), ahead());
}

void ViewCamera::look(float x, float y) {
    yaw_ -= 2.5f * x;
    pitch_ = std::clamp(pitch_ - 2.5f * y, -kMaxPitch, kMaxPitch);
}

void ViewCamera::orbit(float x, float y) {
    const glm::vec3 target = eye_ + distance_ * ahead();
    yaw_ -= 4 * x;
    pitch_ = std::clamp(pitch_ - 4 * y, -kMaxPitch, kMaxPitch);
    eye_ = target - distance_ * ahead();
}

void ViewCamera::pan(float x, float y) {
    // What is under the mouse stays under it, at the target's depth.
    const float metres = 2 * distance_ * std::tan(fovY_ / 2);
    eye_ += metres * (-x * right() + y * above());
}

void ViewCamera::zoom(float steps, glm::vec3 way) {
    const float before = distance_;
    distance_ = std::clamp(distance_ * std::pow(kWheel, steps), reach_ * 1e-3f, reach_ * 50);
    eye_ += (before - distance_) / std::max(glm::dot(way, ahead()), .1f) * way;
}

float ViewCamera::stepsFrom(float distance) const {
    return std::log(distance_ / distance) / std::log(kWheel);
}

void ViewCamera::advance(float steps, glm::vec3 way, float distance) {
    eye_ += steps * (1 - kWheel) * distance / std::max(glm::dot(way, ahead()), .1f) * way;
}

void ViewCamera::turnTo(float yaw, float pitch) {
    const glm::vec3 target = eye_ + distance_ * ahead();
    yaw_ = yaw;
    pitch_ = std::clamp(pitch, -kMaxPitch, kMaxPitch);
    eye_ = target - distance_ * ahead();
}

void ViewCamera::turnBy(float yaw, float pitch) {
    turnTo(yaw_ + yaw, pitch_ + pitch);
}

bool ViewCamera::flat() const {
    return fovY_ < 1.5f * kFlatFov;
}

void ViewCamera::toggleFlat() {
    const float to = flat() ? deepFovY_ : kFlatFov;
    if (!flat()) deepFovY_ = fovY_;
    const float farther = std::tan(fovY_ / 2) / std::tan(to / 2);
    eye_ += (1 - farther) * distance_ * ahead();
    distance_ *= farther;
    fovY_ = to;
}

void ViewCamera::focus(float distance) {
    distance_ = std::clamp(distance, reach_ * 1e-3f, reach_ * 50);
}

// The nearest eye from which all points lie between the view's four planes: a point that is `x` to the right and `z`
// ahead lies before the right plane where x - eye.x <= slope * (z - eye.z), which bounds eye.x - slope * eye.z by the
// greatest x - slope * z of all points; so the left one does, and above and below. Across the other axis there is room:
// planes that are turned inwards until they touch leave as much on either side.
void ViewCamera::frame(std::span<const glm::vec3> points, float aspect) {
    constexpr float kMargin = 1.1f, kFar = std::numeric_limits<float>::infinity();
    std::vector<glm::vec3> seen;  // right, above, ahead
    float front = kFar, rear = -kFar;
    for (const glm::vec3& point : points) {
        seen.emplace_back(glm::dot(point, right()), glm::dot(point, above()), glm::dot(point, ahead()));
        front = std::min(front, seen.back().z), rear = std::max(rear, seen.back().z);
    }
    if (seen.empty()) return;
    struct Wedge {
        float middle, nearest;
    };
    const auto wedge = [&](int axis, float slope) {
        float most = -kFar, least = kFar;
        for (const glm::vec3& at : seen) {
            most = std::max(most, at[axis] - slope * at.z);
            least = std::min(least, at[axis] + slope * at.z);
        }
        return Wedge{(most + least) / 2, (least - most) / (2 * slope)};
    };
    const glm::vec2 slopes = glm::vec2(std::max(aspect, .1f), 1) * std::tan(fovY_ / 2) / kMargin;
    const float depth = std::min({wedge(0, slopes.x).nearest, wedge(1, slopes.y).nearest, front - reach_ * 1e-3f});
    eye_ = depth * ahead();
    for (int axis = 0; axis < 2; ++axis) {
        float low = 0, high = slopes[axis];
        for (int i = 0; i < 24; ++i) {
            const float slope = (low + high) / 2;
            (wedge(axis, slope).nearest < depth ? low : high) = slope;
        }
        eye_ += wedge(axis, high).middle * (axis == 0 ? right() : above());
    }
    distance_ = std::max((front + rear) / 2 - depth, reach_ * 1e-3f);
}

void ViewCamera::frame(glm::vec3 low, glm::vec3 high, float aspect) {
    std::array<glm::vec3, 8> corners;
    for (int i = 0; i < 8; ++i) corners[size_t(i)] = glm::mix(low, high, glm::vec3(i & 1, i >> 1 & 1, i >> 2 & 1));
    frame(corners, aspect);
}

void ViewCamera::fly(glm::vec3 steps, float seconds, bool fast) {
    const float speed = hurry(0) * (fast ? 3.f : 1.f) / std::max(1.f, glm::length(steps));
    eye_ += seconds * speed * (steps.x * right() + steps.y * glm::vec3(0, 1, 0) + steps.z * ahead());
    fall_ = 0;
}

float ViewCamera::hurry(float steps) {
    haste_ = std::clamp(haste_ * std::pow(1.2f, steps), 1 / 32.f, 32.f);
    return haste_ * std::clamp(reach_ * .2f, .3f, 12.f);
}

void ViewCamera::stand(const Meets& meets) {
    constexpr float kFar = 1e6f, kThrough = 1e-3f;
    constexpr int kMostLayers = 32;
    fall_ = 0;
    EspHit ground;
    if (meets(eye_, {0, -1, 0}, kFar, ground)) {
        eye_.y = std::max(eye_.y, ground.position[1] + kEyeHeight);
        return;
    }
    // Below all ground: up through what has no room to stand above it.
    float foot = eye_.y, room = kFar;
    for (int i = 0; i < kMostLayers && meets({eye_.x, foot, eye_.z}, {0, 1, 0}, room, ground); ++i) {
        foot = ground.position[1] + kThrough;
        room = kEyeHeight;
        eye_.y = ground.position[1] + kEyeHeight;
    }
}

void ViewCamera::walk(const Meets& meets, glm::vec2 rightAhead, float seconds, bool fast, bool jump) {
    const glm::vec3 level{-std::sin(yaw_), 0, -std::cos(yaw_)};
    const float speed = (fast ? 3.4f : 1.7f) / std::max(1.f, glm::length(rightAhead));
    glm::vec3 move = (rightAhead.x * right() + rightAhead.y * level) * speed * seconds;
    // Against a wall only what goes along it is left; in a corner nothing.
    for (int wall = 0; wall < 2 && glm::length(move) > 1e-5f; ++wall) {
        EspHit hit, high;
        const glm::vec3 knee = eye_ - glm::vec3(0, kEyeHeight - kStep - .1f, 0), head = eye_ - glm::vec3(0, .2f, 0);
        const float length = glm::length(move), reach = length + 3 * kBody;
        const bool low = meets(knee, move / length, reach, hit);
        if (meets(head, move / length, reach, high) && (!low || high.distance < hit.distance))
            hit = high;
        else if (!low)
            break;
        glm::vec3 normal{hit.normal[0], 0, hit.normal[2]};
        if (glm::length(normal) < .3f) break;  // a slope: walked up
        normal = glm::normalize(normal);
        // The body is as wide in every direction, however slantingly it comes.
        const float into = -glm::dot(move, normal), most = std::max(hit.distance * into / length - kBody, 0.f);
        if (into <= most) break;
        move = wall == 1 ? glm::vec3(0) : move + (into - most) * normal;
    }
    eye_ += move;
    EspHit ground;
    const float drop = std::max(0.f, -fall_ * seconds);
    const glm::vec3 hip = eye_ - glm::vec3(0, kEyeHeight - kStep, 0);
    // Who stands is held by a step down, who falls not before the feet are there.
    const bool stands = fall_ <= 0 && meets(hip, {0, -1, 0}, kStep + (fall_ < 0 ? drop : kStep), ground);
    if (stands && jump) {
        fall_ = 3.4f;
    } else if (stands) {
        // Steps are climbed within a tenth of a second, not in one frame.
        const float rise = ground.position[1] + kEyeHeight - eye_.y;
        eye_.y += fall_ < 0 ? rise : rise * std::min(1.f, seconds * 12);
        fall_ = 0;
        return;
    }
    const float before = fall_;
    fall_ -= kGravity * seconds;
    // Off the world's rim there is nothing to fall onto.
    if (fall_ < 0 && !meets(eye_, {0, -1, 0}, 1e6f, ground)) {
        fall_ = 0;
        return;
    }
    eye_.y += (before + fall_) / 2 * seconds;
}

EspCamera ViewCamera::camera() const {
    EspCamera camera{};
    const glm::vec3 target = eye_ + distance_ * ahead();
    for (int i = 0; i < 3; ++i) {
        camera.eye[i] = eye_[i];
        camera.target[i] = target[i];
    }
    camera.up[1] = 1;
    camera.fovY = fovY_;
    camera.nearPlane = std::min(std::max(distance_ * .02f, reach_ * 1e-4f), std::min(.08f, reach_ * .02f));
    return camera;
}

Ray ViewCamera::ray(glm::vec2 at, float aspect, float shift) const {
    const float t = std::tan(fovY_ / 2);
    return {eye_,
            glm::normalize((2 * at.x - 1 - shift) * t * aspect * right() + (1 - 2 * at.y) * t * above() + ahead())};
}

bool ViewCamera::project(glm::vec3 point, float aspect, float shift, glm::vec2& at) const {
    const glm::vec3 d = point - eye_;
    const float depth = glm::dot(d, ahead()), t = std::tan(fovY_ / 2);
    if (depth < 1e-3f) return false;
    at.x = .5f * (glm::dot(d, right()) / (depth * t * aspect) + 1 + shift);
    at.y = .5f * (1 - glm::dot(d, above()) / (depth * t));
    return true;
}

float ViewCamera::pixelsPerMetre(float distance, float height) const {
    return height / (2 * std::max(distance, 1e-3f) * std::tan(fovY_ / 2));
}

}  // namespace sample
