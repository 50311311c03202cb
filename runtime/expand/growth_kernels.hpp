#pragma once

// The kernels of growth. Each is made when it is first asked for, specialised to how it reads tables and to what a
// scene's grammars use; what has been made stays.

#include <initializer_list>
#include <map>
#include <utility>

#include "runtime/gpu/program.hpp"

namespace espalier {

enum class GrowthKernel : uint32_t {
    tables,
    march,
    marchPaper,
    terminals,
    branches,
    fit,
    // What an edit concerns, see expand_again.h.
    find,
    start,
    marchAgain,
    settle,
    work,
    terminalsAgain,
    apply,
    thickness,
    fitAgain,
    // Closing gaps.
    compactPlaces,
    compactNodes,
    compactLeaves,
};

class GrowthKernels {
  public:
    explicit GrowthKernels(Device& device) : device_(device) {}

    // What grammars use from now on (kFeature...), beside all that they ever did: so kernels settle.
    void use(uint32_t features);
    // tablesByAddress: kernels read tables so, else from a uniform buffer.
    Status make(std::initializer_list<GrowthKernel> kernels, bool tablesByAddress);
    // One that has been made.
    const Program& get(GrowthKernel kernel, bool tablesByAddress) const;

  private:
    using Key = std::pair<GrowthKernel, bool>;  // the latter: reads tables by address
    static Key keyOf(GrowthKernel kernel, bool tablesByAddress);

    Device& device_;
    uint32_t features_ = 0;
    std::map<Key, Program> programs_;
};

}  // namespace espalier
