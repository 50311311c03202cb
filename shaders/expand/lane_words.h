// Where what a lane of the march keeps lies in its memory: words, each part from a fourth one on.
#ifndef ESPALIER_EXPAND_LANE_WORDS_H
#define ESPALIER_EXPAND_LANE_WORDS_H
#include "records/expand_scope.h"
#include "records/grower.h"
#include "records/walk_state.h"

ESPALIER_BEGIN

CONST_UINT(kLaneShape, 0u);
CONST_UINT(kLaneRule, kLaneShape + (kPendingShape_words + 3u) / 4u * 4u);
CONST_UINT(kLaneStep, kLaneRule + (kActiveRule_words + 3u) / 4u * 4u);
CONST_UINT(kLaneProgress, kLaneStep + (kStepState_words + 3u) / 4u * 4u);
CONST_UINT(kLaneReads, kLaneProgress + (kChunkProgress_words + 3u) / 4u * 4u);
CONST_UINT(kLaneSite, kLaneReads + (kReadSet_words + 3u) / 4u * 4u);
CONST_UINT(kLaneItem, kLaneSite + kGrowthSite_words);   // which item of the wave it grows
CONST_UINT(kLaneRemaining, kLaneItem + 1u);             // Grower::remaining
CONST_UINT(kLaneTaken, kLaneRemaining + 1u);           // items that it has asked for
CONST_UINT(kLaneStand, (kLaneTaken + 4u) / 4u * 4u);
CONST_UINT(kLaneTrial, kLaneStand + (kWalkState_words + 3u) / 4u * 4u);
CONST_UINT(kLaneTally, kLaneTrial + (kWalkState_words + 3u) / 4u * 4u);   // of all chunks that it has grown
CONST_UINT(kLaneEnd, kLaneTally + (kGrowthTally_words + 3u) / 4u * 4u);   // where kLaneSlots and kLaneStage follow
#ifdef __cplusplus
static_assert(kLaneEnd == kLaneSlots);
// As large as every device binds a storage buffer.
static_assert(uint64_t(kLaneGroups) * kExpandGroup * kLaneWords * 4 <= uint64_t(1) << 27);
#endif

ESPALIER_END
#endif
