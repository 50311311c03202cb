#include "runtime/host/kernels.hpp"

namespace espalier {

HostKernel hostKernel(std::string_view shader) {
    for (const std::span<const HostRow> rows :
         {kGrowthRows, kRegrowthRows, kGapRows, kRoofRows, kPatternRows, kNodeRows, kFluidRows})
        for (const HostRow& row : rows)
            if (row.shader == shader) return row.run;
    return nullptr;
}

}  // namespace espalier
