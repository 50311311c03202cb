// Waves of a growth: shapes that wait, plants' and roofs' alike.
#ifndef ESPALIER_SHARED_WAVES_H
#define ESPALIER_SHARED_WAVES_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

// How many shapes wait, and the indirect arguments that grow as they are queued. The rest is for plants.
struct Wave {
    uint count;
    uint groups[3];
    uint nodes, chunks;      // what it grew
    uint taken;              // items that invocations have asked for
    uint announced;          // items that ended chunks have pushed
};
STATIC_SIZE(Wave, 32);
BUFFER(WaveBuf, Wave)

ESPALIER_END
#endif
