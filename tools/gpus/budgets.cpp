#include "tools/gpus/budgets.hpp"

namespace espalier {
namespace {

// What hides the latency of memory: half of the subgroups that Navi 21 takes, three of Polaris' eight.
constexpr Budget kNavi{0, 128, 8}, kPolaris{0, 128, 3};

// Kernels that are beyond the budget, and what they take today: they may not take more.
struct Exception {
    std::string_view kernel;
    Budget navi, polaris;
};
constexpr Exception kExceptions[] = {
    {"expand/march.comp", kNavi, kPolaris},
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
