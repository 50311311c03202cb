#pragma once

#include <span>

#include "runtime/expand/growth_data.hpp"
#include "runtime/graph/node.hpp"
#include "shaders/emit/emit_records.h"

namespace espalier {

// What is emitted: growth, and where it stands.
struct EmitInputs {
    GrowthView growth;
    SurfaceBuf surfaces{};  // indexed by surface instance
    // [instance]: another one when a surface stands elsewhere, or another one there; 0: nothing grows on it. The table
    // may lie elsewhere without that.
    std::span<const Version> placed{};
    // Where things grow, more or less: space is divided there. What lies elsewhere costs more, no more than that.
    glm::vec3 low{-4}, high{4};
    // True: on a software device whose addresses are the process's own, native code binds growth if no recording that
    // looks at what was bound is in flight (runtime/host/bind.hpp), culls what stands already when a view is recorded
    // (runtime/host/cull.hpp), gathers what is to be written as triangles, and writes bark's
    // (runtime/host/triangles.hpp). False: shaders do there too.
    bool native = true;
};

}  // namespace espalier
