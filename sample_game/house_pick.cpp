// Which house a ray meets: its walls up to the eaves, and the level of the eaves for what lies above.
#include <algorithm>
#include <cmath>

#include "sample_game/workspace.hpp"

namespace sample {
namespace {

using espalier::scene::House;
using espalier::scene::houseNow;

constexpr float kMissed = 1e30f;

// Where along the ray the box begins; a ray that starts inside meets it at 0.
float enterBox(const Ray& ray, const float low[3], const float high[3]) {
    float first = 0, last = kMissed;
    for (int i = 0; i < 3; ++i) {
        const float inverse = 1 / (ray.direction[i] != 0 ? ray.direction[i] : 1e-20f);
        const float a = (low[i] - ray.origin[i]) * inverse, b = (high[i] - ray.origin[i]) * inverse;
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last ? first : kMissed;
}

bool inside(const std::vector<std::array<float, 2>>& ring, float x, float z) {
    bool in = false;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
        if ((ring[i][1] > z) != (ring[j][1] > z) &&
            x < (ring[j][0] - ring[i][0]) * (z - ring[i][1]) / (ring[j][1] - ring[i][1]) + ring[i][0])
            in = !in;
    return in;
}

float meet(const Ray& ray, const House& house, const EspHouseInfo& info) {
    const glm::vec3 &o = ray.origin, &d = ray.direction;
    float best = kMissed;
    const float level = (info.eaveHeight - o.y) / (d.y != 0 ? d.y : 1e-20f);
    if (level > 0 && inside(house.corners, o.x + level * d.x, o.z + level * d.z)) best = level;
    for (size_t i = 0; i < house.corners.size(); ++i) {
        const auto &a = house.corners[i], &b = house.corners[(i + 1) % house.corners.size()];
        const glm::vec2 ab(b[0] - a[0], b[1] - a[1]), oa(a[0] - o.x, a[1] - o.z);
        const float across = d.x * ab.y - d.z * ab.x;
        if (std::abs(across) < 1e-9f) continue;
        const float along = (oa.x * ab.y - oa.y * ab.x) / across, share = (oa.x * d.z - oa.y * d.x) / across;
        const float y = o.y + along * d.y;
        if (along > 0 && along < best && share >= 0 && share <= 1 && y >= info.baseHeight && y <= info.eaveHeight)
            best = along;
    }
    return best;
}

}  // namespace

std::optional<uint32_t> Workspace::pickHouse(glm::vec2 at) const {
    const Ray ray = camera.ray(at / window, window.x / window.y, shift());
    float best = kMissed;
    if (const auto before = pick(at)) best = before->distance;
    std::optional<uint32_t> found;
    for (uint32_t i = 0; i < espHouseCount(context.get()); ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context.get(), i, &info) != ESP_OK || enterBox(ray, info.boundsMin, info.boundsMax) > best)
            continue;
        const float along = meet(ray, houseNow(context.get(), i), info);
        if (along >= best) continue;
        best = along;
        found = i;
    }
    return found;
}

}  // namespace sample
