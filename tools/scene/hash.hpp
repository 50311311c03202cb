#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace espalier::scene {

// Tells contents of files apart: for their names, and whether they have changed. `seed` chains parts:
// hashOf(b, m, hashOf(a, n)). Not for secrets.
uint64_t hashOf(const void* data, size_t size, uint64_t seed = 0);

// The same as kHashDigits hexadecimal digits: a name for what these bytes are.
constexpr size_t kHashDigits = 16;
std::string hashName(const void* data, size_t size);
// A key of 64 bits that is written so; nothing, where it isn't.
std::optional<uint64_t> keyNamed(const std::string& digits);

}  // namespace espalier::scene
