// The meshes that terminals have by default (TerminalRecord::mesh), in the order of standardTerminalMeshes().
#ifndef ESPALIER_SHARED_TERMINAL_MESHES_H
#define ESPALIER_SHARED_TERMINAL_MESHES_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

CONST_UINT(kMeshBark, 0u);
CONST_UINT(kMeshLeaf, 1u);
CONST_UINT(kMeshPebble, 2u);
CONST_UINT(kMeshOval, 3u);
CONST_UINT(kMeshBlossom, 4u);
CONST_UINT(kMeshTuft, 5u);
// Kinds from kOwnMeshes on are looks of single grammars. Each stands, hangs and takes light as the shipped kind that its
// lowest three bits name: kind = look * kOwnMeshes + shipped kind.
CONST_UINT(kOwnMeshes, 8u);
FN uint shippedMesh(uint kind) { return kind & 7u; }

ESPALIER_END
#endif
