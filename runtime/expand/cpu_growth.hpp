#pragma once

// The CPU reference of expansion: the kernels' own text compiled as C++ (-ffp-contract=off), on one thread. It is the
// debugger of growth and what the GPU's growth is compared with, by key.

#include <functional>
#include <string>
#include <vector>

#include "runtime/expand/growth_stages.hpp"

namespace espalier {

struct CpuGrowth : GrowthRecords {
    GrowthStats stats;
};

// Grows waves [0, most) until one is empty, and returns which.
using March = std::function<uint32_t(ExpandEnv env, const ItemQueues& queues, uint32_t most)>;

// All addresses in `inputs` (surfaces, layers, rule maps) are pointers here. room: to begin with; what takes more is
// grown again from the start, as on a GPU. march: in place of the reference's own. Fails as Growth::grow does.
Result<CpuGrowth> growOnCpu(const GrowthInputs& inputs, GrowthRoom room = {}, const March& march = {});

// How two growths of the same inputs differ, branch by branch; for tests and reports.
struct GrowthDifference {
    uint32_t branches = 0;           // keys in either
    uint32_t alike = 0;              // same key, nodes alike to the bit
    float farthest = 0;              // metres between nodes of branches with as many nodes, object space
    std::vector<std::string> notes;  // for the first few that differ: the key and the decision that differed
};
GrowthDifference compareGrowth(const GrowthRecords& a, const GrowthRecords& b);

}  // namespace espalier
