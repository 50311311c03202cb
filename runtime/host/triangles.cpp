// Enters: instances of spans. Leaves: their rings of bark (bark_ring.h) and quads, in memory. A span's rings are made
// side by side, several at once, then put into the order of vertices and streamed out.
#include "runtime/host/triangles.hpp"

#include <array>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

#include "runtime/core/jobs.hpp"
#include "runtime/core/lanes.hpp"
#include "shaders/emit/bark_ring.h"

namespace espalier {
namespace {

constexpr size_t kSpansAtOnce = 256;
constexpr uint32_t kPairs = kBarkSides / 2;
constexpr float kAcross[kPairs] = {1, kBarkCosine, .5f, 0, -.5f, -kBarkCosine};
constexpr float kUpward[kPairs] = {0, .5f, kBarkCosine, 1, kBarkCosine, .5f};

// The quads between two rings each, of a span whose vertices begin at 0.
constexpr std::array<uint32_t, kBarkIndices> makePattern() {
    std::array<uint32_t, kBarkIndices> pattern{};
    uint32_t at = 0;
    for (uint32_t ring = 0; ring + 1 < kBarkRings; ++ring)
        for (uint32_t side = 0; side < kBarkSides; ++side) {
            const uint32_t a = ring * kBarkSides + side, b = ring * kBarkSides + (side + 1) % kBarkSides;
            for (uint32_t corner : {a, b, a + kBarkSides, b, b + kBarkSides, a + kBarkSides}) pattern[at++] = corner;
        }
    return pattern;
}
alignas(16) constexpr std::array<uint32_t, kBarkIndices> kPattern = makePattern();

// All rings of a span side by side, so that compilers take several at once; their number is made one that divides.
constexpr uint32_t kLanes = 12;
struct Rings {
    alignas(16) float center[3][kLanes], side[3][kLanes], up[3][kLanes], radius[kLanes];
};
// The same vertex of all rings.
struct Column {
    alignas(16) float x[kLanes], y[kLanes], z[kLanes];
    alignas(16) uint32_t normal[kLanes];
};

ESPALIER_LANES void makeRings(const SpanInstance& given, Rings& out) {
    const SpanInstance span = given;
    const vec3 normal0 = unpackOct(span.normal0), normal1 = unpackOct(span.normal1);
    for (uint32_t i = 0; i < kLanes; ++i) {
        const BarkRing r = barkRing(span, normal0, normal1, i);
        out.center[0][i] = r.center.x;
        out.center[1][i] = r.center.y;
        out.center[2][i] = r.center.z;
        out.side[0][i] = r.side.x;
        out.side[1][i] = r.side.y;
        out.side[2][i] = r.side.z;
        out.up[0][i] = r.up.x;
        out.up[1][i] = r.up.y;
        out.up[2][i] = r.up.z;
        out.radius[i] = r.radius;
    }
    for (uint32_t i = 0; roundedTip(span) && i < kBarkRings; ++i) out.radius[i] = tipRadius(span, i);
}

ESPALIER_LANES void makePairs(const Rings& ESPALIER_ALONE rings, float across, float upward,
                              Column& ESPALIER_ALONE ahead, Column& ESPALIER_ALONE behind) {
    for (uint32_t i = 0; i < kLanes; ++i) {
        BarkRing r;
        r.side = {rings.side[0][i], rings.side[1][i], rings.side[2][i]};
        r.up = {rings.up[0][i], rings.up[1][i], rings.up[2][i]};
        r.radius = rings.radius[i];
        const BarkPair pair = barkPair(r, across, upward);
        ahead.x[i] = rings.center[0][i] + pair.arm.x;
        ahead.y[i] = rings.center[1][i] + pair.arm.y;
        ahead.z[i] = rings.center[2][i] + pair.arm.z;
        ahead.normal[i] = pair.ahead;
        behind.x[i] = rings.center[0][i] - pair.arm.x;
        behind.y[i] = rings.center[1][i] - pair.arm.y;
        behind.z[i] = rings.center[2][i] - pair.arm.z;
        behind.normal[i] = pair.behind;
    }
}

// Stores past the caches, since nobody reads so many bytes back soon: words[i] + add for a span's indices; columns of
// all sides in the order of vertices, four rings at once and each cache line in one go. `to` is a multiple of 16 bytes.
#ifdef __SSE2__
void streamIndices(const uint32_t* words, uint32_t add, uint32_t* to) {
    const __m128i base = _mm_set1_epi32(int(add));
    for (uint32_t i = 0; i < kBarkIndices; i += 4)
        _mm_stream_si128(reinterpret_cast<__m128i*>(to + i),
                         _mm_add_epi32(_mm_load_si128(reinterpret_cast<const __m128i*>(words + i)), base));
}
void streamVertices(const Column* columns, TriangleVertex* to) {
    for (uint32_t ring = 0; ring < kBarkRings; ring += 4)
        for (uint32_t line = 0; line < kBarkSides; line += 4)
            for (uint32_t side = line; side < line + 4; ++side) {
                const Column& c = columns[side];
                __m128 row[4] = {_mm_load_ps(c.x + ring), _mm_load_ps(c.y + ring), _mm_load_ps(c.z + ring),
                                 _mm_load_ps(reinterpret_cast<const float*>(c.normal + ring))};
                _MM_TRANSPOSE4_PS(row[0], row[1], row[2], row[3]);
                for (uint32_t k = 0; k < 4 && ring + k < kBarkRings; ++k)
                    _mm_stream_ps(reinterpret_cast<float*>(to + (ring + k) * kBarkSides + side), row[k]);
            }
}
void finishStreams() {
    _mm_sfence();
}
#else
void streamIndices(const uint32_t* words, uint32_t add, uint32_t* to) {
    for (uint32_t i = 0; i < kBarkIndices; ++i) to[i] = words[i] + add;
}
void streamVertices(const Column* columns, TriangleVertex* to) {
    for (uint32_t i = 0; i < kBarkVertices; ++i) {
        const Column& c = columns[i % kBarkSides];
        const uint32_t ring = i / kBarkSides;
        to[i] = {{c.x[ring], c.y[ring], c.z[ring]}, c.normal[ring]};
    }
}
void finishStreams() {}
#endif

void writeSpan(const SpanInstance& span, uint32_t firstVertex, TriangleVertex* vertices, uint32_t* indices) {
    Rings rings;
    makeRings(span, rings);
    Column columns[kBarkSides];
    for (uint32_t i = 0; i < kPairs; ++i) makePairs(rings, kAcross[i], kUpward[i], columns[i], columns[i + kPairs]);
    streamVertices(columns, vertices);
    streamIndices(kPattern.data(), firstVertex, indices);
}

}  // namespace

void writeBarkNative(const SpanInstance* spans, const DrawnItem* drawn, uint32_t count, TriangleVertex* vertices,
                     uint32_t* indices) {
    parallelFor(count, kSpansAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i)
            writeSpan(spans[drawn[i].item], uint32_t(i * kBarkVertices), vertices + i * kBarkVertices,
                      indices + i * kBarkIndices);
        finishStreams();
    });
}

}  // namespace espalier
