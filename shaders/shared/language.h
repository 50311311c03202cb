// The subset of GLSL and C++20 in which the kernels' arithmetic is written once.
// GLSL includes it after enabling the extensions in shaders/shared/extensions.glsl; C++ wraps it in
// namespace espalier. A BUFFER is a typed device address in GLSL and a pointer in C++, 8 bytes in both,
// so that records which hold addresses have one layout.
#ifndef ESPALIER_SHARED_LANGUAGE_H
#define ESPALIER_SHARED_LANGUAGE_H

#ifdef __cplusplus
#include <bit>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>

#include "runtime/core/platform.hpp"

#define ESPALIER_BEGIN namespace espalier {
#define ESPALIER_END }
#define FN inline
#define IN(T) const T&
#define INOUT(T) T&
#define OUT(T) T&
#define CONST_UINT(name, value) inline constexpr uint name = value
#define CONST_FLOAT(name, value) inline constexpr float name = value
#define BUFFER(Name, T) \
    struct Name {       \
        T* v;           \
    };
#define STATIC_SIZE(T, bytes) static_assert(sizeof(T) == (bytes))
#define IS_GIVEN(buffer) ((buffer).v != nullptr)
#define UNUSED(x) (void)(x)
#define IF_ANY(condition) if (condition)

namespace espalier {
using glm::ivec2;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
using u64 = uint64_t;
inline uint floatBitsToUint(float x) { uint b; std::memcpy(&b, &x, 4); return b; }
inline float uintBitsToFloat(uint b) { float x; std::memcpy(&x, &b, 4); return x; }
inline u64 packUint2x32(uvec2 pair) { return pair.x | u64(pair.y) << 32; }
inline uvec2 unpackUint2x32(u64 x) { return {uint(x), uint(x >> 32)}; }
}  // namespace espalier

#else

#define ESPALIER_BEGIN
#define ESPALIER_END
#define FN
#define IN(T) T
#define INOUT(T) inout T
#define OUT(T) out T
#define CONST_UINT(name, value) const uint name = value
#define CONST_FLOAT(name, value) const float name = value
// 8: what is read by address has to be as aligned as its largest number, and records hold numbers and addresses of 8
// bytes. The same for all, since a compiler joins the alignments of what holds an address and of what that leads to; lists
// of words may begin at any word all the same, as their stride is joined, too.
#define BUFFER(Name, T) \
    layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Name { T v[]; };
#define STATIC_SIZE(T, bytes)
#define IS_GIVEN(buffer) (uint64_t(buffer) != 0ul)
#define UNUSED(x)
// An `if` whose text is left out where no lane takes it: software devices run that of a plain one all the same, and jump
// at a loop's end alone.
#define IF_ANY(condition) for (bool any_ = (condition); any_; any_ = false)
#define u64 uint64_t

#endif

// What tools/records is asked to write for a record, which is a struct of numbers, addresses and records. For
// shaders/…/x.h that is a header records/x.h, which includes x.h. A kernel reads and writes eight bytes at a time where
// it takes a whole record: software devices loop over lanes for each read or write by address, whatever its size.
//   RECORD_ACCESS(R)    readR(buffer, index), writeR(buffer, index, record); buffer: of its BUFFER's type
//   RECORD_PART(P, R)   readP(buffer, index): members that P shares with R, by their names or by "// = path" behind them
//   RECORD_TEXELS(R)    in GLSL FETCH_R(FETCH, view, index): from texels of 16 bytes, which FETCH(view, i) fetches
//   RECORD_WORDS(R)     FILL_R(r, WORD, at) and KEEP_R(r, WORD, at): the record r from and to the words WORD(at + i)
//   RECORD_OFFSETS(R)   kR_member: its first word; kR_words: how many words a record takes
#define RECORD_ACCESS(R)
#define RECORD_PART(P, R)
#define RECORD_TEXELS(R)
#define RECORD_WORDS(R)
#define RECORD_OFFSETS(R)
#endif
