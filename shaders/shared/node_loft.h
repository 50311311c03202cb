// Lofts: a ring is swept along each of many curves. The frames of a curve turn as little as they can about it (Wang,
// Juettler, Zheng and Liu 2008: two reflections take one frame to the next).
#ifndef ESPALIER_SHARED_NODE_LOFT_H
#define ESPALIER_SHARED_NODE_LOFT_H
#include "shaders/shared/exact.h"
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

struct FrameArgs {
    NodePlanes path;
    NodePlanes to; // planes 0 to 2: the frame's side, 3 to 5: its other side; both at right angles to the curve
    uint row, curves, samples;
    uint closed;         // 1: the last sample is the first again
};
STATIC_SIZE(FrameArgs, 48);

FN vec3 alongPath(vec3 before, vec3 after) {
    vec3 d = after - before;
    float n = dot3(d, d);
    vec3 unit = d * rsqrtExact(n);
    bool any = n > 1e-30f;
    return vec3(any ? unit.x : 0.0f, any ? unit.y : 0.0f, any ? unit.z : 1.0f);
}
FN uint sampleBefore(FrameArgs a, uint j) { return j > 0u ? j - 1u : a.closed != 0u && a.samples > 2u ? a.samples - 2u : 0u; }
FN uint sampleAfter(FrameArgs a, uint j) { return j + 1u < a.samples ? j + 1u : a.closed != 0u && a.samples > 2u ? 1u : j; }

// What the next frame follows from.
struct SweptFrame {
    vec3 at, along, side;
};

FN vec3 squared(vec3 along, vec3 side) {
    vec3 s = side - along * dot3(along, side);
    return unit3(s);
}
// At right angles to a unit vector, whichever way it points.
FN vec3 anySide(vec3 along) {
    float x = absolute(along.x);
    float y = absolute(along.y);
    float z = absolute(along.z);
    bool leastX = both(x <= y, x <= z);
    bool leastY = y <= z;
    float ax = leastX ? 1.0f : 0.0f;
    float ay = (1.0f - ax) * (leastY ? 1.0f : 0.0f);
    vec3 axis = vec3(ax, ay, 1.0f - ax - ay);
    return squared(along, axis);
}
FN vec3 mirrored(vec3 v, vec3 plane, float scale) { return v - plane * (scale * dot3(plane, v)); }
FN float mirrorScale(vec3 plane) {
    float n = dot3(plane, plane);
    return n > 1e-30f ? 2.0f * rcpExact(n) : 0.0f;
}
FN SweptFrame nextFrame(SweptFrame f, vec3 at, vec3 along) {
    vec3 step = at - f.at;
    float k = mirrorScale(step);
    vec3 side = mirrored(f.side, step, k);
    vec3 turned = along - mirrored(f.along, step, k);
    side = mirrored(side, turned, mirrorScale(turned));
    SweptFrame n;
    n.at = at;
    n.along = along;
    n.side = squared(along, side);
    return n;
}
FN SweptFrame frameAt(vec3 at, vec3 along) {
    SweptFrame f;
    f.at = at;
    f.along = along;
    f.side = anySide(along);
    return f;
}
FN vec3 otherSide(SweptFrame f) { return cross3(f.along, f.side); }
FN void sweepFrames(FrameArgs a, uint c) {
    SweptFrame f;
    for (uint j = 0u; j < a.samples; ++j) {
        uint e = j * a.row + c;
        vec3 at = takeVector(a.path, e);
        vec3 along = alongPath(takeVector(a.path, sampleBefore(a, j) * a.row + c), takeVector(a.path, sampleAfter(a, j) * a.row + c));
        if (j == 0u)
            f = frameAt(at, along);
        else
            f = nextFrame(f, at, along);
        vec3 other = otherSide(f);
        putVector(a.to, e, f.side);
        planeOf(a.to, 3u).v[e] = other.x;
        planeOf(a.to, 4u).v[e] = other.y;
        planeOf(a.to, 5u).v[e] = other.z;
    }
}

struct LoftArgs {
    NodePlanes path, frames, ring;   // ring: one curve
    NodePlanes to; // vertex u of sample j of curve c is element (j * ringSamples + u) * row + c
    UintBuf normals;                 // of `to`'s elements, octahedral
    uint row, ringRow;               // of path and `to`; of ring
    uint curves, samples, ringSamples;
    uint ringClosed;
    float taper;                     // the ring's size at the curve's end, of that at its beginning
    uint spare;
};
STATIC_SIZE(LoftArgs, 104);

// A place on the ring and the direction that its outside has there, in the frame: (side, other side, along).
struct RingPlace {
    vec3 at;
    vec2 outside;
};
FN RingPlace ringPlace(LoftArgs a, uint j, uint u) {
    uint n = a.ringSamples;
    bool wraps = a.ringClosed != 0u && n > 2u;
    uint before = u > 0u ? u - 1u : wraps ? n - 2u : 0u;
    uint after = u + 1u < n ? u + 1u : wraps ? 1u : u;
    vec3 d = takeVector(a.ring, after * a.ringRow) - takeVector(a.ring, before * a.ringRow);
    float k = rsqrtExact(d.x * d.x + d.y * d.y);
    uint last = a.samples > 1u ? a.samples - 1u : 1u;
    float size = 1.0f + (a.taper - 1.0f) * ratioExact(float(int(j)), float(int(last)));
    RingPlace r;
    r.at = takeVector(a.ring, u * a.ringRow) * size;
    r.outside = vec2(d.y * k, 0.0f - d.x * k);
    return r;
}
struct LoftVertex {
    vec3 at;
    uint normal;
};
FN LoftVertex loftVertex(RingPlace r, vec3 at, vec3 side, vec3 other) {
    LoftVertex v;
    v.at = at + side * r.at.x + other * r.at.y + cross3(side, other) * r.at.z;
    v.normal = packOct(side * r.outside.x + other * r.outside.y);
    return v;
}
FN void placeLoftVertex(LoftArgs a, RingPlace r, uint j, uint u, uint c) {
    uint from = j * a.row + c;
    uint to = (j * a.ringSamples + u) * a.row + c;
    vec3 other = vec3(planeOf(a.frames, 3u).v[from], planeOf(a.frames, 4u).v[from], planeOf(a.frames, 5u).v[from]);
    LoftVertex v = loftVertex(r, takeVector(a.path, from), takeVector(a.frames, from), other);
    putVector(a.to, to, v.at);
    a.normals.v[to] = v.normal;
}

// Corners of triangles over rows of vertices: vertex v of row r of sheet s is element (r * columns + v) * row + s.
struct SheetArgs {
    UintBuf to;
    uint row;
    uint sheets, rows, columns;
    uint quads;    // of all sheets
    uint spare;
};
STATIC_SIZE(SheetArgs, 32);

FN void putQuad(SheetArgs a, uint q) {
    uint across = a.columns - 1u;
    uint v = q % across;
    uint rest = q / across;
    uint r = rest % (a.rows - 1u);
    uint s = rest / (a.rows - 1u);
    uint e00 = (r * a.columns + v) * a.row + s;
    uint e01 = e00 + a.row;
    uint e10 = e00 + a.columns * a.row;
    uint e11 = e10 + a.row;
    a.to.v[6u * q] = e00;
    a.to.v[6u * q + 1u] = e01;
    a.to.v[6u * q + 2u] = e11;
    a.to.v[6u * q + 3u] = e00;
    a.to.v[6u * q + 4u] = e11;
    a.to.v[6u * q + 5u] = e10;
}

ESPALIER_END
#endif
