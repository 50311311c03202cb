// A walk's samples -> the steps of it that jump in the atlas.
#include "sample_game/crossings.hpp"

#include <algorithm>
#include <cmath>

namespace sample {
namespace {

constexpr float kFar = 8;        // times as far in the atlas as the walk's steps are in the median
constexpr float kLeast = 1e-3f;  // about a texel: less is rounding

bool sameChart(const EspPathSample& a, const EspPathSample& b) {
    return a.chart == b.chart && a.surface.id == b.surface.id;
}
float inAtlas(const EspPathSample& a, const EspPathSample& b) {
    return std::hypot(b.uv[0] - a.uv[0], b.uv[1] - a.uv[1]);
}
// In the atlas, by metres on the surface.
float stretch(const EspPathSample& a, const EspPathSample& b) {
    const float metres =
        std::hypot(b.position[0] - a.position[0], b.position[1] - a.position[1], b.position[2] - a.position[2]);
    return inAtlas(a, b) / std::max(metres, 1e-6f);
}

}  // namespace

std::vector<bool> crossingsOf(const std::vector<EspPathSample>& path) {
    std::vector<float> stretches;
    for (size_t i = 0; i + 1 < path.size(); ++i)
        if (sameChart(path[i], path[i + 1])) stretches.push_back(stretch(path[i], path[i + 1]));
    float usual = 0;
    if (!stretches.empty()) {
        const auto middle = stretches.begin() + std::ptrdiff_t(stretches.size() / 2);
        std::nth_element(stretches.begin(), middle, stretches.end());
        usual = *middle;
    }
    std::vector<bool> crossings;
    for (size_t i = 0; i + 1 < path.size(); ++i)
        crossings.push_back(!sameChart(path[i], path[i + 1]) ||
                            (stretch(path[i], path[i + 1]) > kFar * usual && inAtlas(path[i], path[i + 1]) > kLeast));
    return crossings;
}

}  // namespace sample
