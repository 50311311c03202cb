// Which house a ray meets: its walls, and above them a roof that rises from the whole outline, or, where that is
// missed, all that lies below the ridge.
#include <algorithm>
#include <cmath>

#include "sample_game/segment.hpp"
#include "sample_game/workspace.hpp"

namespace sample {
namespace {

using espalier::scene::House;
using espalier::scene::houseNow;
using espalier::scene::ringOf;

constexpr float kMissed = 1e30f;
constexpr int kSteps = 96;  // through a house's box
constexpr float kUsualSlope = 1;
constexpr float kOwnDepth = .3f;  // metres of a wall or roof that what lies on it isn't hidden by

// Where along the ray the box begins and ends; a ray that starts inside meets it at 0.
bool crossBox(const Ray& ray, const float low[3], const float high[3], float& first, float& last) {
    first = 0;
    last = kMissed;
    for (int i = 0; i < 3; ++i) {
        const float inverse = 1 / (ray.direction[i] != 0 ? ray.direction[i] : 1e-20f);
        const float a = (low[i] - ray.origin[i]) * inverse, b = (high[i] - ray.origin[i]) * inverse;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

// f(a, b): each side of the outline and of courtyards.
template <class F>
void overSides(const House& house, const F& f) {
    for (size_t i = 0; i < house.corners.size(); ++i) {
        const auto &a = house.corners[i], &b = house.corners[ringOf(house, i).after(i)];
        f(glm::vec2(a[0], a[1]), glm::vec2(b[0], b[1]));
    }
}

// How far inside the outline, and from courtyards, the point lies; negative: outside, or in one of these.
float depth(const House& house, glm::vec2 p) {
    bool in = false;
    float least = kMissed;
    overSides(house, [&](glm::vec2 a, glm::vec2 b) {
        if ((b.y > p.y) != (a.y > p.y) && p.x < (a.x - b.x) * (p.y - b.y) / (a.y - b.y) + b.x) in = !in;
        least = std::min(least, nearestOn(a, b, p).second);
    });
    return in ? least : -1;
}

// Of the wall that the ray meets there, towards it; of a roof, upward.
glm::vec3 facing(const House& house, const Ray& ray, float along) {
    const glm::vec3 at = ray.origin + along * ray.direction;
    const glm::vec2 p(at.x, at.z), from(ray.direction.x, ray.direction.z);
    glm::vec3 normal(0, 1, 0);
    if (glm::length(from) < .1f) return normal;
    float least = kMissed;
    overSides(house, [&](glm::vec2 a, glm::vec2 b) {
        const float distance = nearestOn(a, b, p).second;
        if (distance >= least || glm::distance(a, b) < 3e-5f) return;
        least = distance;
        const glm::vec2 across = glm::normalize(glm::vec2(b.y - a.y, a.x - b.x));
        const float side = glm::dot(across, from) > 0 ? -1.f : 1.f;
        normal = {side * across.x, 0, side * across.y};
    });
    return normal;
}

float meet(const Ray& ray, const House& house, const EspHouseInfo& info, bool sloped) {
    float first = 0, last = 0;
    if (!crossBox(ray, info.boundsMin, info.boundsMax, first, last)) return kMissed;
    const float slope = info.slope > 0 ? info.slope : kUsualSlope;
    const auto within = [&](float along) {
        const glm::vec3 p = ray.origin + along * ray.direction;
        const float in = depth(house, {p.x, p.z});
        if (in < 0 || p.y < info.boundsMin[1]) return false;
        const float roof = info.boundsMax[1] - info.ridgeHeight + info.eaveHeight + slope * in;
        return p.y <= (sloped ? std::min(roof, info.boundsMax[1]) : info.boundsMax[1]);
    };
    const float step = (last - first) / kSteps;
    for (int i = 0; i <= kSteps; ++i) {
        float at = first + step * float(i);
        if (!within(at)) continue;
        for (float back = step; i > 0 && back > .01f; back /= 2)
            if (within(at - back / 2)) at -= back / 2;
        return at;
    }
    return kMissed;
}

}  // namespace

std::optional<HouseHit> Workspace::meetHouse(const Ray& ray, float before, bool boxes) const {
    for (const bool sloped : {true, false}) {
        if (!sloped && !boxes) break;
        HouseHit best{0, before};
        for (uint32_t i = 0; i < espHouseCount(context.get()); ++i) {
            EspHouseInfo info;
            float first = 0, last = 0;
            if (espHouseInfo(context.get(), i, &info) != ESP_OK || info.hidden ||
                !crossBox(ray, info.boundsMin, info.boundsMax, first, last) || first > best.distance)
                continue;
            const float along = meet(ray, houseNow(context.get(), i), info, sloped);
            if (along < best.distance) best = {i, along};
        }
        if (best.distance < before) return best;
    }
    return {};
}

std::vector<bool> Workspace::hidden(const std::vector<glm::vec3>& points) const {
    glm::vec3 low = camera.eye(), high = low;
    for (const glm::vec3& point : points) low = glm::min(low, point), high = glm::max(high, point);
    std::vector<std::pair<House, EspHouseInfo>> between;
    for (uint32_t i = 0; i < espHouseCount(context.get()); ++i)
        if (EspHouseInfo info; espHouseInfo(context.get(), i, &info) == ESP_OK && !info.hidden &&
                               glm::all(glm::lessThanEqual(vec(info.boundsMin), high)) &&
                               glm::all(glm::greaterThanEqual(vec(info.boundsMax), low)))
            between.emplace_back(houseNow(context.get(), i), info);
    std::vector<bool> found;
    for (const glm::vec3& point : points) {
        const glm::vec3 to = point - camera.eye();
        const float distance = glm::length(to), nearly = std::min(.97f * distance, distance - kOwnDepth);
        const Ray ray{camera.eye(), to / std::max(distance, 1e-6f)};
        const auto hides = [&](const auto& one) { return meet(ray, one.first, one.second, true) < nearly; };
        found.push_back(nearly > 0 && (!visible(point) || std::ranges::any_of(between, hides)));
    }
    return found;
}

std::optional<uint32_t> Workspace::pickHouse(glm::vec2 at) const {
    const auto before = pick(at);  // walls that are ground lie before those that are drawn
    const auto found = meetHouse(rayThrough(at), before ? before->distance + kOwnDepth : kMissed);
    return found ? std::optional(found->house) : std::nullopt;
}

std::optional<EspTownInfo> Workspace::town() const {
    EspTownInfo info;
    if (espHouseCount(context.get()) == 0 || espTownInfo(context.get(), &info) != ESP_OK) return {};
    return info;
}

bool Workspace::meets(const Ray& ray, float reach, EspHit& met) const {
    bool found = espPick(context.get(), &ray.origin.x, &ray.direction.x, &met) == ESP_OK && met.distance <= reach;
    const auto nearer = [&](float distance, glm::vec3 normal) {
        const glm::vec3 point = ray.origin + distance * ray.direction;
        met = {};
        met.distance = distance;
        std::copy(&point.x, &point.x + 3, met.position);
        std::copy(&normal.x, &normal.x + 3, met.normal);
        found = true;
    };
    const std::optional<EspTownInfo> there = town();
    if ((scene().look.ground || there) && ray.direction.y != 0) {
        const float level = scene().look.ground ? scene().look.groundLevel : there->groundHeight;
        const float down = (level - ray.origin.y) / ray.direction.y;
        if (down >= 0 && down < (found ? met.distance : reach)) nearer(down, {0, 1, 0});
    }
    // Who is inside a house already, by G, gets out again.
    const auto wall = meetHouse(ray, found ? met.distance : reach);
    if (wall && wall->distance > 0)
        nearer(wall->distance, facing(houseNow(context.get(), wall->house), ray, wall->distance));
    return found;
}

std::optional<EspHit> Workspace::pickGround(glm::vec2 at) const {
    const std::optional<EspHit> ground = pick(at);
    return ground && meetHouse(rayThrough(at), ground->distance - kOwnDepth, false) ? std::nullopt : ground;
}

std::optional<EspHit> Workspace::aim(glm::vec2 at) const {
    std::optional<EspHit> surface = pickGround(at);
    const std::optional<EspTownInfo> there = townLayer(brush.layer) ? town() : std::nullopt;
    if (!there) return surface;
    const Ray ray = rayThrough(at);
    float nearest = surface ? surface->distance : kMissed;
    const float ground = (there->groundHeight - ray.origin.y) / (ray.direction.y != 0 ? ray.direction.y : 1e-20f);
    float met = ground > 0 && ground < 1e4f ? ground : kMissed;
    if (const auto wall = meetHouse(ray, std::min(nearest, met))) met = wall->distance;
    if (met >= nearest) return surface;
    EspHit over{};
    const glm::vec3 point = ray.origin + met * ray.direction;
    std::copy(&point.x, &point.x + 3, over.position);
    over.normal[1] = 1;
    over.distance = met;
    return over;
}

}  // namespace sample
