// A chunk's samples before it is published: staged in words of the invocation's own, since they get their place at
// its end. A step's samples are laid on the mesh as it ends, with one more wherever its span would leave the surface
// (Buron 2015 §6 has the spans): a step may go over several edges of triangles, and its ends tell nothing of these.
#ifndef ESPALIER_SHARED_EXPAND_STAGE_H
#define ESPALIER_SHARED_EXPAND_STAGE_H
#include "records/staged_sample.h"
#include "shaders/shared/bezier.h"
#include "shaders/shared/expand_scope.h"
#include "shaders/shared/triangle_lookup.h"

ESPALIER_BEGIN

#ifdef __cplusplus
#define STAGED(i) stage.v[i]
// Few steps come here: the others keep their registers.
#define FN_SELDOM ESPALIER_SELDOM inline
#else
#define STAGED(i) LANE_WORD(kLaneStage + (i))
#define FN_SELDOM
#endif

CONST_FLOAT(kAsideTexels, 0.05f);     // a span may leave the surface by so much
CONST_FLOAT(kBendTexels, 0.6f);       // length times turn, from end to end of a step, below which it can't by much,
CONST_FLOAT(kLeanTexels, 0.4f);       // and, beside creases, how far its ends may lie off each other's planes
CONST_FLOAT(kAheadTexels, 0.01f);     // how far beyond an edge the next triangle is looked for
CONST_UINT(kMostFollowed, 48u);       // triangles that are looked at for a step
CONST_UINT(kStepKept, 0u);            // what is done to a step's samples: they stay where they are,
CONST_UINT(kStepLaid, 1u);            // are laid on the mesh,
CONST_UINT(kStepFollowed, 2u);        // and get others between them
CONST_UINT(kRoomToFollow, 3u);        // that a chunk keeps for what such a step may get

// A sample as it is staged.
struct StagedNode {
    vec3 position;
    uint normal;         // packed
    vec2 uv, nearUv;
    uint place, nearPlace;
    float arc;
    bool inserted;
};

FN StagedNode stagedNode(UintBuf stage, uint index) {
    UNUSED(stage);
    StagedSample words = {};
    FILL_StagedSample(words, STAGED, kStagedSample_words * index)
    StagedNode s = {};
    s.position = words.position;
    s.normal = words.normal;
    s.uv = unpackUv(words.uv);
    s.place = words.place;
    s.arc = words.arc;
    s.inserted = (words.flags & kNodeInserted) != 0u;
    s.nearUv = unpackUv(words.nearUv);
    s.nearPlace = words.nearPlace;
    return s;
}

// The sample that a chunk's first span begins with: another chunk's.
FN StagedNode enteredNode(WalkState w) {
    StagedNode s = {};
    s.position = w.position;
    s.normal = packOct(w.normal);
    s.uv = unpackUv(packUv(w.walk.uv));
    s.place = w.walk.place;
    s.arc = w.walk.arc;
    s.inserted = false;
    s.nearUv = s.uv;
    s.nearPlace = s.place;
    return s;
}

FN void stagePosition(UintBuf stage, uint index, vec3 position) {
    UNUSED(stage);
    uint at = kStagedSample_words * index + kStagedSample_position;
    STAGED(at) = floatBitsToUint(position.x);
    STAGED(at + 1u) = floatBitsToUint(position.y);
    STAGED(at + 2u) = floatBitsToUint(position.z);
}

// Makes room before the sample at `index` for one of the same step.
FN void openStage(UintBuf stage, uint index, uint count) {
    UNUSED(stage);
    for (uint i = count; i > index; --i) {
        uint at = i * kStagedSample_words;
        for (uint k = 0u; k < kStagedSample_words; ++k) STAGED(at + k) = STAGED(at - kStagedSample_words + k);
        uint flags = at + kStagedSample_flags;
        STAGED(flags) = (STAGED(flags) & ~0x1F00u) | (i << 8u);
    }
}

// How far above or below a point of the mesh the span from a to b will pass it, metres; normal: of the mesh there.
FN float passedBy(StagedNode a, StagedNode b, vec3 point, vec3 normal, float texel) {
    vec3 chord = b.position - a.position;
    float length2nd = larger(dot3(chord, chord), 1e-30f);
    vec3 n0 = unpackOct(a.normal);
    vec3 n3 = unpackOct(b.normal);
    vec3 t0 = tangentOf(chord, n0);
    vec3 t3 = tangentOf(chord, n3);
    Span s = levelSpan(smoothSpan(a.position, t0, b.position, t3), t0, n0, a.inserted, t3, n3, b.inserted,
                       kAsideTexels * texel);
    float u = limited(dot3(point - a.position, chord) * rcpExact(length2nd), 0.0f, 1.0f);
    return absolute(dot3(normal, spanPoint(s, u) - point));
}

// Lays the samples from `first` on, of `count`, that a step has staged (one at least) on the mesh and, if `whole`, puts
// more in where edges of triangles lie off their spans by more than a little. start: where the step began. texel: its
// width where the walk went, object metres; size: so many of them along a side. ground: the triangle under the start,
// then under the last sample; kNoIndex: not known. Returns how many it has put in.
FN_SELDOM uint layOnMesh(SurfaceBuf surfaces, UintBuf stage, StagedNode start, float texel, float size, bool whole,
                         uint first, uint count, INOUT(uint) ground) {
    uint end = count;
    uint i = first;
    StagedNode a = start;
    StagedNode b = stagedNode(stage, i);
    vec2 at = a.uv;             // how far the span to b has been followed
    bool seated = false;        // b has been laid on `last`
    bool waits = false;         // at `at` the way has left a triangle with normal `before`
    uint lastTriangle = kNoIndex;
    uint passed = kNoIndex;
    vec3 before = vec3(0.0f);
    float step = kAheadTexels * rcpExact(size);
    uint trips = 0u;
    do {   // software devices go through a body once more where the test comes first
        vec2 delta = b.nearUv - at;
        // Charts that border on themselves have neighbours far apart, and another instance has a space of its own.
        vec2 apart = delta * size * texel;
        vec3 chord = b.position - a.position;
        bool follows = b.nearPlace == a.place && b.place >> 16u == a.place >> 16u &&
                       dot2(apart, apart) < 9.0f * dot3(chord, chord) + texel * texel;
        float rate = rsqrtExact(larger(dot2(delta, delta), 1e-30f));
        vec2 ahead = delta * smaller(step * rate, 0.5f);
        TrianglePlane t = {};
        uint triangle = lastTriangle;
        if (seated) t = readPlane(surfaces, a.place >> 16u, triangle);
        if (follows && (!seated || !isInside(t, at + ahead))) {
            vec2 look = seated ? at + ahead : b.nearUv - ahead;
            triangle = waits ? kNoIndex : ground;
            if (triangle != kNoIndex) t = readPlane(surfaces, a.place >> 16u, triangle);
            if (triangle == kNoIndex || !isInside(t, look)) triangle = triangleUnder(surfaces, a.place, look, t);
        }
        vec3 across = cross3(t.du, t.dv);
        float area2 = dot3(across, across);
        float orientation = 0.0f;
        uint coarsest = 0u;
        readChart(surfaces, a.place >> 16u, a.place & 0xFFFFu, orientation, coarsest);
        follows = follows && triangle != kNoIndex && area2 > 1e-36f;
        bool ends = !follows;
        if (follows && !seated) {
            seated = true;
            ends = !whole || isInside(t, at + ahead);
            lastTriangle = triangle;
            b.position = pointOn(t, b.nearUv);
            stagePosition(stage, i, b.position);
            // On a crease the normal is the mean of both sides already.
            if (!b.inserted && b.place == b.nearPlace) {
                b.normal = packOct(across * (orientation * rsqrtExact(area2)));
                STAGED(kStagedSample_words * i + kStagedSample_normal) = b.normal;
            }
        } else if (follows) {
            vec3 normal = across * (orientation * rsqrtExact(area2));
            if (!waits) {
                a.position = pointOn(t, a.uv);
                if (i > 0u) stagePosition(stage, i - 1u, a.position);
            }
            vec3 vertex = vec3(0.0f);
            vec3 mean = normal;
            bool aside = waits && end < kChunkNodes;
            if (aside) {
                vertex = pointOn(t, at);
                mean = unit3(before + normal * 1.0001f);
                float least = kAsideTexels * texel;
                aside = absolute(dot3(mean, vertex - a.position)) > least ||
                        absolute(dot3(mean, vertex - b.position)) > least;
                if (aside) aside = passedBy(a, b, vertex, mean, texel) > least;
            }
            if (aside) {
                openStage(stage, i, end);
                vec2 way = b.nearUv - a.uv;
                float share = dot2(at - a.uv, way) * rcpExact(larger(dot2(way, way), 1e-30f));
                a.position = vertex;
                a.normal = packOct(mean);
                a.uv = at;
                a.arc = a.arc + (b.arc - a.arc) * share;
                a.inserted = true;
                uint to = kStagedSample_words * i;
                stagePosition(stage, i, vertex);
                STAGED(to + kStagedSample_normal) = a.normal;
                STAGED(to + kStagedSample_heading) = packOct(tangentOf(chord, mean));
                STAGED(to + kStagedSample_uv) = packUv(at);
                STAGED(to + kStagedSample_place) = a.place;
                STAGED(to + kStagedSample_arc) = floatBitsToUint(a.arc);
                STAGED(to + kStagedSample_flags) = STAGED(to + kStagedSample_flags) | kNodeInserted;
                STAGED(to + kStagedSample_nearUv) = packUv(at);
                STAGED(to + kStagedSample_nearPlace) = a.place;
                i = i + 1u;
                end = end + 1u;
            }
            float share = shareInside(t, at, delta);
            ends = triangle == lastTriangle || share >= 1.0f;
            // Beside the triangle that was looked for, it is met again: a little further, then.
            at = at + (triangle == passed ? ahead * 10.0f : delta * share);
            passed = triangle;
            waits = true;
            before = normal;
        }
        if (ends) {
            ground = seated && b.place == b.nearPlace ? lastTriangle : kNoIndex;
            a = b;
            i = i + 1u;
            if (i < end) b = stagedNode(stage, i);
            at = a.uv;
            seated = false;
            waits = false;
            passed = kNoIndex;
        }
        trips = trips + 1u;
    } while (trips < kMostFollowed && i < end);
    return end - count;
}

ESPALIER_END
#endif
