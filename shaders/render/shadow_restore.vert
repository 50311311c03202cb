#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A tile of the shadow map each, if something in it has changed: to be what it is without growth.
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { RestorePush push; };

void main() {
    uint tile = uint(gl_InstanceIndex);
    vec2 corner = vec2(gl_VertexIndex & 1, gl_VertexIndex >> 1);
    vec2 at = (vec2(tile % push.columns, tile / push.columns) + corner) * (2.0 / float(push.columns)) - 1.0;
    bool changed = floatBitsToUint(push.tiles.v[tile]) == kChangedTile;
    gl_Position = vec4(changed ? at : vec2(-1.0), 0.0, 1.0);
}
