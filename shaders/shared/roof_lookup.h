// Reads and writes of roofs' records by the kernels that expand them.
//
// Kernels that define ESPALIER_ROOF_FETCH read as texels of 16 bytes what they define …_TEXEL for: on software devices a
// read by address is a loop over lanes for each word, a texel comes in one piece. Specialised to kRecordsByAddress they
// read as others do. Writes go by pairs of words.
#ifndef ESPALIER_SHARED_ROOF_LOOKUP_H
#define ESPALIER_SHARED_ROOF_LOOKUP_H
#include "shaders/shared/pairs.h"
#include "shaders/shared/roof_records.h"

ESPALIER_BEGIN

// What a rule that goes along an outline asks of a piece first.
struct PieceBrief {
    uint kind, upper;
};

#ifdef __cplusplus
inline RoofAtom readAtom(RoofEnv env, uint at) { return env.atoms.v[at]; }
inline RoofRegion readRegion(RoofEnv env, uint at) { return env.regions.v[at]; }
inline RoofPiece readPiece(RoofEnv env, uint at) { return env.pieces.v[at]; }
inline PieceBrief readPieceBrief(RoofEnv env, uint at) { return {env.pieces.v[at].kind, env.pieces.v[at].upper}; }
inline RoofScope readScope(RoofEnv env, uint at) { return env.shapes.v[at]; }
inline RoofPart readPart(RoofEnv env, uint at) { return env.parts.v[at]; }
inline vec4 readPlane(RoofEnv env, uint at) { return env.planes.v[at]; }
inline void writeScope(RoofEnv env, uint at, const RoofScope& scope) { env.next.v[at] = scope; }
inline void writeGridRecord(RoofEnv env, uint at, const RoofGrid& grid) { env.grids.v[at] = grid; }
inline void writeRun(RoofEnv env, uint at, RoofRun run) { env.runs.v[at] = run; }
#else
#ifndef ESPALIER_ROOF_FETCH
const uint kRecordsByAddress = 1u;
#endif
#ifndef ATOM_TEXEL
#define ATOM_TEXEL(i) uvec4(0u)
#define PIECE_TEXEL(i) uvec4(0u)
#define SHAPE_TEXEL(i) uvec4(0u)
#endif
#ifndef PART_TEXEL
#define PART_TEXEL(i) uvec4(0u)
#define PLANE_TEXEL(i) uvec4(0u)
#endif
#ifndef REGION_TEXEL
#define REGION_TEXEL(i) uvec4(0u)
#endif

RoofAtom readAtom(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.atoms.v[at];
    uint i = 8u * at;
    uvec4 a = ATOM_TEXEL(i);
    vec4 b = uintBitsToFloat(ATOM_TEXEL(i + 1u));
    vec4 c = uintBitsToFloat(ATOM_TEXEL(i + 2u));
    vec4 d = uintBitsToFloat(ATOM_TEXEL(i + 3u));
    uvec4 e = ATOM_TEXEL(i + 4u);
    uvec4 f = ATOM_TEXEL(i + 5u);
    uvec4 g = ATOM_TEXEL(i + 6u);
    vec4 h = uintBitsToFloat(ATOM_TEXEL(i + 7u));
    RoofAtom r;
    r.key = packUint2x32(a.xy);
    r.foot = vec3(uintBitsToFloat(a.zw), b.x);
    r.tangent = b.yzw;
    r.eaveLength = c.x;
    r.wallHeight = c.y;
    r.slope = c.z;
    r.height = c.w;
    r.target1 = d.xyz;
    r.target2 = vec3(d.w, uintBitsToFloat(e.xy));
    r.region = e.z;
    r.firstPiece = e.w;
    r.pieceCount = f.x;
    r.house = f.y;
    r.kind = f.z;
    r.tier = f.w;
    r.style = g.x;
    r.random = uintBitsToFloat(g.y);
    r.colour = vec3(uintBitsToFloat(g.zw), h.x);
    r.corners = h.yz;
    r.overhang = h.w;
    return r;
}
RoofRegion readRegion(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.regions.v[at];
    uint i = 5u * at;
    vec4 a = uintBitsToFloat(REGION_TEXEL(i));
    vec4 b = uintBitsToFloat(REGION_TEXEL(i + 1u));
    vec4 c = uintBitsToFloat(REGION_TEXEL(i + 2u));
    vec4 d = uintBitsToFloat(REGION_TEXEL(i + 3u));
    uvec4 e = REGION_TEXEL(i + 4u);
    RoofRegion r;
    r.origin = a.xyz;
    r.axisA = vec3(a.w, b.xy);
    r.axisB = vec3(b.zw, c.x);
    r.axisC = c.yzw;
    r.low = d.xy;
    r.high = d.zw;
    r.firstPart = e.x;
    r.partCount = e.y;
    return r;
}
RoofPiece readPiece(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.pieces.v[at];
    uint i = 4u * at;
    vec4 a = uintBitsToFloat(PIECE_TEXEL(i));
    vec4 b = uintBitsToFloat(PIECE_TEXEL(i + 1u));
    uvec4 c = PIECE_TEXEL(i + 2u);
    RoofPiece p;
    p.from = a.xyz;
    p.to = vec3(a.w, b.xy);
    p.normal = vec3(b.zw, uintBitsToFloat(c.x));
    p.kind = c.y;
    p.upper = c.z;
    p.owner = c.w;
    p.fold = uintBitsToFloat(PIECE_TEXEL(i + 3u).x);
    return p;
}
PieceBrief readPieceBrief(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return PieceBrief(env.pieces.v[at].kind, env.pieces.v[at].upper);
    return PieceBrief(PIECE_TEXEL(4u * at + 2u).y, PIECE_TEXEL(4u * at + 2u).z);
}
RoofScope readScope(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.shapes.v[at];
    uint i = 9u * at;
    uvec4 a = SHAPE_TEXEL(i);
    vec4 b = uintBitsToFloat(SHAPE_TEXEL(i + 1u));
    vec4 c = uintBitsToFloat(SHAPE_TEXEL(i + 2u));
    vec4 d = uintBitsToFloat(SHAPE_TEXEL(i + 3u));
    uvec4 e = SHAPE_TEXEL(i + 4u);
    uvec4 f = SHAPE_TEXEL(i + 5u);
    uvec4 g = SHAPE_TEXEL(i + 6u);
    uvec4 h = SHAPE_TEXEL(i + 7u);
    vec4 j = uintBitsToFloat(SHAPE_TEXEL(i + 8u));
    RoofScope s;
    s.key = packUint2x32(a.xy);
    s.origin = vec3(uintBitsToFloat(a.zw), b.x);
    s.axisX = b.yzw;
    s.axisY = c.xyz;
    s.size = vec2(c.w, d.x);
    s.taper = d.yz;
    s.step = vec2(d.w, uintBitsToFloat(e.x));
    s.extent = uintBitsToFloat(e.yz);
    s.cells = e.w;
    s.thickness = uintBitsToFloat(f.x);
    s.colour = f.y;
    s.projectHeight = uintBitsToFloat(f.z);
    s.base = uintBitsToFloat(f.w);
    s.stretch = uintBitsToFloat(g.x);
    s.region = g.y;
    s.atom = g.z;
    s.symbol = g.w;
    s.place = h.x;
    s.marks = h.y;
    s.layers = h.z;
    s.args[0] = uintBitsToFloat(h.w);
    s.args[1] = j.x;
    s.args[2] = j.y;
    s.args[3] = j.z;
    return s;
}
RoofPart readPart(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.parts.v[at];
    uvec4 t = PART_TEXEL(at);
    return RoofPart(uintBitsToFloat(t.x), uintBitsToFloat(t.y), t.z, t.w);
}
vec4 readPlane(RoofEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.planes.v[at];
    return uintBitsToFloat(PLANE_TEXEL(at));
}

void writeScope(RoofEnv env, uint at, RoofScope s) {
    PairBuf to = PairBuf(uint64_t(env.next) + uint64_t(at) * 144u);
    to.v[0] = s.key;
    to.v[1] = pairOf(s.origin.xy);
    to.v[2] = pairOf(s.origin.z, s.axisX.x);
    to.v[3] = pairOf(s.axisX.yz);
    to.v[4] = pairOf(s.axisY.xy);
    to.v[5] = pairOf(s.axisY.z, s.size.x);
    to.v[6] = pairOf(s.size.y, s.taper.x);
    to.v[7] = pairOf(s.taper.y, s.step.x);
    to.v[8] = pairOf(s.step.y, s.extent.x);
    to.v[9] = pairOf(s.extent.y, s.cells);
    to.v[10] = pairOf(s.thickness, s.colour);
    to.v[11] = pairOf(s.projectHeight, s.base);
    to.v[12] = pairOf(s.stretch, s.region);
    to.v[13] = pairOf(s.atom, s.symbol);
    to.v[14] = pairOf(s.place, s.marks);
    to.v[15] = pairOf(s.layers, floatBitsToUint(s.args[0]));
    to.v[16] = pairOf(s.args[1], s.args[2]);
    to.v[17] = pairOf(s.args[3], 0.0);
}
void writeGridRecord(RoofEnv env, uint at, RoofGrid g) {
    PairBuf to = PairBuf(uint64_t(env.grids) + uint64_t(at) * 128u);
    to.v[0] = g.key;
    to.v[1] = pairOf(g.origin.xy);
    to.v[2] = pairOf(g.origin.z, g.axisX.x);
    to.v[3] = pairOf(g.axisX.yz);
    to.v[4] = pairOf(g.axisY.xy);
    to.v[5] = pairOf(g.axisY.z, g.size.x);
    to.v[6] = pairOf(g.size.y, g.step.x);
    to.v[7] = pairOf(g.step.y, g.extent.x);
    to.v[8] = pairOf(g.extent.y, g.taper.x);
    to.v[9] = pairOf(g.taper.y, g.cells);
    to.v[10] = pairOf(g.mesh, floatBitsToUint(g.thickness));
    to.v[11] = pairOf(g.colour, floatBitsToUint(g.base));
    to.v[12] = pairOf(g.shrink, g.region);
    to.v[13] = pairOf(g.atom, g.house);
    to.v[14] = pairOf(g.firstRow, 0u);
}
void writeRun(RoofEnv env, uint at, RoofRun run) {
    PairBuf to = PairBuf(uint64_t(env.runs) + uint64_t(at) * 8u);
    to.v[0] = pairOf(run.touched, run.whole);
}
#endif

ESPALIER_END
#endif
