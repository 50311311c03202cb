#pragma once

#include <vector>

#include "plugin_api/espalier.h"

namespace sample {

// [i]: whether the walk goes over a crossing from sample i to the next: to another chart or surface, or over a seam of
// a chart with itself, where the atlas is left at one place and entered at another far from it. One less than samples.
std::vector<bool> crossingsOf(const std::vector<EspPathSample>& path);

}  // namespace sample
