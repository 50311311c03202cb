// In: walks, a lane each. Out: the same a stretch further. Loops over all lanes call text without branches, of which
// the compiler makes vectors (CMakeLists.txt lets it); what reads the surface goes lane by lane between them.
#include "runtime/host/wide_walk.hpp"

#include <bit>
#include <initializer_list>

namespace espalier {
namespace {

void put(WideWalks::Vectors& to, WideWalks::Words& bits, uint32_t i, const Texel& t) {
    put(to, i, t.position);
    bits[i] = t.bits;
}

// What changes in a lane as it walks, from it and back to it.
void loadWalk(const WideWalks& l, uint32_t i, WalkState& w) {
    w.position = vectorOf(l.position, i);
    w.du = vectorOf(l.du, i);
    w.dv = vectorOf(l.dv, i);
    w.normal = vectorOf(l.normal, i);
    w.walk.direction = vectorOf(l.heading, i);
    w.walk.uv = {l.u[i], l.v[i]};
    w.walk.arc = l.arc[i];
    w.slip = {l.slipU[i], l.slipV[i]};
    w.spread = l.spread[i];
    w.clear = l.clear[i];
    w.limit = l.limit[i];
    w.flags = l.flags[i];
}
void loadStretch(const WideWalks& l, uint32_t i, Stretch& s) {
    s.metres = l.metres[i];
    s.partly = l.partly[i] != 0;
    s.pace = l.pace[i];
    s.rate = {l.rateU[i], l.rateV[i]};
    s.delta = s.rate * s.metres;
    s.searches = l.searches[i] != 0;
}
void storeWalk(WideWalks& l, uint32_t i, const WalkState& w) {
    put(l.position, i, w.position);
    put(l.du, i, w.du);
    put(l.dv, i, w.dv);
    put(l.normal, i, w.normal);
    put(l.heading, i, w.walk.direction);
    l.u[i] = w.walk.uv.x;
    l.v[i] = w.walk.uv.y;
    l.arc[i] = w.walk.arc;
    l.slipU[i] = w.slip.x;
    l.slipV[i] = w.slip.y;
    l.spread[i] = w.spread;
    l.clear[i] = w.clear;
    l.limit[i] = w.limit;
    l.flags[i] = w.flags;
}

void putCell(WideWalks& l, uint32_t i, const Cell& c) {
    l.at00[i] = c.at00;
    l.at10[i] = c.at10;
    l.at01[i] = c.at01;
    l.at11[i] = c.at11;
    l.fx[i] = c.fx;
    l.fy[i] = c.fy;
}

// Turns, and measures the stretch and where it would end.
inline void setOut(WideWalks& l) {
    for (uint32_t i = 0; i < kWalkLanes; ++i) {
        WalkState w;
        loadWalk(l, i, w);
        const vec3 straight = w.walk.direction;
        rotateHeading(w, l.angle[i]);
        const vec3 turned = w.walk.direction;
        w.walk.direction.x = l.turns[i] != 0 ? turned.x : straight.x;
        w.walk.direction.y = l.turns[i] != 0 ? turned.y : straight.y;
        w.walk.direction.z = l.turns[i] != 0 ? turned.z : straight.z;
        put(l.along, i, w.walk.direction);
        l.remaining[i] = inRange(l.remaining[i], l.farthest[i]);
        l.texel[i] = rcpExact(l.size[i]);
        const Stretch s = stretchOf(w, l.remaining[i] * rcpExact(l.scale[i]), l.texel[i]);
        l.metres[i] = s.metres;
        l.pace[i] = s.pace;
        l.rateU[i] = s.rate.x;
        l.rateV[i] = s.rate.y;
        l.toU[i] = w.walk.uv.x + s.delta.x;
        l.toV[i] = w.walk.uv.y + s.delta.y;
        l.partly[i] = s.partly ? 1 : 0;
        l.searches[i] = s.searches ? 1 : 0;
        putCell(l, i, cellAt(l.size[i], {l.toU[i], l.toV[i]}));
    }
}

// Has the processor fetch what the next two ask for.
void expectEnd(const WideWalks& l, uint32_t i, SurfaceBuf surfaces) {
    const SurfaceLevel& level = surfaces.v[l.instance[i]].levels[l.level[i]];
    for (uint32_t at : {l.at00[i], l.at10[i], l.at01[i], l.at11[i]}) ESPALIER_WILL_READ(level.texels.v + at);
    if (l.searches[i] != 0) ESPALIER_WILL_READ(level.crossingHead.v + l.at00[i]);
}

// Of a stretch that leaves its chart the end is beyond the crossing: it is read there.
bool leavesChart(WideWalks& l, uint32_t i, SurfaceBuf surfaces) {
    if (l.searches[i] == 0) return false;
    Stretch s;
    loadStretch(l, i, s);
    const vec2 slip = {l.slipU[i], l.slipV[i]}, uv = {l.u[i], l.v[i]};
    const bool loose = (l.flags[i] & kWalkFlagLoose) != 0;
    const Exit leave =
        findExit(surfaces, l.instance[i], l.level[i], l.chart[i], uv + slip, s.delta - slip, l.clear[i], loose);
    if (leave.fraction > 1.0f) return false;
    WalkState w;
    loadWalk(l, i, w);
    w.walk.place = l.instance[i] << 16 | l.chart[i];
    w.orientation = l.orientation[i];
    w.level = l.level[i];
    Reach& r = l.reach[i];
    r = reachInside(w, s, l.texel[i]);
    reachBeyond(surfaces, l.wanted[i], w, s.delta, leave, r);
    l.instance[i] = r.place >> 16;
    l.chart[i] = r.place & 0xFFFF;
    l.level[i] = r.level;
    l.orientation[i] = r.orientation;
    l.size[i] = float(surfaces.v[l.instance[i]].levels[r.level].size);
    l.toU[i] = r.to.x;
    l.toV[i] = r.to.y;
    putCell(l, i, cellAt(l.size[i], r.to));
    expectEnd(l, i, surfaces);
    return true;
}

void readEnd(WideWalks& l, uint32_t i, SurfaceBuf surfaces) {
    const uint32_t instance = l.instance[i], level = l.level[i];
    put(l.texel00, l.bits00, i, readTexel(surfaces, instance, level, l.at00[i]));
    put(l.texel10, l.bits10, i, readTexel(surfaces, instance, level, l.at10[i]));
    put(l.texel01, l.bits01, i, readTexel(surfaces, instance, level, l.at01[i]));
    put(l.texel11, l.bits11, i, readTexel(surfaces, instance, level, l.at11[i]));
}

inline void blendEnds(WideWalks& l) {
    for (uint32_t i = 0; i < kWalkLanes; ++i) {
        const Cell c = {l.at00[i], l.at10[i], l.at01[i], l.at11[i], l.fx[i], l.fy[i]};
        const CellBlend b = blendOf(c, l.size[i], l.chart[i], {l.toU[i], l.toV[i]},
                                    {vectorOf(l.texel00, i), l.bits00[i]}, {vectorOf(l.texel10, i), l.bits10[i]},
                                    {vectorOf(l.texel01, i), l.bits01[i]}, {vectorOf(l.texel11, i), l.bits11[i]});
        put(l.position1, i, b.position);
        put(l.du1, i, b.du);
        put(l.dv1, i, b.dv);
        l.nearest[i] = b.nearest;
        l.bits[i] = b.bits;
        l.own[i] = b.own ? 1 : 0;
        l.creased[i] = b.creased ? 1 : 0;
        l.valid[i] = b.valid ? 1 : 0;
    }
}

CellBlend blendIn(const WideWalks& l, uint32_t i) {
    return {vectorOf(l.position1, i), vectorOf(l.du1, i), vectorOf(l.dv1, i), l.nearest[i], l.bits[i], l.own[i] != 0,
            l.creased[i] != 0,        l.valid[i] != 0};
}

void readPlane(WideWalks& l, uint32_t i, SurfaceBuf surfaces) {
    CellBlend b = blendIn(l, i);
    if (!needsPlane(b)) return;
    takePlane(surfaces, l.instance[i], l.level[i], {l.toU[i], l.toV[i]}, b);
    put(l.position1, i, b.position);
    put(l.du1, i, b.du);
    put(l.dv1, i, b.dv);
    l.valid[i] = b.valid ? 1 : 0;
}

inline void land(WideWalks& l) {
    for (uint32_t i = 0; i < kWalkLanes; ++i) {
        WalkState w;
        loadWalk(l, i, w);
        w.walk.direction = vectorOf(l.along, i);
        const float texel = l.texel[i];
        Stretch s;
        loadStretch(l, i, s);
        Patch p;
        const bool found = patchFrom(blendIn(l, i), l.orientation[i], p);
        const Landing landing = landingOf(w, s, p, texel);
        l.landed[i] = both(found, both(liesInside(p), lands(landing))) ? 1 : 0;
        const uint32_t tries = s.partly ? 0 : (w.flags & 0xFF) + 1;
        const uint32_t met = landOn(w, s, landing, p, {l.toU[i], l.toV[i]}, texel);
        float remaining = l.remaining[i];
        l.event[i] = endStretch(w, remaining, met, s.metres, tries, l.scale[i]);
        l.remaining[i] = remaining;
        storeWalk(l, i, w);
        l.packedNormal[i] = packOct(w.normal);
        l.packedHeading[i] = packOct(w.walk.direction);
    }
}

// The loops over all lanes, for each kind of vectors.
struct LaneLoops {
    void (*setOut)(WideWalks&);
    void (*blendEnds)(WideWalks&);
    void (*land)(WideWalks&);
};
template <void (*kLoop)(WideWalks&)>
ESPALIER_AVX2 void withAvx2(WideWalks& l) {
    kLoop(l);
}
template <void (*kLoop)(WideWalks&)>
ESPALIER_AVX512 void withAvx512(WideWalks& l) {
    kLoop(l);
}
constexpr LaneLoops kLoopsAvx2 = {withAvx2<setOut>, withAvx2<blendEnds>, withAvx2<land>},
                    kLoopsAvx512 = {withAvx512<setOut>, withAvx512<blendEnds>, withAvx512<land>};

// visit(lane) for each bit.
template <class Visit>
void forLanes(uint32_t lanes, const Visit& visit) {
    for (; lanes != 0; lanes &= lanes - 1) visit(uint32_t(std::countr_zero(lanes)));
}

}  // namespace

void putWalk(WideWalks& l, uint32_t i, SurfaceBuf surfaces, uint32_t level, const WalkState& w, float remaining) {
    storeWalk(l, i, w);
    l.remaining[i] = remaining;
    l.turns[i] = 0;
    l.instance[i] = w.walk.place >> 16;
    l.chart[i] = w.walk.place & 0xFFFF;
    l.level[i] = w.level;
    l.wanted[i] = level;
    const SurfaceRef& surface = surfaces.v[l.instance[i]];
    l.orientation[i] = w.orientation;
    l.size[i] = float(surface.levels[w.level].size);
    l.scale[i] = surface.scale;
    l.farthest[i] = kWalkMaxRadii * surface.radius * surface.scale;
}

uint32_t advanceWide(WideWalks& l, SurfaceBuf surfaces, uint32_t lanes) {
    const LaneLoops& loops = l.vectors == VectorKind::avx512 ? kLoopsAvx512 : kLoopsAvx2;
    loops.setOut(l);
    forLanes(lanes, [&](uint32_t i) { expectEnd(l, i, surfaces); });
    forLanes(lanes, [&](uint32_t i) { l.leaves[i] = leavesChart(l, i, surfaces) ? 1 : 0; });
    forLanes(lanes, [&](uint32_t i) { readEnd(l, i, surfaces); });
    loops.blendEnds(l);
    forLanes(lanes, [&](uint32_t i) { readPlane(l, i, surfaces); });
    loops.land(l);
    uint32_t landed = 0;
    forLanes(lanes, [&](uint32_t i) { landed |= (l.landed[i] & ~l.leaves[i]) << i; });
    return landed;
}

void takeWalk(const WideWalks& l, uint32_t i, WalkState& w) {
    loadWalk(l, i, w);
}

uint32_t takeMeeting(const WideWalks& l, uint32_t i, WalkState& w, float& remaining, vec3& jointNormal) {
    w.walk.direction = vectorOf(l.along, i);
    remaining = inRange(remaining, l.farthest[i]);
    Stretch s;
    loadStretch(l, i, s);
    Reach r = reachInside(w, s, l.texel[i]);
    if (l.leaves[i] != 0) r = l.reach[i];
    Patch p;
    const bool found = patchFrom(blendIn(l, i), l.orientation[i], p);
    return takeReach(w, remaining, s, r, p, found, l.texel[i], l.scale[i], jointNormal);
}

}  // namespace espalier
