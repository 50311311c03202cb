#pragma once

// Keys of productions, worked out a second time: the order in which sequential derivations go.

#include <cstdint>

namespace espalier::patterntest {

inline uint64_t stir(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}
inline uint32_t named(const char* name) {
    uint32_t hash = 2166136261u;
    for (; *name; ++name) hash = (hash ^ uint8_t(*name)) * 16777619u;
    return hash;
}
// Of the production of symbol `name` that is the number `ordinal` of its kind in that with the key.
inline uint64_t child(uint64_t key, const char* name, uint32_t ordinal) {
    return stir(key + stir(uint64_t(named(name)) << 32 | (ordinal + 1)));
}

}  // namespace espalier::patterntest
