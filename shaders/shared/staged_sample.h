// A sample of a walk as a chunk stages it (expand_stage.h).
#ifndef ESPALIER_SHARED_STAGED_SAMPLE_H
#define ESPALIER_SHARED_STAGED_SAMPLE_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

struct StagedSample {
    vec3 position;
    uint normal, heading;      // packOct
    uint uv, place;            // packUv; as Walk::place
    float arc;
    uint flags;                // as Node::flags
    uint nearUv, nearPlace;    // on the near side of a seam that the walk has come over; else uv and place
};
RECORD_WORDS(StagedSample)
RECORD_OFFSETS(StagedSample)

ESPALIER_END
#endif
