// Segments of lines and pieces that merge (Li 2011 §4.4): a segment ends at the first that it crosses, a piece goes into
// a like one that stands near.
#ifndef ESPALIER_SHARED_PATTERN_MERGE_H
#define ESPALIER_SHARED_PATTERN_MERGE_H
#include "shaders/shared/exact.h"
#include "shaders/shared/pattern_piece.h"

ESPALIER_BEGIN

CONST_FLOAT(kMergeBegin, 0.05f);      // of a segment's width: what it crosses within this from its begin is where it comes from
CONST_FLOAT(kMergeEnd, 0.1f);         // and what it nearly reaches by its end stops it
CONST_FLOAT(kMergeHeight, 0.15f);     // of two segments' lengths: how far above each other they still cross, beside widths
CONST_FLOAT(kCutMost, 0.999999f);     // share that is left of a segment that another one stops at its very end

// The layers of the grid: who meets whom.
CONST_UINT(kPieceLayers, 3u);
FN uint layerOf(uint mesh) { return (mesh & kPieceLine) != 0u ? 1u : (mesh & kPieceMerges) != 0u ? 2u : 0u; }

// Whether segment a ends at b, at which share of its own length, and at which share of b's. Seen along the mean of both
// normals, chords are straight, so that two lines cross at most once.
FN bool segmentsCross(PatternPiece a, PatternPiece b, OUT(float) at, OUT(float) there) {
    at = 1.0f;
    there = 0.0f;
    float aa = dot3(a.x, a.x);
    float bb = dot3(b.x, b.x);
    float wa = sqrtExact(dot3(a.y, a.y));
    float wb = sqrtExact(dot3(b.y, b.y));
    float la = sqrtExact(aa);
    float lb = sqrtExact(bb);
    vec3 n = a.y * rcpExact(wa) + b.y * rcpExact(wb);
    float c = dot3(n, cross3(a.x, b.x));
    // Of sheets that face away from each other, or side by side.
    if (dot3(a.y, b.y) <= 0.0f || absolute(c) < 1e-5f * la * lb) return false;
    vec3 off = b.position - a.position;
    float t = divExact(dot3(n, cross3(off, b.x)), c);
    float s = divExact(dot3(n, cross3(off, a.x)), c);
    bool on = t * la > kMergeBegin * wa && t * la <= la + kMergeEnd * wa && s * lb >= -kMergeBegin * wb &&
              s * lb <= lb + kMergeBegin * wb;
    vec3 apart = off + b.x * s - a.x * t;
    float height = absolute(dot3(n, apart)) * rsqrtExact(dot3(n, n));
    at = smaller(t, kCutMost);
    there = limited(s, 0.0f, 1.0f);
    return on && height <= wa + wb + kMergeHeight * (la + lb);
}

FN float cosineOf(vec3 a, vec3 b) { return dot3(a, b) * rsqrtExact(dot3(a, a) * dot3(b, b)); }

// Whether piece a goes into b, which has its mesh: it lies within `reach` metres of it, and the turn between them has at
// least this cosine. share: its distance in reaches.
FN bool isLike(PatternPiece a, PatternPiece b, float reach, float turn, OUT(float) share) {
    vec3 off = b.position - a.position;
    share = divExact(sqrtExact(dot3(off, off)), reach);
    float cosine = 0.5f * (cosineOf(a.x, b.x) + cosineOf(a.y, b.y) + cosineOf(a.z, b.z) - 1.0f);
    return (a.mesh & 0xFFFFu) == (b.mesh & 0xFFFFu) && share <= 1.0f && cosine >= turn - 1e-6f;
}
ESPALIER_END
#endif
