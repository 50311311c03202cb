// In: instances of many colours. Out: few groups of nearly one each.
#include "tools/export/colours.hpp"

#include <cmath>
#include <map>

namespace espalier::exporting {
namespace {

// Steps are even to the eye: of square roots.
std::array<int, 3> stepOf(const float colour[3], float steps) {
    std::array<int, 3> step;
    for (size_t i = 0; i < 3; ++i) step[i] = int(std::lround(std::sqrt(std::max(colour[i], 0.0f)) * steps));
    return step;
}

}  // namespace

std::vector<ColourGroup> groupedByColour(const std::vector<EspPartInstance>& instances, size_t most) {
    std::map<std::array<int, 3>, ColourGroup> groups;
    for (float steps = 256; steps >= 1; steps *= .8f) {
        groups.clear();
        for (uint32_t i = 0; i < instances.size() && groups.size() <= most; ++i)
            groups[stepOf(instances[i].colour, steps)].instances.push_back(i);
        if (groups.size() <= most) break;
    }
    std::vector<ColourGroup> out;
    for (auto& [step, group] : groups) {
        double sum[3] = {};
        for (uint32_t i : group.instances)
            for (size_t k = 0; k < 3; ++k) sum[k] += double(instances[i].colour[k]);
        for (size_t k = 0; k < 3; ++k) group.colour[k] = float(sum[k] / double(group.instances.size()));
        out.push_back(std::move(group));
    }
    return out;
}

}  // namespace espalier::exporting
