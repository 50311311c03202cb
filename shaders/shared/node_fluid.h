// A fluid of particles in a box (smoothed particle hydrodynamics, Müller et al. 2003, with the pressure's term made
// symmetric). Lengths between particles are in radii, densities in that of the fluid at rest, so that no density is an
// input.
//
// Behind walls one thinks of more of the fluid, of the same pressure, or particles would crowd there: kernels integrate over
// that room in closed form.
//
// Sums of floats depend on their order, so each particle sums its neighbours cell by cell, and in a cell by their
// numbers. A neighbour beyond the radius adds zero, so whoever looks at further cells has the same sum.
#ifndef ESPALIER_SHARED_NODE_FLUID_H
#define ESPALIER_SHARED_NODE_FLUID_H
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

// Planes of a particle's own, by its number: place, velocity in m/s, density. The first three are what a graph sees.
CONST_UINT(kFluidVelocity, 3u);
CONST_UINT(kFluidDensity, 6u);
CONST_UINT(kFluidPlanes, 7u);
// Planes of particles in the order of cells: place, velocity, the room that one takes, what it pushes with.
CONST_UINT(kSortedRoom, 6u);
CONST_UINT(kSortedPush, 7u);
CONST_UINT(kSortedPlanes, 8u);

// Two particles rest half a radius apart, so one has the mass of a cube of that side. The kernels' constants times it:
CONST_FLOAT(kFluidDense, 0.195835184f);   // 315 / (512 pi)
CONST_FLOAT(kFluidSteep, 1.79049311f);    // 45 / (8 pi)

struct FluidArgs {
    NodePlanes own;
    NodePlanes sorted;
    UintBuf words;     // see fluidWords
    UintBuf normals;   // by number: octahedral, where a particle is heading
    vec3 low, high;    // m: where particles may be, a quarter of a radius from the walls
    float perRadius;   // 1/m
    float perCell;     // 1/m; cells are a little larger than the radius, so that rounding hides no neighbour
    uint cells[3];
    uint count;
    vec3 gravity;      // m/s^2
    float step;        // s
    float stiffness, viscosity;
    float bounce;
    float fastest;     // m/s along each axis
};
STATIC_SIZE(FluidArgs, 128);

// Words of a fluid: particles of each cell; each cell's first place; how many places are given away; then by place the
// numbers of particles as they came, by number their cells and which they were in it, and by place their numbers in order.
FN uint fluidCells(FluidArgs a) { return a.cells[0] * a.cells[1] * a.cells[2]; }
FN uint startWord(FluidArgs a) { return fluidCells(a); }
FN uint takenWord(FluidArgs a) { return 2u * fluidCells(a); }
FN uint cameWord(FluidArgs a) { return 2u * fluidCells(a) + 1u; }
FN uint cellWord(FluidArgs a) { return cameWord(a) + a.count; }
FN uint turnWord(FluidArgs a) { return cellWord(a) + a.count; }
FN uint orderWord(FluidArgs a) { return turnWord(a) + a.count; }

FN uint cellAlong(FluidArgs a, vec3 p, uint axis) {
    uint cell = uint(int((p[axis] - a.low[axis]) * a.perCell));
    return cell < a.cells[axis] ? cell : a.cells[axis] - 1u;
}
FN uint cellAt(FluidArgs a, uint x, uint y, uint z) { return (z * a.cells[1] + y) * a.cells[0] + x; }
FN uint fluidCell(FluidArgs a, uint i) {
    vec3 p = takeVector(a.own, i);
    return cellAt(a, cellAlong(a, p, 0u), cellAlong(a, p, 1u), cellAlong(a, p, 2u));
}

// Places of the cells from x0 to x1 of a row: the first, and behind the last.
FN uvec2 placesOf(FluidArgs a, uint x0, uint x1, uint y, uint z) {
    uint last = cellAt(a, x1, y, z);
    return uvec2(a.words.v[startWord(a) + cellAt(a, x0, y, z)], a.words.v[startWord(a) + last] + a.words.v[last]);
}

// Row r of cells along x takes places from `first` on.
FN uint placesInRow(FluidArgs a, uint r) {
    uint all = 0u;
    for (uint x = 0u; x < a.cells[0]; ++x) all += a.words.v[r * a.cells[0] + x];
    return all;
}
FN void startRow(FluidArgs a, uint r, uint first) {
    for (uint x = 0u; x < a.cells[0]; ++x) {
        uint cell = r * a.cells[0] + x;
        a.words.v[startWord(a) + cell] = first;
        first += a.words.v[cell];
    }
}

FN void placeFluid(FluidArgs a, uint i) {
    uint cell = a.words.v[cellWord(a) + i];
    a.words.v[cameWord(a) + a.words.v[startWord(a) + cell] + a.words.v[turnWord(a) + i]] = i;
}

FN vec3 velocityOf(NodePlanes p, uint i) {
    return vec3(planeOf(p, kFluidVelocity).v[i], planeOf(p, kFluidVelocity + 1u).v[i], planeOf(p, kFluidVelocity + 2u).v[i]);
}
FN void putVelocity(NodePlanes p, uint i, vec3 v) {
    planeOf(p, kFluidVelocity).v[i] = v.x;
    planeOf(p, kFluidVelocity + 1u).v[i] = v.y;
    planeOf(p, kFluidVelocity + 2u).v[i] = v.z;
}

// Particle i stands at this place of the order.
FN void sortInto(FluidArgs a, uint i, uint place) {
    a.words.v[orderWord(a) + place] = i;
    putVector(a.sorted, place, takeVector(a.own, i));
    putVelocity(a.sorted, place, velocityOf(a.own, i));
}
// In which order particles came to a cell depends on who was quickest, so they line up by their numbers.
FN void orderFluid(FluidArgs a, uint came) {
    uint i = a.words.v[cameWord(a) + came];
    uint cell = a.words.v[cellWord(a) + i];
    uint first = a.words.v[startWord(a) + cell];
    uint before = 0u;
    for (uint k = 0u; k < a.words.v[cell]; ++k) before += a.words.v[cameWord(a) + first + k] < i ? 1u : 0u;
    sortInto(a, i, first + before);
}

// What a neighbour adds to the density: d is the way to it, in radii.
FN float densityBy(vec3 d) {
    float s = larger(1.0f - dot3(d, d), 0.0f);
    return s * s * s;
}
// Of a particle's surroundings the share on this side of a wall that is so many radii away.
FN float shareWithin(float away) {
    float t = smaller(away, 1.0f);
    float t2 = t * t;
    return 0.5f + 1.23046875f * t * (1.0f + t2 * (-1.33333333f + t2 * (1.2f + t2 * (-0.571428571f + t2 * 0.111111111f))));
}
// Of radii: how far the wall at the low and the high end lies.
CONST_FLOAT(kWallInset, 0.25f);
FN float awayFromLow(FluidArgs a, float p, float low) { return (p - low) * a.perRadius + kWallInset; }
FN float awayFromHigh(FluidArgs a, float p, float high) { return (high - p) * a.perRadius + kWallInset; }
FN float shareInBox(FluidArgs a, vec3 p) {
    return shareWithin(awayFromLow(a, p.x, a.low.x)) * shareWithin(awayFromHigh(a, p.x, a.high.x)) *
           shareWithin(awayFromLow(a, p.y, a.low.y)) * shareWithin(awayFromHigh(a, p.y, a.high.y)) *
           shareWithin(awayFromLow(a, p.z, a.low.z)) * shareWithin(awayFromHigh(a, p.z, a.high.z));
}
// How hard the fluid behind a wall pushes.
FN float pushAt(float away) {
    float s = larger(1.0f - away, 0.0f);
    float s2 = s * s;
    return s2 * s2 * (1.5f + 6.0f * away);
}
FN vec3 pushOfWalls(FluidArgs a, vec3 p) {
    return vec3(pushAt(awayFromLow(a, p.x, a.low.x)) - pushAt(awayFromHigh(a, p.x, a.high.x)),
                pushAt(awayFromLow(a, p.y, a.low.y)) - pushAt(awayFromHigh(a, p.y, a.high.y)),
                pushAt(awayFromLow(a, p.z, a.low.z)) - pushAt(awayFromHigh(a, p.z, a.high.z)));
}

// The sum over all neighbours is known.
FN void putDensity(FluidArgs a, uint place, float sum) {
    float density = kFluidDense * sum + (1.0f - shareInBox(a, takeVector(a.sorted, place)));
    float room = rcpExact(density);
    planeOf(a.own, kFluidDensity).v[a.words.v[orderWord(a) + place]] = density;
    planeOf(a.sorted, kSortedRoom).v[place] = room;
    // Where it is thin it doesn't pull.
    planeOf(a.sorted, kSortedPush).v[place] = a.stiffness * larger(density - 1.0f, 0.0f) * room * room;
}

struct FluidForce {
    vec3 push, drag;
};
// d: from the neighbour, in radii; dv: how much faster it is; push: of both; room: its own.
FN void addForce(INOUT(FluidForce) f, vec3 d, vec3 dv, float push, float room) {
    float r2 = larger(dot3(d, d), 1e-12f);
    float inverse = rsqrtExact(r2);
    float near = larger(1.0f - r2 * inverse, 0.0f);
    f.push = f.push + d * (inverse * near * near * push);
    f.drag = f.drag + dv * (near * room);
}

struct FluidMove {
    vec3 at, velocity;
};
// A step further along one axis, at most to a wall, which throws it back.
FN void moveAlong(float low, float high, float bounce, float step, INOUT(float) at, INOUT(float) v) {
    float to = at + v * step;
    v = either(to < low, to > high) ? -(v * bounce) : v;
    at = limited(to, low, high);
}
// push, room: the particle's own.
FN FluidMove movedBy(FluidArgs a, vec3 p, vec3 v, float push, float room, FluidForce f) {
    float steep = kFluidSteep * a.perRadius;
    vec3 by = a.gravity + f.push * steep + f.drag * (steep * a.perRadius * a.viscosity * room) +
              pushOfWalls(a, p) * (2.0f * push * a.perRadius);
    FluidMove m;
    m.at = p;
    m.velocity = v + by * a.step;
    m.velocity.x = limited(m.velocity.x, -a.fastest, a.fastest);
    m.velocity.y = limited(m.velocity.y, -a.fastest, a.fastest);
    m.velocity.z = limited(m.velocity.z, -a.fastest, a.fastest);
    moveAlong(a.low.x, a.high.x, a.bounce, a.step, m.at.x, m.velocity.x);
    moveAlong(a.low.y, a.high.y, a.bounce, a.step, m.at.y, m.velocity.y);
    moveAlong(a.low.z, a.high.z, a.bounce, a.step, m.at.z, m.velocity.z);
    return m;
}
FN void putMoved(FluidArgs a, uint place, FluidMove m) {
    uint i = a.words.v[orderWord(a) + place];
    putVector(a.own, i, m.at);
    putVelocity(a.own, i, m.velocity);
}
// Who rests looks upwards.
FN void findHeading(FluidArgs a, uint i) {
    vec3 v = velocityOf(a.own, i);
    bool rests = dot3(v, v) < 1e-12f;
    a.normals.v[i] = packOct(vec3(v.x, rests ? 1.0f : v.y, v.z));
}

// Rows of cells about one cell, as far as there are any: low and high ends along y and z.
struct CellRange {
    uint x0, x1, y0, y1, z0, z1;
};
FN CellRange cellsAbout(FluidArgs a, uint x0, uint x1, uint y, uint z) {
    CellRange c;
    c.x0 = x0 > 0u ? x0 - 1u : 0u;
    c.x1 = x1 + 1u < a.cells[0] ? x1 + 1u : x1;
    c.y0 = y > 0u ? y - 1u : 0u;
    c.y1 = y + 1u < a.cells[1] ? y + 1u : y;
    c.z0 = z > 0u ? z - 1u : 0u;
    c.z1 = z + 1u < a.cells[2] ? z + 1u : z;
    return c;
}
FN CellRange cellsAboutPlace(FluidArgs a, vec3 p) {
    uint x = cellAlong(a, p, 0u);
    return cellsAbout(a, x, x, cellAlong(a, p, 1u), cellAlong(a, p, 2u));
}

FN void findDensity(FluidArgs a, uint place) {
    vec3 p = takeVector(a.sorted, place);
    CellRange c = cellsAboutPlace(a, p);
    float sum = 0.0f;
    for (uint z = c.z0; z <= c.z1; ++z)
        for (uint y = c.y0; y <= c.y1; ++y) {
            uvec2 places = placesOf(a, c.x0, c.x1, y, z);
            for (uint j = places.x; j < places.y; ++j) sum += densityBy((p - takeVector(a.sorted, j)) * a.perRadius);
        }
    putDensity(a, place, sum);
}
FN void moveFluid(FluidArgs a, uint place) {
    vec3 p = takeVector(a.sorted, place);
    vec3 v = velocityOf(a.sorted, place);
    float push = planeOf(a.sorted, kSortedPush).v[place];
    float room = planeOf(a.sorted, kSortedRoom).v[place];
    CellRange c = cellsAboutPlace(a, p);
    FluidForce f;
    f.push = vec3(0.0f);
    f.drag = vec3(0.0f);
    for (uint z = c.z0; z <= c.z1; ++z)
        for (uint y = c.y0; y <= c.y1; ++y) {
            uvec2 places = placesOf(a, c.x0, c.x1, y, z);
            for (uint j = places.x; j < places.y; ++j)
                addForce(f, (p - takeVector(a.sorted, j)) * a.perRadius, velocityOf(a.sorted, j) - v,
                         push + planeOf(a.sorted, kSortedPush).v[j], planeOf(a.sorted, kSortedRoom).v[j]);
        }
    putMoved(a, place, movedBy(a, p, v, push, room, f));
}

// The fluid before its first step: a grid that a little chance has been at, or it would stand in columns for ever.
struct FluidStart {
    NodePlanes own;
    vec3 first;        // m: place of the first
    vec3 low, high;    // as FluidArgs'
    float apart;       // m
    uint counts[3];
    uint seed, count;
    uint spare;
};
STATIC_SIZE(FluidStart, 80);

FN void startFluid(FluidStart a, uint i) {
    uint x = i % a.counts[0];
    uint rest = i / a.counts[0];
    uint y = rest % a.counts[1];
    uint z = rest / a.counts[1];
    vec3 by = vec3(nodeRandom(a.seed, i, 0u), nodeRandom(a.seed, i, 1u), nodeRandom(a.seed, i, 2u));
    vec3 p = a.first + (vec3(float(int(x)), float(int(y)), float(int(z))) + by * 0.125f) * a.apart;
    putVector(a.own, i, vec3(limited(p.x, a.low.x, a.high.x), limited(p.y, a.low.y, a.high.y), limited(p.z, a.low.z, a.high.z)));
    putVelocity(a.own, i, vec3(0.0f));
}

ESPALIER_END
#endif
