// How the memory of kernels' lanes is laid out; see lane_slots.glsl.
#ifndef ESPALIER_SHARED_LANES_H
#define ESPALIER_SHARED_LANES_H
#include "shaders/shared/rule_map.h"

ESPALIER_BEGIN

CONST_UINT(kLanesBeside, 8u);                               // lanes that have theirs side by side
CONST_UINT(kMostLanes, 57344u);                             // of a pass whose lanes have memory: as many as a large GPU holds
CONST_UINT(kSlotWords, (kMachineSlots + 3u) / 4u * 4u);     // of the machine's slots

ESPALIER_END
#endif
