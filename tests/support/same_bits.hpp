#pragma once

#include <cstring>
#include <type_traits>
#include <vector>

namespace espalier::test {

// The same elements, bit for bit.
template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
    static_assert(std::is_trivially_copyable_v<T>);
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

}  // namespace espalier::test
