#pragma once

#include <map>
#include <string>

#include "runtime/run/stage.hpp"

namespace espalier {

// Kernels as programs of a device. Each is made, exact, when it is first asked for with these constants, and stays.
class Programs {
  public:
    explicit Programs(Device& device) : device_(device) {}

    // Fails when memory has run out.
    Result<const Program*> of(const Kernel& kernel, const std::vector<SpecConstant>& constants);
    // Drops all programs that were made with a value of this specialization constant.
    void drop(uint32_t constant);

  private:
    struct Made {
        std::vector<SpecConstant> constants;
        Program program;
    };
    Device& device_;
    std::map<std::string, Made> made_;  // by shader and constants
};

}  // namespace espalier
