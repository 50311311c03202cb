// Words by twos: software devices loop over lanes for each read or write by address, whatever its size up to eight bytes.
// GLSL only.
#ifndef ESPALIER_SHARED_PAIRS_H
#define ESPALIER_SHARED_PAIRS_H
#ifndef __cplusplus

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer PairBuf { uint64_t v[]; };

uint64_t pairOf(uint low, uint high) { return packUint2x32(uvec2(low, high)); }
uint64_t pairOf(float low, float high) { return packUint2x32(uvec2(floatBitsToUint(low), floatBitsToUint(high))); }
uint64_t pairOf(vec2 pair) { return pairOf(pair.x, pair.y); }
uint64_t pairOf(float low, uint high) { return packUint2x32(uvec2(floatBitsToUint(low), high)); }

#endif
#endif
