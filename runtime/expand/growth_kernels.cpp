// Kernels of growth by name, and what each of them is specialised to.
#include "runtime/expand/growth_kernels.hpp"

#include "runtime/core/check.hpp"
#include "shaders/expand/lane_words.h"  // whose sums are checked where C++ reads them
#include "shaders/shared/expand_env.h"
#include "shaders/shared/rule_map.h"

namespace espalier {
namespace {

// Which specialization constants a kernel has, as bits.
constexpr uint32_t kTables = 1u << 0, kFeatureSet = 1u << 1;

struct Row {
    GrowthKernel kernel;
    const char* shader;
    uint32_t constants;
};
constexpr Row kRows[] = {
    {GrowthKernel::tables, "expand/tables.comp", 0},
    {GrowthKernel::march, "expand/march.comp", kTables | kFeatureSet},
    {GrowthKernel::marchPaper, "expand/march_paper.comp", kTables | kFeatureSet},
    {GrowthKernel::terminals, "expand/terminals.comp", kTables | kFeatureSet},
    {GrowthKernel::branches, "expand/branches.comp", 0},
    {GrowthKernel::fit, "expand/fit.comp", 0},
    {GrowthKernel::find, "expand/again_find.comp", 0},
    {GrowthKernel::start, "expand/again_start.comp", 0},
    {GrowthKernel::marchAgain, "expand/march_again.comp", kTables | kFeatureSet},
    {GrowthKernel::settle, "expand/again_settle.comp", 0},
    {GrowthKernel::work, "expand/again_work.comp", 0},
    {GrowthKernel::terminalsAgain, "expand/terminals_again.comp", kTables | kFeatureSet},
    {GrowthKernel::apply, "expand/again_apply.comp", 0},
    {GrowthKernel::thickness, "expand/again_thickness.comp", 0},
    {GrowthKernel::fitAgain, "expand/again_fit.comp", 0},
    {GrowthKernel::compactPlaces, "expand/compact_places.comp", 0},
    {GrowthKernel::compactNodes, "expand/compact_nodes.comp", 0},
    {GrowthKernel::compactLeaves, "expand/compact_leaves.comp", 0},
};

constexpr bool inOrder() {
    for (size_t i = 0; i < std::size(kRows); ++i)
        if (kRows[i].kernel != GrowthKernel(i)) return false;
    return true;
}
static_assert(inOrder());

const Row& rowOf(GrowthKernel kernel) {
    return kRows[size_t(kernel)];
}

}  // namespace

void GrowthKernels::use(uint32_t features) {
    if ((features | features_) == features_) return;
    features_ |= features;
    std::erase_if(programs_, [](const auto& made) { return (rowOf(made.first.first).constants & kFeatureSet) != 0; });
}

GrowthKernels::Key GrowthKernels::keyOf(GrowthKernel kernel, bool tablesByAddress) {
    return {kernel, tablesByAddress && (rowOf(kernel).constants & kTables) != 0};
}

Status GrowthKernels::make(std::initializer_list<GrowthKernel> kernels, bool tablesByAddress) {
    for (const GrowthKernel kernel : kernels) {
        Program& program = programs_[keyOf(kernel, tablesByAddress)];
        if (program) continue;
        const Row& row = rowOf(kernel);
        std::vector<SpecConstant> constants;
        if (row.constants & kTables) constants.push_back({kConstantTablesByAddress, tablesByAddress ? 1u : 0u});
        if (row.constants & kFeatureSet) constants.push_back({kConstantFeatures, features_});
        Status made = makeCompute(device_, {{program, row.shader, exactly(std::move(constants)), kExpandGroup}});
        if (!made) return made;
    }
    return Done{};
}

const Program& GrowthKernels::get(GrowthKernel kernel, bool tablesByAddress) const {
    const auto made = programs_.find(keyOf(kernel, tablesByAddress));
    require(made != programs_.end() && made->second, "a kernel of growth is made before it is used");
    return made->second;
}

}  // namespace espalier
