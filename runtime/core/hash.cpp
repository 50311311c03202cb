// Bytes in, 64 bits out: words are folded in by a multiply-and-rotate, the end is stirred until every input bit
// reaches every output bit.
#include "runtime/core/hash.hpp"

#include <cstring>

namespace espalier {
namespace {

constexpr uint64_t kOdd1 = 0x9E3779B97F4A7C15ull;  // 2^64 / golden ratio
constexpr uint64_t kOdd2 = 0xD1B54A32D192ED03ull;

uint64_t rotate(uint64_t x, int bits) {
    return (x << bits) | (x >> (64 - bits));
}

uint64_t fold(uint64_t state, uint64_t word) {
    state ^= rotate(word * kOdd1, 29) * kOdd2;
    return rotate(state, 27) * 5 + 0x52DCE729ull;
}

uint64_t stir(uint64_t x) {
    x = (x ^ (x >> 32)) * kOdd2;
    x = (x ^ (x >> 29)) * kOdd1;
    return x ^ (x >> 32);
}

}  // namespace

uint64_t hashBytes(std::span<const std::byte> bytes, uint64_t seed) {
    uint64_t state = stir(seed + kOdd1);
    size_t at = 0;
    for (; at + 8 <= bytes.size(); at += 8) {
        uint64_t word;
        std::memcpy(&word, bytes.data() + at, 8);
        state = fold(state, word);
    }
    uint64_t tail = 0;
    if (at < bytes.size()) std::memcpy(&tail, bytes.data() + at, bytes.size() - at);
    return stir(fold(fold(state, tail), bytes.size()));
}

uint64_t hashText(std::string_view text, uint64_t seed) {
    return hashBytes(std::as_bytes(std::span(text.data(), text.size())), seed);
}

}  // namespace espalier
