// In: a place. Out: patches of some metres with ragged borders, which thin out away from the court.
#include "tools/content/lawn.hpp"

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/site_plan.hpp"

namespace espalier::content {

Lawn lawnAt(glm::vec2 p) {
    const float about = ramp(19, 12, glm::distance(p, kCourt));
    const auto patches = [&](float metres, uint32_t salt, float rare) {
        const float ragged = fractal(p / metres, salt, 3) + 0.12f * noise(p / 0.31f, salt + 7);
        return about * ramp(rare, rare + 0.14f, ragged);
    };
    Lawn lawn;
    lawn.bare = patches(1.7f, 221, 0.44f);
    lawn.clover = patches(2.6f, 231, 0.28f) * (1 - lawn.bare);
    lawn.tall = patches(3.1f, 241, 0.26f) * (1 - lawn.bare) * (1 - lawn.clover);
    return lawn;
}

}  // namespace espalier::content
