// Points of the window to points of the scene and back, and cameras that see what they are to.
#include <algorithm>
#include <cmath>

#include "plugin_api/espalier.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

float Workspace::panelUnits() const {
    return editing && layout.panel ? std::round(std::min(layout.panelWidth * scale, window.x * .6f)) : 0;
}

float Workspace::freeAspect() const {
    return std::max(1.f, window.x - panelUnits()) / std::max(1.f, window.y);
}

// What is looked at stands in the middle of what the panel leaves free.
float Workspace::shift() const {
    return panelUnits() / std::max(1.f, window.x);
}

std::pair<glm::vec3, glm::vec3> Workspace::bounds() const {
    glm::vec3 low(1e30f), high(-1e30f);
    for (const auto& surface : scene().surfaces) {
        EspSurfaceInfo info;
        if (espSurfaceInfo(context.get(), surface.id, &info) != ESP_OK) continue;
        low = glm::min(low, vec(info.boundsMin));
        high = glm::max(high, vec(info.boundsMax));
    }
    const uint32_t houses = low.x > high.x ? espHouseCount(context.get()) : 0;
    for (uint32_t i = 0; i < houses; ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context.get(), i, &info) != ESP_OK) continue;
        low = glm::min(low, vec(info.boundsMin));
        high = glm::max(high, vec(info.boundsMax));
    }
    return low.x > high.x ? std::pair(glm::vec3(0), glm::vec3(1)) : std::pair(low, high);
}

float Workspace::reach() const {
    const auto [low, high] = bounds();
    return glm::distance(low, high);
}

void Workspace::lookFrom(const EspCamera& from) {
    camera.set(from, reach());
    redraw = true;
}

void Workspace::frameAll() {
    lookFrom(esp::frameAll(context.get()));
    if (scene().surfaces.empty() && espHouseCount(context.get()) == 0) return;
    // A village around what plants grow on isn't what is worked on.
    const auto [low, high] = bounds();
    camera.frame(low, high, freeAspect());
    // A box is larger than what is in it: what of that is seen from here is gone nearer to.
    if (const std::vector<glm::vec3> seen = seenGround(); !seen.empty()) camera.frame(seen, freeAspect());
}

// Points of surfaces in the view as it is, near enough to each other to tell how far these reach, and seeds. Floors at
// the foot of what stands on them reach further than what is worked on: without them, unless hardly anything is left.
std::vector<glm::vec3> Workspace::seenGround() const {
    constexpr int kAcross = 80;
    constexpr size_t kLeast = 200;
    constexpr float kFoot = .12f, kFloor = .8f;
    const auto [low, high] = bounds();
    const float foot = low.y + kFoot * (high.y - low.y);
    const float step = (window.x - panelUnits()) / kAcross;
    std::vector<glm::vec3> standing, points;
    for (float x = panelUnits() + step / 2; x < window.x; x += step)
        for (float y = step / 2; y < window.y; y += step)
            if (const auto met = pick({x, y})) {
                points.push_back(vec(met->position));
                if (met->normal[1] < kFloor || met->position[1] > foot) standing.push_back(points.back());
            }
    if (points.size() < kLeast) return {};
    if (standing.size() > kLeast) points = std::move(standing);
    // Walls that are ground bear a roof, which belongs to them.
    constexpr glm::vec3 kNear(.3f);
    std::vector<glm::vec3> corners;
    for (uint32_t i = 0; i < espHouseCount(context.get()); ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context.get(), i, &info) != ESP_OK) continue;
        const glm::vec3 least = vec(info.boundsMin) - kNear, most = vec(info.boundsMax) + kNear;
        if (std::ranges::any_of(points, [&](glm::vec3 p) { return glm::clamp(p, least, most) == p; }))
            for (int c = 0; c < 4; ++c)
                corners.emplace_back(c & 1 ? most.x : least.x, most.y, c & 2 ? most.z : least.z);
    }
    points.insert(points.end(), corners.begin(), corners.end());
    for (const auto& seed : scene().seeds) points.push_back(vec(seed.position));
    return points;
}

void Workspace::frameChosen() {
    std::vector<glm::vec3> points;
    if (tool == Tool::seeds)
        for (const auto& seed : scene().seeds)
            if (EspPlantInfo plant; selected.count(seed.key)) {
                points.push_back(vec(seed.position));
                if (espPlantInfo(context.get(), seed.planted, &plant) != ESP_OK) continue;
                points.insert(points.end(), {vec(plant.boundsMin), vec(plant.boundsMax)});
            }
    if (tool == Tool::paint && hit) {  // as much of it as the brush would paint
        const glm::vec3 at = vec(hit->position), around(brushRadius());
        points = {at - around, at + around};
    }
    if (tool == Tool::branch)
        for (const EspPathSample& sample : path) points.push_back(vec(sample.position));
    EspHouseInfo info;
    if (tool == Tool::houses && house && espHouseInfo(context.get(), *house, &info) == ESP_OK)
        points = {vec(info.boundsMin), vec(info.boundsMax)};
    if (points.empty()) return frameAll();
    glm::vec3 low = points[0], high = points[0];
    for (const glm::vec3& point : points) low = glm::min(low, point), high = glm::max(high, point);
    // A seed from which nothing has grown is a point: some of what is around it is seen with it.
    const glm::vec3 centre = (low + high) * .5f, around(std::min(.6f, .07f * reach()));
    camera.frame(glm::min(low, centre - around), glm::max(high, centre + around), freeAspect());
    redraw = true;
}

Ray Workspace::rayThrough(glm::vec2 at) const {
    return camera.ray(at / window, window.x / window.y, shift());
}

std::optional<glm::vec2> Workspace::place(glm::vec3 point) const {
    glm::vec2 at;
    if (!camera.project(point, window.x / window.y, shift(), at)) return {};
    return at * window;
}

bool Workspace::visible(glm::vec3 point) const {
    const glm::vec3 eye = camera.eye(), to = point - eye;
    const float distance = glm::length(to);
    const glm::vec3 direction = to / std::max(distance, 1e-6f);
    EspHit found;
    return espPick(context.get(), &eye.x, &direction.x, &found) != ESP_OK ||
           found.distance > distance - std::max(.02f, distance * .01f);
}

}  // namespace sample
