#pragma once

// The kernels of growth. Each is made when it is first asked for, specialised to how it reads what growth needs and to
// what a scene's grammars use; what has been made stays.

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

// How kernels read what growth needs, where they have a choice.
struct GrowthAccess {
    bool tablesByAddress = false;   // else from a uniform buffer, which holds kUniformTableWords
    bool surfacesAsTexels = false;  // else by address
    bool recordsAsTexels = false;   // else by address
};

class GrowthKernels {
  public:
    explicit GrowthKernels(Device& device) : device_(device) {}

    // What grammars use from now on (kFeature...), beside all that they ever did: so kernels settle.
    void use(uint32_t features);
    Status make(std::initializer_list<GrowthKernel> kernels, const GrowthAccess& access);
    // One that has been made.
    const Program& get(GrowthKernel kernel, const GrowthAccess& access) const;

  private:
    using Key = std::pair<GrowthKernel, uint32_t>;  // the latter: by what it is specialised, bits
    static Key keyOf(GrowthKernel kernel, const GrowthAccess& access);

    Device& device_;
    uint32_t features_ = 0;
    std::map<Key, Program> programs_;
};

}  // namespace espalier
