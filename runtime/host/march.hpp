#pragma once

// What growth and regrowth as native code share: of the text that ESPALIER_AGAIN makes two of, each of the two files
// that include this has its own.

#include <algorithm>
#include <atomic>
#include <bit>

#include "runtime/core/jobs.hpp"
#include "runtime/host/kernels.hpp"
#include "runtime/host/wide_walk.hpp"
#include "shaders/shared/expand_grow.h"

// All of a pass in one function: its state stays in registers, and pointers needn't be handed on.
#define ESPALIER_WHOLE ESPALIER_FLATTEN

namespace espalier {
namespace {

constexpr uint32_t kFewestLanes = 3;  // fewer walk one by one

// A wave's items, as they are taken by whoever is free. The last are grown first: at their end chunks queue what
// carries a long branch on, and a long one at the end of a wave would keep the others waiting.
struct WaveItems {
    std::atomic<size_t> taken = 0;
    size_t count = 0;
    GrowthWatch* watch = nullptr;
    // kNoIndex: there are no more. nodes: so far.
    uint take(uint nodes) {
        if (!goesOn(watch, nodes)) return kNoIndex;
        const size_t at = taken.fetch_add(1, std::memory_order_relaxed);
        return at < count ? uint(count - 1 - at) : kNoIndex;
    }
};

// A chunk in flight, beside others.
struct Lane {
    ExpandEnv env;
    ChunkGrowth c;
    TableBases map;
    WorldFrame frame;  // of the instance that the chunk grows on
    Machine machine;
    bool live = false;
    uint32_t stage[kChunkNodes * kStagedSample_words];
};

// Whether the step that ends here is made; if not, another direction is tried.
inline bool stepHolds(Lane& lane) {
    Grower& g = lane.c.g;
    if (!conditionHolds(lane.machine, lane.env, lane.map, g)) return false;
#ifndef ESPALIER_AGAIN
    if (keepsDistance(lane.env, g.shape.grammar)) return staysAway(lane.env, lane.c.item, STAND(g), g.trial, g);
#endif
    return true;
}

inline void decideLane(Lane& lane) {
    Grower& g = lane.c.g;
    noteWay(lane.c.site.sceneLayers, g.trial, g.reads);
    const uint instance = g.trial.walk.place >> 16;
    if (instance != lane.frame.instance) lane.frame = frameOf(lane.env.surfaces, instance, lane.c.site.inputs);
    if (!decides(g.progress.phase, g.step.arrived)) return;
    const GrowthSite& site = lane.c.site;
    tellPlace(lane.machine, lane.env, lane.frame, site, g.shape.grammar, g.trial,
              g.progress.steps + (g.step.arrived ? 1 : 0));
    if (g.step.arrived && stepHolds(lane)) {
        const uint staged = g.step.pending;
        if (g.step.laying != kStepKept) layStep(lane.env, site, g);
        if (notesStaged(site.sceneLayers, g.step.pending - staged))
            noteStaged(lane.env, g.progress.count, g.progress.count + g.step.pending, g.reads);
        KEEP_STAND(g);
        finishStep(lane.machine, lane.env, lane.map, g);
    }
    if (g.progress.phase == kPhaseDerive) deriveRules(lane.machine, lane.env, lane.map, site, lane.c.item, g);
}

// Grows the lane's chunk, and those that it takes after, until a stretch is to be walked. False: nothing is left.
ESPALIER_WHOLE bool growToStretch(Lane& lane, WaveItems& items, GrowthTally& tally) {
    for (;;) {
        if (lane.live && growing(lane.c.g.progress)) {
            decideLane(lane);
            if (lane.c.g.progress.phase == kPhaseMarch) return true;
            endTrip(lane.c.g.progress);
        } else {
            if (lane.live) endChunk(lane.env, lane.c, tally);
            lane.live = false;
            const uint item = items.take(std::atomic_ref(lane.env.status.v[0].nodes).load(std::memory_order_relaxed));
            if (item == kNoIndex) return false;
            lane.live = beginChunk(lane.machine, lane.env, lane.env.items.v[item], lane.c);
            if (!lane.live) continue;
            lane.map = basesOf(lane.env, lane.c.g.shape.grammar);
            lane.frame = frameOf(lane.env.surfaces, lane.c.g.trial.walk.place >> 16, lane.c.site.inputs);
        }
    }
}

// One stretch of the walks of those lanes that have a bit in `marching`. wide: null, or where they walk side by side.
ESPALIER_WHOLE void marchLanes(Lane* lanes, uint32_t marching, WideWalks* wide) {
    const SurfaceBuf surfaces = lanes[0].env.surfaces;
    for (uint32_t i = 0; wide && i < kWalkLanes; ++i) {
        if ((marching >> i & 1) == 0) continue;
        const Grower& g = lanes[i].c.g;
        putWalk(*wide, i, surfaces, lanes[i].c.site.level, g.step.fresh ? g.at : g.trial,
                g.step.fresh ? g.rule.distance : g.remaining);
        if (!g.step.fresh) continue;
        wide->turns[i] = 1;
        wide->angle[i] = attemptAngle(g);
    }
    const uint32_t landed = wide ? advanceWide(*wide, surfaces, marching) : 0;
    for (uint32_t i = 0; i < kWalkLanes; ++i) {
        if ((marching >> i & 1) == 0) continue;
        const ExpandEnv& env = lanes[i].env;
        ChunkGrowth& c = lanes[i].c;
        if (!wide) {
            marchOn(env, c.site, c.g);
        } else {
            if (c.g.step.fresh) setOut(c.g);
            if ((landed >> i & 1) != 0) {
                takeWalk(*wide, i, c.g.trial);
                c.g.remaining = wide->remaining[i];
                takeStretch(env, c.site, c.g, wide->event[i], wide->packedNormal[i], wide->packedHeading[i]);
            } else {
                vec3 normal;
                const uint event = takeMeeting(*wide, i, c.g.trial, c.g.remaining, normal);
                takeStretch(env, c.site, c.g, event, packOct(normal), packOct(c.g.trial.walk.direction));
            }
        }
        endTrip(c.g.progress);
    }
}

// Grows items of a wave until none is left, `most` of them side by side.
void growItems(const ExpandEnv& env, WaveItems& items, uint32_t most, bool wide) {
    GrowthTally tally = emptyTally();
    WideWalks walks = {};
    walks.vectors = platform::widestVectors();
    Lane lanes[kWalkLanes];
    for (Lane& lane : lanes) {
        lane.env = env;
        lane.env.scratch = {lane.stage};
    }
    for (uint32_t marching = 1; marching != 0;) {
        marching = 0;
        for (uint32_t i = 0; i < most; ++i)
            if (growToStretch(lanes[i], items, tally)) marching |= 1u << i;
        const bool pays = wide && uint32_t(std::popcount(marching)) >= kFewestLanes;
        marchLanes(lanes, marching, pays ? &walks : nullptr);
    }
    addTally(env, tally);
}

// body(begin, end) over [first, last).
template <class Body>
void overRange(uint32_t first, uint32_t last, size_t grain, Crew& crew, const Body& body) {
    crew.overRange(last > first ? last - first : 0, grain,
                   [&](size_t begin, size_t end) { body(first + begin, first + end); });
}

// Grows wave env.wave, env.phase being the last that may be grown. False: nothing waits in it.
bool growWave(ExpandEnv env, const HostRun& run) {
    const uint32_t wanted = env.waves.v[env.wave].count, count = std::min(wanted, env.itemCapacity);
    if (wanted == 0) return false;
    if (wanted > count) atomicMax(env.status.v[0].items, wanted);
    const bool wide = !run.plain && platform::widestVectors() != VectorKind::narrow && !PAPER_WALK(env);
    WaveItems items;
    items.count = count;
    items.watch = run.watch;
    const uint32_t threads = run.crew.threads();
    const uint32_t side = std::clamp(count / threads, 1u, kWalkLanes);  // few items are for all threads
    run.crew.overRange(std::min(threads, count), 1, [&](size_t, size_t) { growItems(env, items, side, wide); });
    return true;
}

}  // namespace
}  // namespace espalier
