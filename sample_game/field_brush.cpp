// Moves of the mouse -> points of a stroke over the field in hand.
#include "sample_game/field_brush.hpp"

#include <algorithm>

#include "sample_game/brush_ring.hpp"

namespace sample {
namespace {

using espalier::document::BrushField;
using espalier::scene::Placing;

constexpr float kPixelsBetweenPlaces = 3;
constexpr float kBetweenPoints = .2f;  // radii
constexpr float kAsunder = 1.5f;       // radii: the mouse has left the surface, and another stroke begins

}  // namespace

bool brushesField(const Workspace& work) {
    return work.field.kind == kComb || work.field.kind == kSmooth;
}

float fieldReach(const Workspace& work) {
    return work.field.radius > 0 ? work.field.radius : .1f * work.reach();
}

float mostFieldReach(const Workspace& work) {
    return std::max(work.reach(), 2 * kSmallestBrush);
}

std::optional<size_t> surfaceUnder(const Workspace& work, const EspHit& hit) {
    const auto& surfaces = work.scene().surfaces;
    for (size_t i = 0; i < surfaces.size(); ++i)
        if (surfaces[i].id.id == hit.surface.id) return i;
    return std::nullopt;
}

std::optional<size_t> FieldBrush::begin(Workspace& work, glm::vec2 at, uint32_t gesture) {
    const auto hit = work.pick(at);
    const auto surface = hit ? surfaceUnder(work, *hit) : std::nullopt;
    if (!surface) return std::nullopt;
    surface_ = *surface;
    gesture_ = gesture;
    const float scale = work.scene().surfaces[surface_].placing.scale;
    stroke_ = {work.field.kind, fieldReach(work) / scale, work.field.strength, {}};
    walked_ = at;
    last_.reset();
    begun_ = changed_ = false;
    lay(work, at);
    if (work.field.kind == kSmooth) perform(work);
    return surface;
}

void FieldBrush::lay(const Workspace& work, glm::vec2 at) {
    const auto hit = work.pick(at);
    if (!hit || surfaceUnder(work, *hit) != surface_) return;
    const glm::vec3 point = vec(hit->position);
    if (last_ && glm::distance(point, *last_) < kBetweenPoints * fieldReach(work)) return;
    last_ = point;
    stroke_.points.push_back(carried(array(point), work.scene().surfaces[surface_].placing, Placing(), true));
}

// A comb with one point does nothing yet.
void FieldBrush::perform(Workspace& work) {
    if (stroke_.points.empty() || (!begun_ && work.field.kind == kComb && stroke_.points.size() < 2)) return;
    if (!work.perform(BrushField{uint32_t(surface_), work.field.name, stroke_, begun_}, gesture_)) return;
    begun_ = changed_ = true;
    stroke_.points.clear();
}

void FieldBrush::follow(Workspace& work, glm::vec2 at) {
    const float length = glm::distance(at, walked_);
    const int steps = int(std::min(length / kPixelsBetweenPlaces, 1e4f));
    const glm::vec2 step = (at - walked_) * (kPixelsBetweenPlaces / std::max(length, 1e-6f));
    for (int i = 0; i < steps; ++i) {
        walked_ += step;
        const auto before = last_;
        lay(work, walked_);
        if (!before || glm::distance(*last_, *before) < kAsunder * fieldReach(work)) continue;
        const auto beyond = stroke_.points.back();
        stroke_.points.pop_back();
        perform(work);
        stroke_.points = {beyond};
        begun_ = false;
    }
    perform(work);
}

void FieldBrush::draw(const Workspace& work) const {
    if (!work.hit) return;
    drawBrushRing(work, *work.hit, {fieldReach(work), 0, false},
                  work.field.kind == kSmooth ? kSmoothRing : IM_COL32(255, 190, 60, 255));
}

}  // namespace sample
