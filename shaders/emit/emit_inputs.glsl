// What the culling kernels read.
#ifndef ESPALIER_EMIT_INPUTS_GLSL
#define ESPALIER_EMIT_INPUTS_GLSL
#include "shaders/emit/emit_push.glsl"

layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };
layout(set = 0, binding = 1, scalar) uniform ViewBlock { EmitView view; };
#endif
