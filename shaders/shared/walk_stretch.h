// A stretch of a walk inside its chart: how far it may go, and how it lands (walk.h walks). No branch hangs on what
// lanes differ in, so that native code takes several walks through it side by side.
#ifndef ESPALIER_SHARED_WALK_STRETCH_H
#define ESPALIER_SHARED_WALK_STRETCH_H
#include "shaders/shared/walk_state.h"

ESPALIER_BEGIN

// What walkAdvance met. The first leaves nothing to walk; after the next four the rest is still to be walked;
// the last two end the walk.
CONST_UINT(kWalkDone, 0u);     // the length is used up: the step's own sample goes here
CONST_UINT(kWalkSeam, 1u);     // stands on the far side of a crossing: a sample goes here
CONST_UINT(kWalkCrease, 2u);   // stands on a crease inside a chart, about to go down the far side: a sample goes here
CONST_UINT(kWalkBend, 3u);     // part of the way, because the surface turns much: a sample goes here
CONST_UINT(kWalkRetry, 4u);    // part of the way or none of it: nothing to record, call again
CONST_UINT(kWalkOpen, 5u);     // stopped at a border of the model: a sample goes here, `remaining` was not walked
CONST_UINT(kWalkLost, 6u);     // stopped: the surface has no data where the walk leads; w is where it last stood

// Events without visible progress that one step may have; then what is left of it is dropped (kWalkDone), or,
// when nothing of it was walked, the walk is lost.
CONST_UINT(kWalkMaxTries, 24u);
CONST_UINT(kWalkMaxPieces, 2048u);       // pieces that one step may be walked in; then its rest is dropped too
CONST_FLOAT(kWalkMaxTexels, 16.0f);      // longest stretch walked in one go
CONST_FLOAT(kWalkCreaseTexels, 2.0f);    // the same among creases, where a stretch should cross no more than one
CONST_FLOAT(kWalkMaxRadii, 256.0f);      // longest length that may be asked for, in radii of the surface
CONST_FLOAT(kWalkTurnCosine, 0.94f);     // a stretch over which the normal turns by more than 20 degrees is cut
CONST_FLOAT(kWalkBulgeTexels, 0.2f);     // or that bulges by more
CONST_FLOAT(kWalkBentCosine, 0.996f);    // a stretch that turned by 5 degrees ends with a sample

FN bool walkGoesOn(uint event) { return event >= kWalkSeam && event <= kWalkRetry; }
FN bool walkHasSample(uint event) { return event != kWalkRetry && event != kWalkLost; }

struct Stretch {
    float metres;        // object space
    bool partly;         // less than what remains
    float pace;          // UV per metre
    vec2 rate;           // pace with a direction
    vec2 delta;          // in UV
    bool searches;       // it may meet a crossing
};

// What remains, unless the surface turns or it is very many texels. wanted: what remains, object metres. texel: of the
// level that w stands on, in UV.
FN Stretch stretchOf(WalkState w, float wanted, float texel) {
    Stretch s = {};
    s.rate = spreadRate(w.du, w.dv, w.spread, w.walk.direction);
    s.pace = length2(s.rate);
    float most = (w.flags & kWalkFlagCrease) != 0u ? kWalkCreaseTexels : kWalkMaxTexels;
    // What is surely within reach doesn't wait for the pace.
    float farthest = wanted;
    if (!(w.limit >= wanted && wanted * s.pace < 0.999f * most * texel)) {
        farthest = smaller(w.limit, most * texel * rcpExact(s.pace));
    }
    s.partly = farthest < wanted;
    s.metres = s.partly ? farthest : wanted;
    s.delta = s.rate * s.metres;
    // Where a walk goes to and fro between segments that overlap by a hair, or about a corner, it goes blindly on now and
    // then; twice, since to and fro are two tries.
    bool blind = (w.flags & 7u) >= 6u;
    s.searches = !blind && ((w.flags & kWalkFlagLoose) != 0u || s.pace * s.metres >= w.clear);
    return s;
}

// How a stretch would land on the patch at its end. One of the first three holds, or it lands there.
struct Landing {
    bool passed;         // a sharp crease that has been gone over, or lies ahead close to the end: straight on
    bool crosses;        // a sharp crease lies on the way
    bool turns;          // the surface turns too much for a stretch so long
    vec3 direction;
    vec2 correction;     // of the end, in UV: the rates of both ends count
    float turn;          // cosine
    float toCrease;      // object metres, where there is one
    float height, sine2; // of the walk over the far plane; squared sine of the turn, at least .01
};

FN Landing landingOf(WalkState w, Stretch s, Patch p, float texel) {
    vec3 n = w.normal;
    vec3 t = w.walk.direction;
    Landing l = {};
    l.direction = carriedTangent(t, n, p.normal);
    vec2 rate1 = tangentRate(p.du, p.dv, l.direction);
    l.turn = dot3(n, p.normal);
    bool creased = either((w.flags & kWalkFlagCrease) != 0u, texelCrease(p.bits));
    // Two planes meet toCrease ahead; on a smooth patch the rates of both ends count alike.
    // Of what follows, smooth stretches need nothing.
    float slope = dot3(p.normal, t);
    vec3 chord = p.position - w.position;
    bool bulges = absolute(dot3(n, chord)) * s.pace > kWalkBulgeTexels * texel;
    l.toCrease = divExact(dot3(p.normal, chord), slope);
    bool ahead = l.toCrease >= 0.0f;
    bool beyond = l.toCrease > s.metres;
    bool steep = absolute(slope) > 1e-3f;
    bool meet = both(both(creased, steep), both(ahead, !beyond));
    l.correction = (rate1 - s.rate) * (meet ? s.metres - l.toCrease : 0.5f * s.metres);
    // Both ends far under each other's planes: the surface bulges between them.
    bool under = absolute(slope * l.toCrease) * s.pace > kWalkBulgeTexels * texel;
    bool bent = l.turn < kWalkTurnCosine;
    bool veers = dot2(l.correction, l.correction) > 0.04f * dot2(s.delta, s.delta);
    bool far = s.pace * s.metres > 0.5f * texel;
    // A sharp crease. The nearest texel changes sides up to half a texel before or after the planes do.
    float close = creased ? texel * rcpExact(s.pace) : 0.0f;
    l.height = slope * l.toCrease;
    l.sine2 = larger(1.0f - l.turn * l.turn, 0.01f);
    bool steeper = absolute(slope) > 1e-2f;
    bool beside = l.height * l.height <= close * close * l.sine2;
    bool sharp = both(both(creased, bent), both(steeper, either(ahead, beside)));
    bool left = l.toCrease < 0.05f * close;
    bool over = both((w.flags & kWalkFlagOver) != 0u, left);
    bool soon = l.toCrease <= s.metres + close;
    l.passed = both(sharp, either(over, both(beyond, soon)));
    l.crosses = both(sharp, !beyond);
    l.turns = both(far, either(either(bent, veers), both(bulges, under)));
    return l;
}
FN bool lands(Landing l) { return !either(either(l.passed, l.crosses), l.turns); }

// Takes the walk to where it lands; `to`: where it would have come without correction. Returns its event.
FN uint landOn(INOUT(WalkState) w, Stretch s, Landing l, Patch p, vec2 to, float texel) {
    w.walk.uv = to + l.correction;
    w.slip = vec2(0.0f) - l.correction;
    w.walk.direction = l.direction;
    standOn(w, p, texel);
    w.position = w.position + p.du * l.correction.x + p.dv * l.correction.y;
    w.clear = larger(w.clear - length2(l.correction), 0.0f);
    w.limit = l.turn > 0.985f ? w.limit * 2.0f : w.limit;
    w.limit = smaller(w.limit, 1e30f);
    bool bend = (w.flags & kWalkFlagBend) != 0u;
    w.flags = w.flags & ~(kWalkFlagLoose | kWalkFlagBend | kWalkFlagOver);
    return !s.partly ? kWalkDone : bend || l.turn < kWalkBentCosine ? kWalkBend : kWalkRetry;
}

// A patch on which a stretch may end that met no crossing. A gutter texel with room around it lies wholly outside: a gap
// between crossings let the walk through.
FN bool liesInside(Patch p) { return either(texelClass(p.bits) <= kTexelInner, texelClearance(p.bits) == 0u); }

// Counts what a stretch has walked, object metres, and gives up after too many. tries: those without visible progress,
// this one too. Returns the event that comes of it.
FN uint endStretch(INOUT(WalkState) w, INOUT(float) remaining, uint met, float walked, uint tries, float scale) {
    uint event = met;
    float walkedWorld = walked * scale;
    w.walk.arc = w.walk.arc + walkedWorld;
    remaining = event == kWalkDone ? 0.0f : larger(remaining - walkedWorld, 0.0f);
    w.flags = walked > 0.0f ? w.flags | kWalkFlagMoved : w.flags;
    uint pieces = (w.flags >> 16u) + 1u;
    bool tired = walkGoesOn(event) && (tries >= kWalkMaxTries || pieces >= kWalkMaxPieces);
    event = tired ? ((w.flags & kWalkFlagMoved) != 0u ? kWalkDone : kWalkLost) : event;
    remaining = tired ? 0.0f : remaining;
    bool ended = !walkGoesOn(event);
    w.flags = w.flags & ~(0xFFFF00FFu | (ended ? kWalkFlagMoved : 0u));
    w.flags = ended ? w.flags : w.flags | tries | (pieces << 16u);
    return event;
}

ESPALIER_END
#endif
