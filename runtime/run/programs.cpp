#include "runtime/run/programs.hpp"

#include <algorithm>

namespace espalier {

Result<const Program*> Programs::of(const Kernel& kernel, const std::vector<SpecConstant>& constants) {
    std::string name = kernel.shader;
    for (const SpecConstant& c : constants) name += " " + std::to_string(c.id) + "=" + std::to_string(c.value);
    Made& made = made_[name];
    if (made.program) return &made.program;
    made.constants = constants;
    Status done = makeCompute(device_, {{made.program, kernel.shader, exactly(constants), kernel.groupItems}});
    if (!done) return done.failure();
    return &made.program;
}

void Programs::drop(uint32_t constant) {
    std::erase_if(made_, [&](const auto& made) {
        return std::ranges::find(made.second.constants, constant, &SpecConstant::id) != made.second.constants.end();
    });
}

}  // namespace espalier
