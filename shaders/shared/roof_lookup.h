// Reads of roofs' records by the kernels that expand them.
//
// Kernels that define ESPALIER_ROOF_FETCH read as texels of 16 bytes what they define …_TEXEL for: on software devices a
// read by address is a loop over lanes for each word, a texel comes in one piece. Specialised to kRecordsByAddress they
// read as others do.
#ifndef ESPALIER_SHARED_ROOF_LOOKUP_H
#define ESPALIER_SHARED_ROOF_LOOKUP_H
#include "records/roof_records.h"

ESPALIER_BEGIN

#ifdef __cplusplus
#define BY_ADDRESS(read, fetched) return read
#else
#ifndef ESPALIER_ROOF_FETCH
const uint kRecordsByAddress = 1u;
#endif
#ifndef ATOM_TEXEL
#define ATOM_TEXEL(view, i) uvec4(0u)
#define PIECE_TEXEL(view, i) uvec4(0u)
#define SHAPE_TEXEL(view, i) uvec4(0u)
#endif
#ifndef PART_TEXEL
#define PART_TEXEL(view, i) uvec4(0u)
#define PLANE_TEXEL(view, i) uvec4(0u)
#endif
#ifndef REGION_TEXEL
#define REGION_TEXEL(view, i) uvec4(0u)
#endif
#define BY_ADDRESS(read, fetched)            \
    if (kRecordsByAddress != 0u) return read; \
    return fetched
#endif

FN RoofAtom readAtom(RoofEnv env, uint at) { BY_ADDRESS(env.atoms.v[at], FETCH_RoofAtom(ATOM_TEXEL, atoms, at)); }
FN RoofRegion readRegion(RoofEnv env, uint at) {
    BY_ADDRESS(env.regions.v[at], FETCH_RoofRegion(REGION_TEXEL, regions, at));
}
FN RoofPiece readPiece(RoofEnv env, uint at) { BY_ADDRESS(env.pieces.v[at], FETCH_RoofPiece(PIECE_TEXEL, pieces, at)); }
FN RoofScope readScope(RoofEnv env, uint at) { BY_ADDRESS(env.shapes.v[at], FETCH_RoofScope(SHAPE_TEXEL, shapes, at)); }
FN RoofPart readPart(RoofEnv env, uint at) { BY_ADDRESS(env.parts.v[at], FETCH_RoofPart(PART_TEXEL, parts, at)); }
FN vec4 readPlane(RoofEnv env, uint at) { BY_ADDRESS(env.planes.v[at], uintBitsToFloat(PLANE_TEXEL(planes, at))); }

ESPALIER_END
#endif
