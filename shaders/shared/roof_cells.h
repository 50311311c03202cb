// Which cells of a grid its region touches, and which lie whole within it (Buron 2013 §3.3): runs of a row for what can
// be told by intervals, part by part for the few cells that an outline crosses.
#ifndef ESPALIER_SHARED_ROOF_CELLS_H
#define ESPALIER_SHARED_ROOF_CELLS_H
#include "shaders/shared/exact.h"
#include "shaders/shared/roof_records.h"

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
    CellPlane p;
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
    CellBox b;
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

// The columns [first, last] of a row whose boxes satisfy a condition on x: low end * sign... kept as floats, since they
// may lie far outside.
struct Columns {
    float first, last;
};
FN Columns meet(Columns a, Columns b) {
    Columns c;
    c.first = larger(a.first, b.first);
    c.last = smaller(a.last, b.last);
    return c;
}
FN Columns everyColumn() {
    Columns c;
    c.first = -1e6f;
    c.last = 1e6f;
    return c;
}

// A row's measures: column k's box reaches from left + k step to right + k step.
struct RowFrame {
    float left, right, inverse;
    vec2 y, z;
};

// Columns whose boxes lie within the plane (whole) or reach into it.
FN Columns columnsWithin(CellPlane p, RowFrame f, bool whole) {
    float a = p.fy * f.y.x;
    float b = p.fy * f.y.y;
    float c = p.fz * f.z.x;
    float d = p.fz * f.z.y;
    float m = whole ? larger(a, b) + larger(c, d) : smaller(a, b) + smaller(c, d);
    float room = p.limit - m + (whole ? kCellSlack : -kCellSlack);
    Columns all = everyColumn();
    if (absolute(p.fx) < 1e-6f) {
        if (room < 0.0f) all.last = -2e6f;
        return all;
    }
    float x = divExact(room, p.fx);
    if (p.fx > 0.0f)
        all.last = floorExact(limited((x - (whole ? f.right : f.left)) * f.inverse, -1e6f, 1e6f));
    else
        all.first = -floorExact(limited(((whole ? f.left : f.right) - x) * f.inverse, -1e6f, 1e6f));
    return all;
}

FN uint packRun(Columns c, float cells) {
    float first = limited(c.first, 0.0f, cells);
    float last = limited(c.last, -1.0f, cells - 1.0f);
    return last < first ? 0u : uint(first) | (uint(last - first + 1.0f) << 16u);
}
FN uint runFirst(uint run) { return run & 0xFFFFu; }
FN uint runCount(uint run) { return run >> 16u; }

FN RoofRun rowRun(RoofEnv env, RoofGrid g, RoofMesh mesh, uint row) {
    bool odd = (g.mesh & kGridBond) != 0u && (row & 1u) != 0u;
    float cells = float(g.cells & 0xFFFFu) + (odd ? 1.0f : 0.0f);
    CellBox first = cellBox(g, mesh, 0u, row);
    RowFrame f;
    f.left = first.low.x;
    f.right = first.high.x;
    f.inverse = rcpExact(g.step.x);
    f.y = vec2(first.low.y, first.high.y);
    f.z = vec2(first.low.z, first.high.z);
    Columns touched = everyColumn();
    Columns whole = everyColumn();
    if (g.region != kNoIndex) {
        RoofRegion r = env.regions.v[g.region];
        touched.first = 2e6f;
        touched.last = -2e6f;
        whole = touched;
        for (uint i = 0u; i < r.partCount; ++i) {
            RoofPart part = env.parts.v[r.firstPart + i];
            Columns t = everyColumn();
            Columns w = everyColumn();
            for (uint k = 0u; k < (part.counts & 255u); ++k) {
                CellPlane p = cellPlane(g, r, env.planes.v[part.firstPlane + k]);
                t = meet(t, columnsWithin(p, f, false));
                w = meet(w, columnsWithin(p, f, true));
            }
            if (t.last >= t.first) {
                touched.first = smaller(touched.first, t.first);
                touched.last = larger(touched.last, t.last);
            }
            if (w.last - w.first > whole.last - whole.first) whole = w;
        }
    }
    if ((g.mesh & kGridRect) != 0u) {
        CellPlane side;
        side.fy = 0.0f;
        side.fz = 0.0f;
        side.fx = -1.0f;
        side.limit = 0.0f;
        touched = meet(touched, columnsWithin(side, f, false));
        whole = meet(whole, columnsWithin(side, f, true));
        side.fx = 1.0f;
        side.limit = g.extent.x;
        touched = meet(touched, columnsWithin(side, f, false));
        whole = meet(whole, columnsWithin(side, f, true));
        if (f.y.y > g.extent.y + kCellSlack) whole.last = -2e6f;
        if (f.y.x > g.extent.y - kCellSlack) touched.last = -2e6f;
    }
    RoofRun run;
    run.touched = packRun(touched, cells);
    run.whole = packRun(meet(whole, touched), cells);
    return run;
}

// All rows of a grid. Returns the cells that its region touches, and those of them that are whole.
FN uvec2 gridRuns(RoofEnv env, uint at) {
    RoofGrid g = env.grids.v[at];
    uvec2 sums = uvec2(0u, 0u);
    if (g.firstRow == kNoIndex) return uvec2(1u, 1u);
    RoofMesh mesh = env.meshes.v[g.mesh & 255u];
    uint rows = g.cells >> 16u;
    for (uint row = 0u; row < rows; ++row) {
        RoofRun run = rowRun(env, g, mesh, row);
        env.runs.v[g.firstRow + row] = run;
        sums = sums + uvec2(runCount(run.touched), runCount(run.whole));
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
