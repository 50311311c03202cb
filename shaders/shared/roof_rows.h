// The grids that an expansion has written: runs of cells for the rows of those that have any, by intervals, and what all
// of them come to.
#ifndef ESPALIER_SHARED_ROOF_ROWS_H
#define ESPALIER_SHARED_ROOF_ROWS_H
#include "records/roof_records.h"
#include "shaders/shared/random.h"
#include "shaders/shared/roof_cells.h"
#include "shaders/shared/subgroup.h"

ESPALIER_BEGIN

FN uint packRun(float first, float last, float cells) {
    first = limited(first, 0.0f, cells);
    last = limited(last, -1.0f, cells - 1.0f);
    return last < first ? 0u : uint(first) | (uint(last - first + 1.0f) << 16u);
}
// What a half-space leaves of each row: it bounds the columns whose boxes reach into it (touched) or lie within it
// (whole), from above or from below, by (room - row * down) * scale and an offset of RowFrame.
struct RowPlane {
    float touched, whole;   // room in row 0
    float down, scale;
    bool upper;
};
// first: the box of the first cell of row 0; inverse: 1 / the step along x.
FN RowPlane rowPlane(CellPlane p, CellBox first, float stepY, float inverse) {
    float a = p.fy * first.low.y;
    float b = p.fy * first.high.y;
    float c = p.fz * first.low.z;
    float d = p.fz * first.high.z;
    bool level = absolute(p.fx) < 1e-6f;   // along the rows: all columns or none
    RowPlane r = {};
    r.touched = p.limit - (smaller(a, b) + smaller(c, d)) - kCellSlack;
    r.whole = p.limit - (larger(a, b) + larger(c, d)) + kCellSlack;
    r.down = p.fy * stepY;
    r.upper = level || p.fx > 0.0f;
    r.scale = level ? 1e9f : rcpExact(p.fx) * inverse;
    return r;
}
// No half-space at all.
FN RowPlane openPlane() {
    RowPlane r = {};
    r.touched = 1e30f;
    r.whole = 1e30f;
    r.down = 0.0f;
    r.scale = 1.0f;
    r.upper = true;
    return r;
}

// Cells that either run has; of whole ones the longer run.
FN RoofRun joinedRuns(RoofRun a, RoofRun b) {
    uint first = runFirst(a.touched) < runFirst(b.touched) ? runFirst(a.touched) : runFirst(b.touched);
    uint endA = runFirst(a.touched) + runCount(a.touched);
    uint endB = runFirst(b.touched) + runCount(b.touched);
    RoofRun run = a;
    if (runCount(a.touched) == 0u) run.touched = b.touched;
    if (runCount(a.touched) != 0u && runCount(b.touched) != 0u)
        run.touched = first | (((endA > endB ? endA : endB) - first) << 16u);
    if (runCount(b.whole) > runCount(a.whole)) run.whole = b.whole;
    return run;
}

// What a grid's rows have in common: bounds that its own rectangle gives, and the box of row 0's first cell.
struct RowFrame {
    float lowTouched, highTouched, lowWhole, highWhole;   // of columns
    float lowOffset, highOffset;                          // of half-spaces that touch a cell's low or high side first
    float low, high, top;                                 // along y: of the first cell, of the rectangle
    float step;
    uint columns;
    bool bond, rectangle;
};
FN RowFrame rowFrame(RoofGrid g, CellBox first, float inverse) {
    bool rectangle = (g.mesh & kGridRect) != 0u;
    RowFrame f = {};
    f.lowTouched = rectangle ? (kCellSlack - first.high.x) * inverse : -1e6f;
    f.highTouched = rectangle ? (g.extent.x - kCellSlack - first.low.x) * inverse : 1e6f;
    f.lowWhole = rectangle ? (-kCellSlack - first.low.x) * inverse : -1e6f;
    f.highWhole = rectangle ? (g.extent.x + kCellSlack - first.high.x) * inverse : 1e6f;
    f.lowOffset = -first.low.x * inverse;
    f.highOffset = -first.high.x * inverse;
    f.low = first.low.y;
    f.high = first.high.y;
    f.top = g.extent.y;
    f.step = g.step.y;
    f.columns = g.cells & 0xFFFFu;
    f.bond = (g.mesh & kGridBond) != 0u;
    f.rectangle = rectangle;
    return f;
}

struct RowPlanes {
    RowPlane v[kPartPlanes];
};
// part: the number among its region's; a grid without a region has one, which nothing bounds.
FN RowPlanes planesOf(RoofEnv env, RoofGrid g, uint part, CellBox first, float inverse) {
    RowPlanes planes = {};
    for (uint k = 0u; k < kPartPlanes; ++k) planes.v[k] = openPlane();
    if (g.region == kNoIndex) return planes;
    CellSpace space = spaceOf(env, g);
    part = env.regions.v[g.region].firstPart + part;
    uint firstPlane = env.parts.v[part].firstPlane;
    uint count = env.parts.v[part].counts & 255u;
    for (uint k = 0u; k < kPartPlanes; ++k)
        if (k < count) planes.v[k] = rowPlane(cellPlane(space, env.planes.v[firstPlane + k]), first, g.step.y, inverse);
    return planes;
}

// What the part leaves of a row.
FN RoofRun rowRun(IN(RowPlanes) planes, RowFrame f, uint row) {
    float y = float(row);
    bool odd = f.bond && (row & 1u) != 0u;
    float shift = odd ? 0.5f : 0.0f;   // in cells
    float cells = float(f.columns) + (odd ? 1.0f : 0.0f);
    float t0 = f.lowTouched;
    float t1 = f.highTouched;
    float w0 = f.lowWhole;
    float w1 = f.highWhole;
    for (uint k = 0u; k < kPartPlanes; ++k) {
        float fallen = y * planes.v[k].down;
        bool upper = planes.v[k].upper;
        float t = (planes.v[k].touched - fallen) * planes.v[k].scale + (upper ? f.lowOffset : f.highOffset);
        float w = (planes.v[k].whole - fallen) * planes.v[k].scale + (upper ? f.highOffset : f.lowOffset);
        t1 = upper && t < t1 ? t : t1;
        w1 = upper && w < w1 ? w : w1;
        t0 = !upper && t > t0 ? t : t0;
        w0 = !upper && w > w0 ? w : w0;
    }
    if (f.rectangle && f.high + y * f.step > f.top + kCellSlack) w1 = -1e6f;
    if (f.rectangle && f.low + y * f.step > f.top - kCellSlack) t1 = -1e6f;
    t0 = -floorExact(limited(-(t0 + shift), -1e6f, 1e6f));
    t1 = floorExact(limited(t1 + shift, -1e6f, 1e6f));
    w0 = larger(t0, -floorExact(limited(-(w0 + shift), -1e6f, 1e6f)));
    w1 = smaller(t1, floorExact(limited(w1 + shift, -1e6f, 1e6f)));
    RoofRun run = {};
    run.touched = packRun(t0, t1, cells);
    run.whole = packRun(w0, w1, cells);
    return run;
}

// The runs of a grid's rows, as far as one part of its region tells, joined to what those before it have told. Returns
// the cells that all of them touch, and those that are whole.
FN uvec2 partRuns(RoofEnv env, uint grid, uint part) {
    RoofGrid g = readRoofGrid(env.grids, grid);
    CellBox first = cellBox(g, env.meshes.v[g.mesh & 255u], 0u, 0u);
    float inverse = rcpExact(g.step.x);
    RowPlanes planes = planesOf(env, g, part, first, inverse);
    RowFrame frame = rowFrame(g, first, inverse);
    uvec2 sums = uvec2(0u, 0u);
    for (uint row = 0u; row < g.cells >> 16u; ++row) {
        RoofRun run = rowRun(planes, frame, row);
        if (part != 0u) run = joinedRuns(env.runs.v[g.firstRow + row], run);
        writeRoofRun(env.runs, g.firstRow + row, run);
        sums = sums + uvec2(runCount(run.touched), runCount(run.whole));
    }
    return sums;
}

// What grids come to, to be added to the status at a lane's end: each atomic costs.
struct RoofTally {
    uint touched, whole, terminals;
    uvec2 hash;
};

FN RoofTally emptyTally() {
    RoofTally t = {};
    t.touched = 0u;
    t.whole = 0u;
    t.terminals = 0u;
    t.hash = uvec2(0u, 0u);
    return t;
}
// At a kernel's end, which all lanes reach.
LANES_FN void addTally(LANES_PARAM RoofEnv env, RoofTally t) {
    uint touched = OF_LANES(sumOfLanes(t.touched));
    uint whole = OF_LANES(sumOfLanes(t.whole));
    uint terminals = OF_LANES(sumOfLanes(t.terminals));
    uint low = OF_LANES(sumOfLanes(t.hash.x));
    uint high = OF_LANES(sumOfLanes(t.hash.y));
    if (!OF_LANES(isFirstLane())) return;
    roofAdd(env.status.v[0].touched, touched);
    roofAdd(env.status.v[0].whole, whole);
    roofAdd(env.status.v[0].terminals, terminals);
    roofAdd(env.status.v[0].hash[0], low);
    roofAdd(env.status.v[0].hash[1], high);
}

FN uint quantised(float x) { return uint(int(floorExact(limited(x * 128.0f, -2e9f, 2e9f)))); }

// The same whichever house grew with it, and wherever its records lie.
FN u64 hashOfGrid(RoofGrid g, vec2 plot) {
    u64 hash = mix64(g.key + mix64((u64(g.cells) << 32) | u64(g.mesh)));
    hash = mix64(hash + ((u64(quantised(g.origin.x) + quantised(plot.x)) << 32) | u64(quantised(g.origin.z) + quantised(plot.y))));
    return mix64(hash + ((u64(quantised(g.origin.y)) << 32) | u64(quantised(g.size.x * 16.0f))));
}

FN void finishGrid(RoofEnv env, uint grid, INOUT(RoofTally) tally) {
    RoofGrid g = readRoofGrid(env.grids, grid);
    u64 hash = hashOfGrid(g, plotOf(env, g.house));
    tally.hash = tally.hash + uvec2(uint(hash), uint(hash >> 32));
    uvec2 cells = uvec2(1u, 1u);
    if (g.firstRow == kNoIndex) {
        tally.terminals += 1u;
    } else {
        uint parts = g.region != kNoIndex ? env.regions.v[g.region].partCount : 1u;
        for (uint part = 0u; part < parts; ++part) cells = partRuns(env, grid, part);
    }
    tally.touched += cells.x;
    tally.whole += cells.y;
}

// How many grids there are to finish. Where grids or rows found no room, what lies there isn't known, and there are none.
FN uint gridsToFinish(RoofEnv env) {
    uint grids = env.status.v[0].grids;
    return grids <= env.gridRoom && env.status.v[0].rows <= env.rowRoom ? grids - env.status.v[0].firstGrid : 0u;
}
// Of these, every `stride`th from number `first` on, up to `end`.
LANES_FN void finishGrids(LANES_PARAM RoofEnv env, uint first, uint end, uint stride) {
    RoofTally tally = emptyTally();
    for (uint i = first; i < end; i += stride) finishGrid(env, env.status.v[0].firstGrid + i, tally);
    addTally(THESE_LANES env, tally);
}

ESPALIER_END
#endif
