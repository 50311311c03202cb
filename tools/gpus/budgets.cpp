#include "tools/gpus/budgets.hpp"

namespace espalier {
namespace {

// What hides the latency of memory: half of the subgroups that Navi 21 takes, three of Polaris' eight.
constexpr Budget kNavi{0, 0, 8}, kPolaris{0, 0, 3};

// Kernels that are beyond the budget, or were and shall stay below, and what they may take: what they take today.
struct Exception {
    std::string_view kernel;
    Budget navi, polaris;
};
constexpr Exception kExceptions[] = {
    // Polaris has 256 registers a lane, so that three subgroups fit with 84 each. A stretch of the walk takes some 100
    // by itself, the laying of a step's samples 120, and the begin of a chunk 100.
    {"expand/march.comp", kNavi, {0, 0, 2}},
    {"expand/march_paper.comp", kNavi, {0, 0, 2}},
    {"expand/march_again.comp", kNavi, {0, 0, 2}},
    // A single group, so nothing else would run beside it.
    {"expand/avoid_settle.comp", kNavi, {0, 0, 2}},
    {"paint/smooth_walk.comp", kNavi, {0, 0, 2}},
    {"roof_growth/derive.comp", {0, 0, 10}, kPolaris},
    {"roof_growth/rows.comp", {0, 0, 12}, kPolaris},
    {"render/roof_cull_rows.comp", {0, 0, 12}, kPolaris},
    {"render/roof_write_rows.comp", {0, 0, 12}, kPolaris},
    // Patterns have all of their state in registers.
    {"pattern/derive.comp", {0, 0, 6}, {0, 0, 1}},
    {"pattern/meet.comp", kNavi, {0, 0, 2}},
    {"pattern/place.comp", {0, 0, 6}, {0, 0, 1}},
};

}  // namespace

Budget budgetOf(std::string_view chip, std::string_view kernel) {
    const bool polaris = chip.starts_with("polaris");
    for (const Exception& e : kExceptions)
        if (e.kernel == kernel) return polaris ? e.polaris : e.navi;
    return polaris ? kPolaris : kNavi;
}

bool within(const KernelCost& cost, const Budget& budget) {
    return cost.spilledVector + cost.spilledScalar <= budget.spilled && cost.scratchBytes <= budget.scratchBytes &&
           cost.subgroups >= budget.subgroups;
}

}  // namespace espalier
