#include "tools/gpus/budgets.hpp"

namespace espalier {
namespace {

// What hides the latency of memory: half of the subgroups that Navi 21 takes, three of Polaris' eight.
constexpr Budget kNavi{0, 128, 8}, kPolaris{0, 128, 3};

// Kernels that are beyond the budget, and what they may take: what they take today.
struct Exception {
    std::string_view kernel;
    Budget navi, polaris;
};
constexpr Exception kExceptions[] = {
    // A step of the walk and the laying of a step's samples take 104 and 120 registers by themselves. Polaris has 256 a
    // lane, so that two subgroups fit.
    {"expand/march.comp", kNavi, {0, 128, 2}},
    {"expand/march_paper.comp", kNavi, {0, 128, 2}},
    {"expand/march_again.comp", kNavi, {0, 128, 1}},
    {"paint/smooth_walk.comp", kNavi, {0, 128, 2}},
    {"render/roof_cull_rows.comp", kNavi, {0, 128, 2}},
    // One kernel holds all operations of roofs.
    {"roof_growth/derive.comp", {225, 608, 4}, {390, 608, 1}},
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
