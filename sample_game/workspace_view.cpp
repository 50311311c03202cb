// Points of the window to points of the scene and back, and cameras that see what they are to.
#include <algorithm>
#include <cmath>

#include "plugin_api/espalier.hpp"
#include "sample_game/workspace.hpp"

namespace sample {

using espalier::document::SetBookmark;

float Workspace::panelUnits() const {
    return editing && layout.panel ? std::round(std::min(layout.panelWidth * scale, window.x * .6f)) : 0;
}

float Workspace::freeAspect() const {
    return std::max(1.f, window.x - panelUnits()) / std::max(1.f, viewSize().y);
}

float Workspace::dockUnits() const {
    if (!editing || scene().graphs.empty()) return 0;
    const float bar = kTimeBar * scale, most = std::max(0.f, window.y * .75f - bar);
    return std::round(bar + (graphs.nodes ? std::min(graphs.height * scale, most) : 0));
}

glm::vec2 Workspace::viewSize() const {
    return {window.x, std::max(1.f, window.y - dockUnits())};
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
    if (low.x > high.x)
        for (const auto& graph : scene().graphs) {
            EspGraphStats shown;
            if (espGraphStats(context.get(), graph.id, &shown) != ESP_OK || shown.parts == 0) continue;
            low = glm::min(low, vec(shown.boundsMin));
            high = glm::max(high, vec(shown.boundsMax));
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

bool Workspace::writeView(const std::string& file, uint32_t width, uint32_t height) {
    esp::DrawDef draw;
    draw.look = scene().look;
    draw.look.view = ESP_VIEW_SHADED;
    draw.camera = camera.camera();
    draw.width = width;
    draw.height = height;
    std::vector<uint8_t> rgba(size_t(width) * height * 4);
    // The first picture after a change of size may fade levels of detail.
    bool drawn = true;
    for (int i = 0; i < 2; ++i) drawn = drawn && espDraw(context.get(), &draw) == ESP_OK;
    if (!drawn || espReadPixels(context.get(), rgba.data(), rgba.size()) != ESP_OK) {
        error = file + ": " + espLastError(context.get());
        return false;
    }
    redraw = true;
    return espalier::scene::writePng(file, rgba.data(), width, height, error);
}

void Workspace::keepBookmark(uint32_t digit) {
    const EspCamera now = camera.camera();
    if (perform(SetBookmark{digit, true, array(vec(now.eye)), array(vec(now.target)), now.fovY}))
        say("Bookmark " + std::to_string(digit) + " is this view: Shift+" + std::to_string(digit) + " shows it");
}

bool Workspace::lookFromBookmark(uint32_t digit) {
    for (const espalier::scene::Bookmark& bookmark : scene().bookmarks) {
        if (bookmark.digit != digit) continue;
        EspCamera to = start;
        std::ranges::copy(bookmark.eye, to.eye);
        std::ranges::copy(bookmark.target, to.target);
        to.fovY = bookmark.fov;
        lookFrom(to);
        say("Bookmark " + std::to_string(digit));
        return true;
    }
    const std::string name = std::to_string(digit);
    say("There is no bookmark " + name + ": Ctrl+" + name + " keeps the view");
    return false;
}

void Workspace::frameAll() {
    lookFrom(esp::frameAll(context.get()));
    if (scene().surfaces.empty() && espHouseCount(context.get()) == 0) return;
    if (scene().surfaces.empty()) {
        // A town's far-off houses would make it small: what stands in that view is what fills this one.
        if (const std::vector<glm::vec3> town = seenHouses(); !town.empty()) camera.frame(town, freeAspect());
        return;
    }
    // A village around what plants grow on isn't what is worked on.
    const auto [low, high] = bounds();
    camera.frame(low, high, freeAspect());
    // A box is larger than what is in it: what of that is seen from here is gone nearer to.
    if (const std::vector<glm::vec3> seen = seenGround(); !seen.empty()) camera.frame(seen, freeAspect());
}

// Corners of the houses whose middles are in the view as it is.
std::vector<glm::vec3> Workspace::seenHouses() const {
    std::vector<glm::vec3> corners;
    for (uint32_t i = 0; i < espHouseCount(context.get()); ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context.get(), i, &info) != ESP_OK) continue;
        const glm::vec3 least = vec(info.boundsMin), most = vec(info.boundsMax);
        const auto at = place((least + most) * .5f);
        if (!at || at->x < panelUnits() || at->x > window.x || at->y < 0 || at->y > window.y) continue;
        for (int c = 0; c < 8; ++c) corners.push_back(glm::mix(least, most, glm::vec3(c & 1, c >> 1 & 1, c >> 2 & 1)));
    }
    return corners;
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
    const glm::vec2 view = viewSize();
    return camera.ray(at / view, view.x / view.y, shift());
}

std::optional<glm::vec2> Workspace::place(glm::vec3 point) const {
    glm::vec2 at;
    const glm::vec2 view = viewSize();
    if (!camera.project(point, view.x / view.y, shift(), at)) return {};
    return at * view;
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
