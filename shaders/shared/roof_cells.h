// Cells of a grid against their region (Buron 2013 §3.3), part by part; roof_rows.h tells by intervals what a row's are.
#ifndef ESPALIER_SHARED_ROOF_CELLS_H
#define ESPALIER_SHARED_ROOF_CELLS_H
#include "shaders/shared/roof_layers.h"

ESPALIER_BEGIN

CONST_FLOAT(kCellSlack, 1e-3f);   // metres by which a cell may cross a border and count as whole

// A half-space in a grid's own coordinates: x fx + y fy + z fz <= limit.
struct CellPlane {
    float fx, fy, fz, limit;
};

// A region's axes in the grid's own coordinates, and the grid's origin along them.
struct CellSpace {
    vec3 a, b, c;
    vec3 origin;
};
FN CellSpace cellSpace(RoofGrid g, RoofRegion r) {
    vec3 a = vec3(r.axisA.x, r.axisA.y * g.shrink, r.axisA.z);
    vec3 b = vec3(r.axisB.x, r.axisB.y * g.shrink, r.axisB.z);
    vec3 c = vec3(r.axisC.x, r.axisC.y * g.shrink, r.axisC.z);
    vec3 z = cross3(g.axisX, g.axisY);
    vec3 o = g.origin - vec3(r.origin.x, g.base, r.origin.z);
    CellSpace s = {};
    s.a = vec3(dot3(a, g.axisX), dot3(a, g.axisY), dot3(a, z));
    s.b = vec3(dot3(b, g.axisX), dot3(b, g.axisY), dot3(b, z));
    s.c = vec3(dot3(c, g.axisX), dot3(c, g.axisY), dot3(c, z));
    s.origin = vec3(dot3(a, o), dot3(b, o), dot3(c, o));
    return s;
}
// Of the grid's region; any for a grid without one, since every town has room for one.
FN CellSpace spaceOf(RoofEnv env, RoofGrid g) { return cellSpace(g, env.regions.v[g.region != kNoIndex ? g.region : 0u]); }

FN CellPlane cellPlane(CellSpace s, vec4 plane) {
    vec3 n = s.a * plane.x + s.b * plane.y + s.c * plane.z;
    CellPlane p = {};
    p.fx = n.x;
    p.fy = n.y;
    p.fz = n.z;
    p.limit = plane.w - (s.origin.x * plane.x + s.origin.y * plane.y + s.origin.z * plane.z);
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

FN uint runFirst(uint run) { return run & 0xFFFFu; }
FN uint runCount(uint run) { return run >> 16u; }

// What a cell has to be cut by in one part: `planes` bits of the part's planes that cross its box, or all bits if the
// part doesn't reach it.
CONST_UINT(kPartMissed, 0xFFFFFFFFu);
FN uint partCuts(RoofEnv env, CellSpace space, RoofPart part, CellBox box) {
    uint cuts = 0u;
    for (uint k = 0u; k < (part.counts & 255u); ++k) {
        vec2 d = boxAgainst(cellPlane(space, env.planes.v[part.firstPlane + k]), box);
        if (d.x > -kCellSlack) return kPartMissed;
        if (d.y > kCellSlack) cuts |= 1u << k;
    }
    return cuts;
}

ESPALIER_END
#endif
