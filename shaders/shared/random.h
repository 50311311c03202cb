// Keys and random numbers: 64-bit hashes of the derivation path. Rule names, not indices, go in, so that
// neither the schedule nor an inserted rule reshuffles plants.
#ifndef ESPALIER_SHARED_RANDOM_H
#define ESPALIER_SHARED_RANDOM_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

// A bijection of 64 bits that spreads every bit (the finaliser of splitmix64).
FN u64 mix64(u64 x) {
    x ^= x >> 30;
    x *= (u64(0xBF58476Du) << 32) | u64(0x1CE4E5B9u);
    x ^= x >> 27;
    x *= (u64(0x94D049BBu) << 32) | u64(0x133111EBu);
    return x ^ (x >> 31);
}
FN u64 combineKeys(u64 a, u64 b) { return mix64(a ^ (mix64(b) + ((u64(0x9E3779B9u) << 32) | u64(0x7F4A7C15u)))); }

// The key of a successor: its predecessor's key, the hash of its symbol's name, and which of the
// successors of that name it is.
FN u64 childKey(u64 parent, uint nameHash, uint ordinal) {
    return mix64(parent + mix64((u64(nameHash) << 32) | u64(ordinal + 1u)));
}

// Uniform in [0, 1), a multiple of 2^-24: the draw number `site` of the shape with this key.
FN float uniformRandom(u64 key, uint site) {
    u64 h = mix64(key + mix64(u64(site) + u64(0x51ED2701u)));
    return float(uint(h >> 40)) * 5.96046448e-8f;
}

ESPALIER_END
#endif
