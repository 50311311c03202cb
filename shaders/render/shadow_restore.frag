#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Depths of what stands.
layout(set = 0, binding = 0) uniform sampler2D standing;

void main() { gl_FragDepth = texelFetch(standing, ivec2(gl_FragCoord.xy), 0).x; }
