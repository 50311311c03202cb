// Noise of nodes of the graph.
#ifndef ESPALIER_SHARED_NODE_NOISE_H
#define ESPALIER_SHARED_NODE_NOISE_H
#include "shaders/shared/exact.h"
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

// Smooth noise of -1 to 1, in the mean 0.
FN float latticeNoise(uint seed, vec3 place) {
    // What lies farther away has no places between whole numbers.
    vec3 p = vec3(within(place.x, 1e6f), within(place.y, 1e6f), within(place.z, 1e6f));
    float fx = floorExact(p.x);
    float fy = floorExact(p.y);
    float fz = floorExact(p.z);
    uint x = uint(int(fx)) * 0x9E3779B1u;
    uint y = uint(int(fy)) * 0x85EBCA77u;
    uint z = uint(int(fz)) * 0xC2B2AE3Du;
    float u = p.x - fx;
    float v = p.y - fy;
    float w = p.z - fz;
    u = u * u * u * (u * (u * 6.0f - 15.0f) + 10.0f);
    v = v * v * v * (v * (v * 6.0f - 15.0f) + 10.0f);
    w = w * w * w * (w * (w * 6.0f - 15.0f) + 10.0f);
    uint x1 = x + 0x9E3779B1u;
    uint y1 = y + 0x85EBCA77u;
    uint z1 = z + 0xC2B2AE3Du;
    float h000 = nodeRandom(seed, x ^ y ^ z, 0u);
    float h100 = nodeRandom(seed, x1 ^ y ^ z, 0u);
    float h010 = nodeRandom(seed, x ^ y1 ^ z, 0u);
    float h110 = nodeRandom(seed, x1 ^ y1 ^ z, 0u);
    float h001 = nodeRandom(seed, x ^ y ^ z1, 0u);
    float h101 = nodeRandom(seed, x1 ^ y ^ z1, 0u);
    float h011 = nodeRandom(seed, x ^ y1 ^ z1, 0u);
    float h111 = nodeRandom(seed, x1 ^ y1 ^ z1, 0u);
    float a = h000 + (h100 - h000) * u;
    float b = h010 + (h110 - h010) * u;
    float c = h001 + (h101 - h001) * u;
    float d = h011 + (h111 - h011) * u;
    float e = a + (b - a) * v;
    float f = c + (d - c) * v;
    return 2.0f * (e + (f - e) * w) - 1.0f;
}

ESPALIER_END
#endif
