// Deform programs: what modifiers of the graph do to geometry, as a list of steps that geometry carries along. Nothing
// is copied: the steps are taken where a vertex is drawn, or where a node needs the positions themselves. A step that
// places instances is one of them, so what comes behind it bends all instances together.
#ifndef ESPALIER_SHARED_NODE_DEFORM_H
#define ESPALIER_SHARED_NODE_DEFORM_H
#include "shaders/shared/node_function.h"

ESPALIER_BEGIN

CONST_UINT(kDeformMove, 0u);       // a[0..11]: three rows of a matrix of 3 x 4
CONST_UINT(kDeformSpherify, 1u);   // a: centre, radius, share
CONST_UINT(kDeformTwist, 2u);      // a: centre, unit axis, radians a metre
CONST_UINT(kDeformBend, 3u);       // a: centre, unit axis, unit direction towards which it bends, 1 / metres
CONST_UINT(kDeformNoise, 4u);      // a: metres, features a metre, offset; seed
CONST_UINT(kDeformWave, 5u);       // a: metres along a unit direction, travel (unit) / metres a wave, turns
CONST_UINT(kDeformDisplace, 6u);   // as noise, along the normal
CONST_UINT(kDeformInstance, 7u);   // points: places; if given, normals: upwards there, sizes: times those,
                                   // which: the place that each instance stands at; a: size, spread of sizes, of
                                   // turns; seed
CONST_UINT(kDeformFunction, 8u);   // code: normals, of `row` words; a: its inputs a, b, c
CONST_UINT(kDeformPicture, 9u);    // sizes: a picture's grey of 0 to 1, `used` rows of `row` texels from the top on;
                                   // a: metres of white, grey that stays, pictures a metre, offset
CONST_UINT(kMostDeforms, 64u);     // steps of a program

struct DeformOp {
    uint kind;
    uint seed;
    NodePlanes points;   // count: without padding
    UintBuf normals;
    FloatBuf sizes;
    UintBuf which;
    uint row, used;      // of points: of each `row` elements in memory the first `used` are meant
    float a[12];
};
STATIC_SIZE(DeformOp, 104);
BUFFER(DeformOpBuf, DeformOp)

FN vec3 axisOf(DeformOp op, uint first) { return vec3(op.a[first], op.a[first + 1u], op.a[first + 2u]); }

FN vec3 moveStep(DeformOp op, vec3 p) {
    return vec3(dot3(axisOf(op, 0u), p) + op.a[3], dot3(axisOf(op, 4u), p) + op.a[7], dot3(axisOf(op, 8u), p) + op.a[11]);
}
FN vec3 spherifyStep(DeformOp op, vec3 p) {
    vec3 d = p - axisOf(op, 0u);
    vec3 on = axisOf(op, 0u) + d * (op.a[3] * rsqrtExact(dot3(d, d)));
    return p + (on - p) * op.a[4];
}
FN vec3 turnedAbout(vec3 v, vec3 axis, float angle) {
    float s;
    float c;
    sinCosExact(within(angle, 1e4f), s, c);
    return v * c + cross3(axis, v) * s + axis * (dot3(axis, v) * (1.0f - c));
}
FN vec3 twistStep(DeformOp op, vec3 p) {
    vec3 d = p - axisOf(op, 0u);
    return axisOf(op, 0u) + turnedAbout(d, axisOf(op, 3u), op.a[6] * dot3(d, axisOf(op, 3u)));
}
// What lies along the axis comes to lie on a circle; its length stays.
FN vec3 bendStep(DeformOp op, vec3 p) {
    vec3 axis = axisOf(op, 3u);
    vec3 towards = axisOf(op, 6u);
    vec3 d = p - axisOf(op, 0u);
    float along = dot3(d, axis);
    float out1 = dot3(d, towards);
    float k = op.a[9];
    float s;
    float c;
    sinCosExact(within(k * along, 1e4f), s, c);
    float radius = rcpExact(k) - out1;
    bool bends = absolute(k) > 1e-6f;
    float newAlong = bends ? radius * s : along;
    float newOut = bends ? rcpExact(k) - radius * c : out1;
    return p + axis * (newAlong - along) + towards * (newOut - out1);
}

FN vec3 noiseStep(DeformOp op, vec3 p) {
    vec3 at = p * op.a[1] + axisOf(op, 2u);
    return p + vec3(latticeNoise(op.seed, at), latticeNoise(op.seed + 1u, at), latticeNoise(op.seed + 2u, at)) * op.a[0];
}
FN vec3 waveStep(DeformOp op, vec3 p) {
    float turns = within(dot3(axisOf(op, 4u), p) + op.a[7], 1e6f);
    float s;
    float c;
    sinCosExact(6.28318531f * (turns - floorExact(turns)), s, c);
    return p + axisOf(op, 1u) * (op.a[0] * s);
}
FN vec3 displaceStep(DeformOp op, vec3 p, vec3 n) {
    return p + n * (op.a[0] * latticeNoise(op.seed, p * op.a[1] + axisOf(op, 2u)));
}
// The grey at a place of a picture that repeats: u to the right and v upwards, in pictures.
FN float pictureAt(DeformOp op, float u, float v) {
    float s = within(u, 1e6f);
    float t = 0.0f - within(v, 1e6f);
    float x = (s - floorExact(s)) * float(int(op.row)) - 0.5f;
    float y = (t - floorExact(t)) * float(int(op.used)) - 0.5f;
    float fx = floorExact(x);
    float fy = floorExact(y);
    uint left = fx < 0.0f ? op.row - 1u : uint(int(fx));
    uint over = fy < 0.0f ? op.used - 1u : uint(int(fy));
    uint right = left + 1u >= op.row ? 0u : left + 1u;
    uint under = over + 1u >= op.used ? 0u : over + 1u;
    float a = op.sizes.v[over * op.row + left];
    float b = op.sizes.v[under * op.row + left];
    a = a + (op.sizes.v[over * op.row + right] - a) * (x - fx);
    b = b + (op.sizes.v[under * op.row + right] - b) * (x - fx);
    return a + (b - a) * (y - fy);
}
// The picture lies over the surface from three sides, each the more the more the surface faces it.
FN vec3 pictureStep(DeformOp op, vec3 p, vec3 n) {
    vec3 q = p * op.a[2] + axisOf(op, 3u);
    float grey = n.x * n.x * pictureAt(op, q.z, q.y) + n.y * n.y * pictureAt(op, q.x, q.z) + n.z * n.z * pictureAt(op, q.x, q.y);
    return p + n * (op.a[0] * (grey - op.a[1]));
}
FN vec3 functionStep(DeformOp op, vec3 p) { return runFunction(op.normals, op.row, p, axisOf(op, 0u)); }
FN uint instancesOf(DeformOp op) { return op.kind == kDeformInstance ? op.points.count : 1u; }
// Where an instance has what lies at p: y is upwards there. Its size and turn follow from the place, so they stay when
// other places go.
FN vec3 instanceStep(DeformOp op, vec3 p, uint instance) {
    uint i = instance;
    if (IS_GIVEN(op.which)) i = op.which.v[instance];
    uint at = i / op.used * op.row + i % op.used;
    vec3 up = vec3(0.0f, 1.0f, 0.0f);
    if (IS_GIVEN(op.normals)) up = unpackOct(op.normals.v[at]);
    float lies = sqrtExact(up.x * up.x + up.z * up.z);
    bool upright = lies < 1e-4f;
    // Of all that point upwards, the turn that moves y there by the shortest way.
    float k = upright ? 0.0f : rcpExact(lies);
    vec3 axis = vec3(up.z * k, 0.0f, 0.0f - up.x * k);
    float s;
    float c;
    sinCosExact(6.28318531f * op.a[2] * (nodeRandom(op.seed, i, 1u) - 0.5f), s, c);
    float size = op.a[0] * (1.0f + op.a[1] * (2.0f * nodeRandom(op.seed, i, 0u) - 1.0f));
    if (IS_GIVEN(op.sizes)) size = size * op.sizes.v[at];
    vec3 d = vec3(p.x * c + p.z * s, p.y, p.z * c - p.x * s) * size;
    vec3 turned = d * up.y + cross3(axis, d) * lies + axis * (dot3(axis, d) * (1.0f - up.y));
    bool over = both(upright, up.y < 0.0f);
    d = upright ? vec3(d.x, over ? 0.0f - d.y : d.y, over ? 0.0f - d.z : d.z) : turned;
    return takeVector(op.points, at) + d;
}
// Which instance of each step that places some is meant by a number of all: the first step's number counts fastest.
FN vec3 deformStep(DeformOp op, vec3 p, vec3 n, INOUT(uint) instance) {
    if (op.kind == kDeformMove) return moveStep(op, p);
    if (op.kind == kDeformSpherify) return spherifyStep(op, p);
    if (op.kind == kDeformTwist) return twistStep(op, p);
    if (op.kind == kDeformBend) return bendStep(op, p);
    if (op.kind == kDeformNoise) return noiseStep(op, p);
    if (op.kind == kDeformWave) return waveStep(op, p);
    if (op.kind == kDeformDisplace) return displaceStep(op, p, n);
    if (op.kind == kDeformFunction) return functionStep(op, p);
    if (op.kind == kDeformPicture) return pictureStep(op, p, n);
    uint i = instance % op.points.count;
    instance = instance / op.points.count;
    return instanceStep(op, p, i);
}

// Positions of geometry as its program leaves them; of instances one after the other.
struct DeformArgs {
    NodePlanes from, to;
    UintBuf normals;     // of from; null: it has none, and what asks for them gets (0, 1, 0)
    UintBuf toNormals;   // those as the program leaves them; null: nobody needs them
    DeformOpBuf ops;
    uint opCount;
    uint each;           // elements from one instance to the next: whole rows
    float step;          // metres from a place to others, by which normals are found
    float perStep;       // 1 / step
    uint headings;       // 1: normals are where points are heading, and move along; 0: they stand upon a surface
    uint spare;
};
STATIC_SIZE(DeformArgs, 80);

FN vec3 startNormal(UintBuf normals, uint i) {
    vec3 n = vec3(0.0f, 1.0f, 0.0f);
    if (IS_GIVEN(normals)) n = unpackOct(normals.v[i]);
    return n;
}
FN void deformElement(DeformArgs a, uint i) {
    uint own = i % a.each;
    uint instance = i / a.each;
    vec3 p = takeVector(a.from, own);
    vec3 n = startNormal(a.normals, own);
    for (uint k = 0u; k < a.opCount; ++k) p = deformStep(a.ops.v[k], p, n, instance);
    putVector(a.to, i, p);
}
// Two steps along the surface are moved, too: they tell where its outside has turned. Of a heading the place ahead is. One
// loop for both steps, so that a kernel has the program's text once more and not twice.
FN void deformNormal(DeformArgs a, uint i) {
    uint own = i % a.each;
    vec3 n = startNormal(a.normals, own);
    vec3 across = unit3(cross3(n, absolute(n.y) < 0.7f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f)));
    bool heads = a.headings != 0u;
    vec3 along = heads ? n : across;
    vec3 first = n;
    vec3 turned = n;
    uint sides = heads ? 1u : 2u;
    for (uint side = 0u; side < sides; ++side) {
        uint instance = i / a.each;
        vec3 p = takeVector(a.from, own) + along * a.step;
        for (uint k = 0u; k < a.opCount; ++k) p = deformStep(a.ops.v[k], p, n, instance);
        p = (p - takeVector(a.to, i)) * a.perStep;
        turned = heads ? p : cross3(first, p);
        first = p;
        along = cross3(n, across);
    }
    float square = dot3(turned, turned);
    a.toNormals.v[i] = packOct(square > 0.0f ? turned * rsqrtExact(square) : n);
}

ESPALIER_END
#endif
