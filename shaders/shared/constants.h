// Numbers of the specialization constants: one numbering for all programs, on both sides.
#ifndef ESPALIER_SHARED_CONSTANTS_H
#define ESPALIER_SHARED_CONSTANTS_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

CONST_UINT(kConstantTablesByAddress, 0u);   // tables of rules are read by address, else from a uniform buffer
CONST_UINT(kConstantFeatures, 1u);          // kFeature…: what plants' grammars use
CONST_UINT(kConstantRoofUses, 2u);          // the same of roofs' grammars
CONST_UINT(kConstantCorners, 3u);           // vertices of leaves that are lit ahead: 3 or 4
CONST_UINT(kConstantMoved, 4u);             // 0: nodes and leaves have the numbers that they had
CONST_UINT(kConstantLanes, 5u);             // that share a cell or a block
CONST_UINT(kConstantExplains, 6u);          // another view than the shaded one is drawn
CONST_UINT(kConstantRooted, 7u);            // textures hold square roots of colours
CONST_UINT(kConstantQuick, 8u);             // a picture of what moves, which has to be cheap
CONST_UINT(kConstantRest, 9u);              // the meadow on the feet of models, and hills before the sky, are drawn, too
CONST_UINT(kConstantOutput, 10u);           // kOutput…: what a pass holds
CONST_UINT(kConstantWindy, 11u);            // leaves bend in the wind

// What fragments write. Stored: as tone.glsl says, to be resolved later. The others are for hosts' own passes:
// tone-mapped, encoded to sRGB or not; light times exposure, which the host maps.
CONST_UINT(kOutputStored, 0u);
CONST_UINT(kOutputEncoded, 1u);
CONST_UINT(kOutputLinear, 2u);
CONST_UINT(kOutputLight, 3u);

ESPALIER_END
#endif
