// Arithmetic that gives the same bits on every device: only +, -, × and bit operations of IEEE floats, no
// contraction (kernels that use it are loaded with Program's `exact`, which forbids it for the whole module;
// C++ compiles with -ffp-contract=off). Growth decides by these and by nothing else.
#ifndef ESPALIER_SHARED_EXACT_H
#define ESPALIER_SHARED_EXACT_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

CONST_FLOAT(kPi, 3.14159265f);

FN float dot2(vec2 a, vec2 b) { return a.x * b.x + a.y * b.y; }
FN float cross2(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }
FN float dot3(vec3 a, vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
FN vec3 cross3(vec3 a, vec3 b) {
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
// And, or: without a branch.
#ifdef __cplusplus
inline bool both(bool a, bool b) { return a & b; }
inline bool either(bool a, bool b) { return a | b; }
#else
bool both(bool a, bool b) { return a && b; }
bool either(bool a, bool b) { return a || b; }
#endif
// Without a branch: signs of what a walk compares are as good as random.
FN float absolute(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0x7FFFFFFFu); }
FN float smaller(float a, float b) { return a < b ? a : b; }
FN float larger(float a, float b) { return a < b ? b : a; }
FN float limited(float x, float low, float high) { return smaller(larger(x, low), high); }
FN uint signBit(float x) { return x < 0.0f ? 0x80000000u : 0u; }
FN float sign1(float x) { return uintBitsToFloat(0x3F800000u | signBit(x)); }

// 1 / sqrt(x) for normal x > 0, to about 2 units in the last place; x <= 0 gives a large finite value.
FN float rsqrtExact(float x) {
    float h = 0.5f * larger(x, 1e-37f);
    float y = uintBitsToFloat(0x5F375A86u - (floatBitsToUint(larger(x, 1e-37f)) >> 1u));
    y = y * (1.5f - h * y * y);
    y = y * (1.5f - h * y * y);
    y = y * (1.5f - h * y * y);
    return y;
}
FN float sqrtExact(float x) { return x > 1e-37f ? x * rsqrtExact(x) : 0.0f; }

// 1 / x for normal |x| in [1e-37, 1e37]; x = 0 gives a large finite value.
FN float rcpExact(float x) {
    float a = larger(absolute(x), 1e-37f);
    float y = uintBitsToFloat(0x7EF311C3u - floatBitsToUint(a));
    y = y * (2.0f - a * y);
    y = y * (2.0f - a * y);
    y = y * (2.0f - a * y);
    return uintBitsToFloat(floatBitsToUint(y) ^ signBit(x));
}
FN float divExact(float a, float b) { return a * rcpExact(b); }
// a / b rounded once, so that what divides without a rest does; beyond 1e-15 to 1e18 as divExact leaves it. Halves of 12
// bits multiply exactly, so `rest`, what the first quotient leaves of a, isn't rounded.
FN float upperHalf(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0xFFFFF000u); }
FN float ratioExact(float a, float b) {
    float inverse = rcpExact(b);
    float q = a * inverse;
    float qh = upperHalf(q);
    float bh = upperHalf(b);
    float rest = (((a - qh * bh) - qh * (b - bh)) - (q - qh) * bh) - (q - qh) * (b - bh);
    float size = absolute(q);
    return both(both(absolute(a) > 1e-15f, size > 1e-15f), size < 1e18f) ? q + rest * inverse : q;
}
FN vec3 unit3(vec3 v) { return v * rsqrtExact(dot3(v, v)); }
FN float length3(vec3 v) { return sqrtExact(dot3(v, v)); }
FN float length2(vec2 v) { return sqrtExact(dot2(v, v)); }

// Greatest integer <= x, |x| < 2^31.
FN float floorExact(float x) {
    float t = float(int(x));
    return t - float(t > x);
}

// sin and cos of x (radians, |x| < 1e4), absolute error below 2e-7 near zero and 1e-6 at |x| = 1000.
FN void sinCosExact(float x, OUT(float) s, OUT(float) c) {
    float q = floorExact(x * 0.636619772f + 0.5f);   // quarter turns
    float r = (x - q * 1.5703125f) - q * 4.83826794e-4f;
    float r2 = r * r;
    float sr = r + r * r2 * (-1.66666667e-1f + r2 * (8.33333310e-3f + r2 * (-1.98409e-4f + r2 * 2.7526e-6f)));
    float cr = 1.0f + r2 * (-0.5f + r2 * (4.16666418e-2f + r2 * (-1.3888397e-3f + r2 * 2.4760e-5f)));
    int k = int(q) & 3;
    bool odd = (k & 1) != 0;
    float ss = odd ? cr : sr;
    float cc = odd ? sr : cr;
    s = (k & 2) != 0 ? -ss : ss;
    c = (k == 1 || k == 2) ? -cc : cc;
}

// Angle of (x, y) in radians, [-pi, pi], absolute error below 2e-5; atan2Exact(0, 0) = 0.
FN float atan2Exact(float y, float x) {
    float ax = absolute(x);
    float ay = absolute(y);
    float big = larger(ax, ay);
    float t = divExact(smaller(ax, ay), larger(big, 1e-30f));
    float t2 = t * t;
    float a = t * (0.99997726f + t2 * (-0.33262347f + t2 * (0.19354346f +
              t2 * (-0.11643287f + t2 * (0.05265332f - t2 * 0.01172120f)))));
    a = ay > ax ? 1.57079633f - a : a;
    a = x < 0.0f ? kPi - a : a;
    return y < 0.0f ? -a : a;
}

// Octahedral unit vectors, 2×16 bit snorm: error below 1e-4 radians.
FN uint packSnorm16(float v) {
    float x = limited(v, -1.0f, 1.0f) * 32767.0f + 0.5f;
    int i = int(x);
    return uint(i - int(float(i) > x)) & 0xFFFFu;
}
FN float unpackSnorm16(uint h) {
    int i = int(h << 16u) >> 16;
    return larger(float(i) * 3.05185095e-5f, -1.0f);
}
FN uint packOct(vec3 n) {
    float k = rcpExact(absolute(n.x) + absolute(n.y) + absolute(n.z));
    float x = n.x * k;
    float y = n.y * k;
    float fx = uintBitsToFloat(floatBitsToUint(1.0f - absolute(y)) ^ signBit(x));
    float fy = uintBitsToFloat(floatBitsToUint(1.0f - absolute(x)) ^ signBit(y));
    bool under = n.z < 0.0f;
    x = under ? fx : x;
    y = under ? fy : y;
    return packSnorm16(x) | (packSnorm16(y) << 16u);
}
FN vec3 unpackOct(uint p) {
    float x = unpackSnorm16(p & 0xFFFFu);
    float y = unpackSnorm16(p >> 16u);
    float z = 1.0f - absolute(x) - absolute(y);
    if (z < 0.0f) {
        float fx = (1.0f - absolute(y)) * sign1(x);
        y = (1.0f - absolute(x)) * sign1(y);
        x = fx;
    }
    return unit3(vec3(x, y, z));
}
FN uint packUv(vec2 uv) {
    return uint(limited(uv.x, 0.0f, 1.0f) * 65535.0f + 0.5f) | (uint(limited(uv.y, 0.0f, 1.0f) * 65535.0f + 0.5f) << 16u);
}
FN vec2 unpackUv(uint p) { return vec2(float(p & 0xFFFFu), float(p >> 16u)) * 1.52590219e-5f; }

ESPALIER_END
#endif
