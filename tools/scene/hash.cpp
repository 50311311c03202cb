// Words of 32 bits, folded in one after the other.
#include "tools/scene/hash.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>

namespace espalier::scene {

uint64_t hashOf(const void* data, size_t size, uint64_t seed) {
    uint64_t hash = 1469598103934665603ull ^ size ^ seed;
    const char* bytes = static_cast<const char*>(data);
    for (size_t i = 0; i < size; i += sizeof(uint32_t)) {
        uint32_t bits = 0;
        std::memcpy(&bits, bytes + i, std::min(size - i, sizeof bits));
        hash = (hash ^ bits) * 1099511628211ull;
        hash ^= hash >> 29;
    }
    return hash;
}

std::string hashName(const void* data, size_t size) {
    char text[kHashDigits + 1];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hashOf(data, size)));
    return text;
}

std::optional<uint64_t> keyNamed(const std::string& digits) {
    uint64_t key = 0;
    const char* end = digits.data() + digits.size();
    const auto [read, wrong] = std::from_chars(digits.data(), end, key, 16);
    if (digits.size() != kHashDigits || wrong != std::errc() || read != end) return {};
    return key;
}

}  // namespace espalier::scene
