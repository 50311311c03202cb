// Points that nodes of the graph make: particles in a box, and grids.
#ifndef ESPALIER_SHARED_NODE_POINTS_H
#define ESPALIER_SHARED_NODE_POINTS_H
#include "shaders/shared/exact.h"
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

struct ParticleArgs {
    NodePlanes to;
    vec3 low, size;
    vec3 perSize;  // 1 / size; 0 where there is none
    float way;     // that each has gone by now
    uint seed;
    uint count;
};
STATIC_SIZE(ParticleArgs, 64);

// Where something is, in sizes of a room from its low end on, that has gone so far and is thrown back at both ends.
FN float thrownBack(float way) {
    float turns = within(way, 1e6f);
    float phase = turns - 2.0f * floorExact(turns * 0.5f);
    return phase > 1.0f ? 2.0f - phase : phase;
}

// A direction, as likely as any other.
FN vec3 anyDirection(uint seed, uint i, uint site) {
    float z = 2.0f * nodeRandom(seed, i, site) - 1.0f;
    float flat2 = larger(1.0f - z * z, 1e-30f);
    float around = flat2 * rsqrtExact(flat2);   // sqrtExact branches
    float s;
    float c;
    sinCosExact(6.28318531f * nodeRandom(seed, i, site + 1u), s, c);
    return vec3(around * c, around * s, z);
}

// Particle i after all have moved straight on, each in a direction of its own, and been thrown back by the box.
FN vec3 particleAt(ParticleArgs a, uint i) {
    vec3 d = anyDirection(a.seed, i, 3u);
    vec3 gone = d * a.perSize * a.way + vec3(nodeRandom(a.seed, i, 0u), nodeRandom(a.seed, i, 1u), nodeRandom(a.seed, i, 2u));
    return a.low + a.size * vec3(thrownBack(gone.x), thrownBack(gone.y), thrownBack(gone.z));
}
FN void placeParticle(ParticleArgs a, uint i) { putVector(a.to, i, particleAt(a, i)); }

struct GridArgs {
    NodePlanes to;
    vec3 low, step;
    uint counts[3];
    uint total;
};
STATIC_SIZE(GridArgs, 56);

// Rows along x, then along y, then along z.
FN void placeGridPoint(GridArgs a, uint i) {
    uint x = i % a.counts[0];
    uint rest = i / a.counts[0];
    uint y = rest % a.counts[1];
    uint z = rest / a.counts[1];
    putVector(a.to, i, a.low + a.step * vec3(float(int(x)), float(int(y)), float(int(z))));
}

ESPALIER_END
#endif
