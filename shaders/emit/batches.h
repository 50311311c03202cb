// A bucket's instances as draws: full batches in one command, the rest in another, so that small meshes aren't drawn one
// by one.
#ifndef ESPALIER_EMIT_BATCHES_H
#define ESPALIER_EMIT_BATCHES_H
#include "shaders/emit/emit_records.h"

ESPALIER_BEGIN

FN void drawBatches(BucketRecord bucket, uint count, OUT(DrawCommand) whole, OUT(DrawCommand) last) {
    uint batch = bucket.batch > 0u ? bucket.batch : 1u;
    uint rest = count % batch;
    whole.indexCount = bucket.indexCount * batch;
    whole.instanceCount = count / batch;
    whole.vertexOffset = 0;
    last.indexCount = bucket.indexCount * rest;
    last.instanceCount = rest > 0u ? 1u : 0u;
    last.vertexOffset = int((count - rest) * bucket.vertexCount);
    whole.firstIndex = last.firstIndex = bucket.firstIndex;
    whole.firstInstance = last.firstInstance = 0u;
}

ESPALIER_END
#endif
