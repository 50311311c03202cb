#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Items go to their bins; where those began becomes where they end.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

void main() {
    uint lanes = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint items = itemsToPut();
    for (uint i = gl_GlobalInvocationID.x; i < items; i += lanes) {
        uint item = itemToPut(i);
        uint key = push.keys.v[item];
        if (key != kNoIndex) {
            uint bin = key & ~kFresh;
            push.keys.v[item] = bin;
            uint cell = bin / kCellBins;
            if (push.cells.v[cell].count > 0u) {
                uint at = atomicAdd(push.bins.v[bin], 1u);
                push.order.v[push.cells.v[cell].first + at] = item;
            }
        }
    }
}
