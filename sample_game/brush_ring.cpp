// A place and a radius -> a circle that lies on the surface.
#include "sample_game/brush_ring.hpp"

#include <algorithm>
#include <cmath>

namespace sample {
namespace {

// What the brush reaches of the surface, as seen along the centre's normal.
struct Disc {
    const Workspace& work;
    glm::vec3 centre, normal, u, v;
    float radius;
    bool flat;  // over a town, which is painted from above
    // The outermost point this way, of the unit circle, that lies within `share` of the radius. It goes around what is
    // thin and bridges gaps.
    glm::vec3 rim(glm::vec2 way, float share) const {
        if (flat) return centre + share * radius * (way.x * u + way.y * v);
        constexpr int kSteps = 6, kHalvings = 3;
        float inside = 0, outside = share;
        glm::vec3 point = centre;
        for (int i = kSteps; i > 0 && inside == 0; --i) {
            const float at = share * float(i) / kSteps;
            (reaches(at * way, share, point) ? inside : outside) = at;
        }
        for (int i = 0; i < kHalvings && inside < outside; ++i) {
            const float at = (inside + outside) / 2;
            (reaches(at * way, share, point) ? inside : outside) = at;
        }
        return point;
    }

  private:
    // Whether a surface lies within the share of the radius, below or above a place of the circle: then where.
    bool reaches(glm::vec2 place, float share, glm::vec3& point) const {
        constexpr float kSlack = .02f;  // a flat surface lies on the circle
        const float half = std::sqrt(std::max(share * share - glm::dot(place, place), 0.f)) + kSlack * share;
        const glm::vec3 from = centre + radius * (place.x * u + place.y * v + half * normal), down = -normal;
        EspHit met;
        if (espPick(work.context.get(), &from.x, &down.x, &met) != ESP_OK || met.distance > 2 * half * radius)
            return false;
        point = vec(met.position);
        return true;
    }
};

// The ring's runs of places in the window that are seen and lie next to each other in the scene, no further than
// `apart`.
std::vector<std::vector<ImVec2>> runsOf(const Workspace& work, const std::vector<glm::vec3>& ring,
                                        const std::vector<bool>& hidden, float apart) {
    const size_t count = ring.size();
    std::vector<std::optional<glm::vec2>> places;
    for (const glm::vec3& point : ring) places.push_back(work.place(point));
    const auto joined = [&](size_t i) {  // with the one before
        const size_t before = (i + count - 1) % count;
        return !hidden[i] && !hidden[before] && places[i] && places[before] &&
               glm::distance(ring[i], ring[before]) < apart;
    };
    size_t first = 0;
    while (first < count && joined(first)) ++first;
    std::vector<std::vector<ImVec2>> runs;
    for (size_t n = 0; n <= count; ++n) {  // a ring that is whole ends where it began
        const size_t i = (first + n) % count;
        if (n == 0 || !joined(i)) runs.emplace_back();
        if (places[i] && !hidden[i]) runs.back().push_back({places[i]->x, places[i]->y});
    }
    return runs;
}

}  // namespace

void drawBrushRing(const Workspace& work, const EspHit& hit, const BrushRing& brush, ImU32 colour) {
    Disc disc{work, vec(hit.position), glm::normalize(vec(hit.normal)), {}, {}, brush.radius, brush.flat};
    tangents(disc.normal, disc.u, disc.v);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const auto ring = [&](float share) {
        constexpr int kPoints = 40;
        constexpr float kApart = .5f;  // of the radius: beyond a gap, or on something that stands before the rest
        std::vector<glm::vec3> points;
        for (int i = 0; i < kPoints; ++i) {
            const float angle = 6.2831853f * float(i) / kPoints;
            points.push_back(disc.rim({std::cos(angle), std::sin(angle)}, share));
        }
        // Over a town the circle lies flat, in houses too.
        const std::vector<bool> hidden = disc.flat ? std::vector<bool>(points.size()) : work.hidden(points);
        return runsOf(work, points, hidden, kApart * share * disc.radius);
    };
    const auto draw = [&](const std::vector<std::vector<ImVec2>>& runs, ImU32 with, float width) {
        for (const auto& run : runs) list.AddPolyline(run.data(), int(run.size()), with, 0, width * work.scale);
    };
    const auto outer = ring(1);
    draw(outer, IM_COL32(0, 0, 0, 160), 4);
    draw(outer, colour, 2);
    if (brush.hardness > .05f) draw(ring(brush.hardness), (colour & 0xFFFFFF) | 0x70000000, 1);
    if (const auto at = work.place(disc.centre)) list.AddCircleFilled({at->x, at->y}, 2.5f * work.scale, colour);
}

}  // namespace sample
