#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Items go to their bins; where those began becomes where they end.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

void main() {
    uint item = itemIndex();
    uint bin = item < push.nodeCount + push.leafCount ? push.keys.v[item] : kNoIndex;
    for (bool put = bin != kNoIndex; put; put = false) {
        uint at = atomicAdd(push.bins.v[bin], 1u);
        push.order.v[push.cells.v[bin / kCellBins].first + at] = item;
    }
}
