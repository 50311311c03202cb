#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace espalier {

// A 64-bit hash of bytes: the same on every machine of the same byte order and in every version, so that it may
// be written to files. Not for secrets. `seed` chains parts: hashBytes(b, hashBytes(a)).
uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t seed = 0);
uint64_t hashText(std::string_view text, uint64_t seed = 0);

template <class T>
uint64_t hashValues(std::span<const T> values, uint64_t seed = 0) {
    return hashBytes(std::as_bytes(values), seed);
}

}  // namespace espalier
