#pragma once

#include <cstddef>
#include <cstdint>

namespace espalier::scene {

// Tells contents of files apart: for their names, and whether they have changed. `seed` chains parts:
// hashOf(b, m, hashOf(a, n)). Not for secrets.
uint64_t hashOf(const void* data, size_t size, uint64_t seed = 0);

}  // namespace espalier::scene
