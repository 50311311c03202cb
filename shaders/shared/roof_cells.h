// Which cells of a grid its region touches, and which lie whole within it (Buron 2013 §3.3): runs of a row for what can
// be told by intervals, part by part for the few cells that an outline crosses.
#ifndef ESPALIER_SHARED_ROOF_CELLS_H
#define ESPALIER_SHARED_ROOF_CELLS_H
#include "shaders/shared/roof_layers.h"
#include "shaders/shared/roof_lookup.h"

ESPALIER_BEGIN

CONST_FLOAT(kCellSlack, 1e-3f);   // metres by which a cell may cross a border and count as whole

// A half-space in a grid's own coordinates: x fx + y fy + z fz <= limit.
struct CellPlane {
    float fx, fy, fz, limit;
};

FN CellPlane cellPlane(RoofGrid g, RoofRegion r, vec4 plane) {
    vec3 n = r.axisA * plane.x + r.axisB * plane.y + r.axisC * plane.z;
    n.y = n.y * g.shrink;
    vec3 o = g.origin - vec3(r.origin.x, g.base, r.origin.z);
    CellPlane p = {};
    p.fx = dot3(n, g.axisX);
    p.fy = dot3(n, g.axisY);
    p.fz = dot3(n, cross3(g.axisX, g.axisY));
    p.limit = plane.w - dot3(n, o);
    return p;
}

// Bounds of the mesh of cell (column, row) in the grid's coordinates. z in metres.
struct CellBox {
    vec3 low, high;
};
FN CellBox cellBox(RoofGrid g, RoofMesh mesh, uint column, uint row) {
    float shift = (g.mesh & kGridBond) != 0u && (row & 1u) != 0u ? -0.5f : 0.0f;
    vec2 at = vec2((float(column) + shift) * g.step.x, float(row) * g.step.y);
    CellBox b = {};
    b.low = vec3(at.x + mesh.low.x * g.size.x, at.y + mesh.low.y * g.size.y, mesh.low.z * g.thickness);
    b.high = vec3(at.x + mesh.high.x * g.size.x, at.y + mesh.high.y * g.size.y, mesh.high.z * g.thickness);
    return b;
}

// Least and greatest of the plane's left side over the box, minus its limit: above 0 is outside.
FN vec2 boxAgainst(CellPlane p, CellBox b) {
    float l = -p.limit;
    float h = -p.limit;
    l += smaller(p.fx * b.low.x, p.fx * b.high.x) + smaller(p.fy * b.low.y, p.fy * b.high.y) + smaller(p.fz * b.low.z, p.fz * b.high.z);
    h += larger(p.fx * b.low.x, p.fx * b.high.x) + larger(p.fy * b.low.y, p.fy * b.high.y) + larger(p.fz * b.low.z, p.fz * b.high.z);
    return vec2(l, h);
}

FN uint packRun(float first, float last, float cells) {
    first = limited(first, 0.0f, cells);
    last = limited(last, -1.0f, cells - 1.0f);
    return last < first ? 0u : uint(first) | (uint(last - first + 1.0f) << 16u);
}
FN uint runFirst(uint run) { return run & 0xFFFFu; }
FN uint runCount(uint run) { return run >> 16u; }

// What a half-space leaves of each row: it bounds the columns whose boxes reach into it (touched) or lie within it
// (whole), from above or from below, by (room - row * down) * scale + offset.
struct RowPlane {
    float touched, whole;   // room in row 0
    float down, scale;
    float touchedOffset, wholeOffset;
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
    r.touchedOffset = -(r.upper ? first.low.x : first.high.x) * inverse;
    r.wholeOffset = -(r.upper ? first.high.x : first.low.x) * inverse;
    return r;
}
// No half-space at all.
FN RowPlane openPlane() {
    RowPlane r = {};
    r.touched = 1.0f;
    r.whole = 1.0f;
    r.down = 0.0f;
    r.scale = 1e9f;
    r.touchedOffset = 0.0f;
    r.wholeOffset = 0.0f;
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

// All rows of a grid that has any, part by part of its region, each plane worked out once. Returns the cells that the
// region touches, and those of them that are whole.
FN uvec2 gridRuns(RoofEnv env, RoofGrid g) {
    uvec2 sums = uvec2(0u, 0u);
    CellBox first = cellBox(g, env.meshes.v[g.mesh & 255u], 0u, 0u);
    float inverse = rcpExact(g.step.x);
    uint rows = g.cells >> 16u;
    bool bond = (g.mesh & kGridBond) != 0u;
    bool rectangle = (g.mesh & kGridRect) != 0u;
    // Bounds that the grid's own rectangle gives.
    float lowTouched = rectangle ? (kCellSlack - first.high.x) * inverse : -1e6f;
    float highTouched = rectangle ? (g.extent.x - kCellSlack - first.low.x) * inverse : 1e6f;
    float lowWhole = rectangle ? (-kCellSlack - first.low.x) * inverse : -1e6f;
    float highWhole = rectangle ? (g.extent.x + kCellSlack - first.high.x) * inverse : 1e6f;
    RoofRegion r = readRegion(env, g.region != kNoIndex ? g.region : 0u);   // there is room for one in any town
    uint parts = g.region != kNoIndex ? r.partCount : 1u;
    for (uint i = 0u; i < parts; ++i) {
        RowPlane planes[kPartPlanes];
        uint firstPlane = 0u;
        uint count = 0u;
        if (g.region != kNoIndex) {
            RoofPart part = readPart(env, r.firstPart + i);
            firstPlane = part.firstPlane;
            count = part.counts & 255u;
        }
        for (uint k = 0u; k < kPartPlanes; ++k) {
            planes[k] = openPlane();
            if (k < count) planes[k] = rowPlane(cellPlane(g, r, readPlane(env, firstPlane + k)), first, g.step.y, inverse);
        }
        for (uint row = 0u; row < rows; ++row) {
            float y = float(row);
            bool odd = bond && (row & 1u) != 0u;
            float shift = odd ? 0.5f : 0.0f;   // in cells
            float cells = float(g.cells & 0xFFFFu) + (odd ? 1.0f : 0.0f);
            float t0 = lowTouched;
            float t1 = highTouched;
            float w0 = lowWhole;
            float w1 = highWhole;
            for (uint k = 0u; k < kPartPlanes; ++k) {
                float fallen = y * planes[k].down;
                float t = (planes[k].touched - fallen) * planes[k].scale + planes[k].touchedOffset;
                float w = (planes[k].whole - fallen) * planes[k].scale + planes[k].wholeOffset;
                bool upper = planes[k].upper;
                t1 = upper && t < t1 ? t : t1;
                w1 = upper && w < w1 ? w : w1;
                t0 = !upper && t > t0 ? t : t0;
                w0 = !upper && w > w0 ? w : w0;
            }
            float low = first.low.y + y * g.step.y;
            float high = first.high.y + y * g.step.y;
            if (rectangle && high > g.extent.y + kCellSlack) w1 = -1e6f;
            if (rectangle && low > g.extent.y - kCellSlack) t1 = -1e6f;
            t0 = -floorExact(limited(-(t0 + shift), -1e6f, 1e6f));
            t1 = floorExact(limited(t1 + shift, -1e6f, 1e6f));
            w0 = larger(t0, -floorExact(limited(-(w0 + shift), -1e6f, 1e6f)));
            w1 = smaller(t1, floorExact(limited(w1 + shift, -1e6f, 1e6f)));
            RoofRun run = {};
            run.touched = packRun(t0, t1, cells);
            run.whole = packRun(w0, w1, cells);
            if (i != 0u) run = joinedRuns(env.runs.v[g.firstRow + row], run);
            writeRoofRun(env.runs, g.firstRow + row, run);
            if (i + 1u == parts) sums = sums + uvec2(runCount(run.touched), runCount(run.whole));
        }
    }
    return sums;
}

// What a cell has to be cut by in one part: `planes` bits of the part's planes that cross its box, or all bits if the
// part doesn't reach it.
CONST_UINT(kPartMissed, 0xFFFFFFFFu);
FN uint partCuts(RoofEnv env, RoofGrid g, RoofRegion r, RoofPart part, CellBox box) {
    uint cuts = 0u;
    for (uint k = 0u; k < (part.counts & 255u); ++k) {
        vec2 d = boxAgainst(cellPlane(g, r, env.planes.v[part.firstPlane + k]), box);
        if (d.x > -kCellSlack) return kPartMissed;
        if (d.y > kCellSlack) cuts |= 1u << k;
    }
    return cuts;
}

ESPALIER_END
#endif
