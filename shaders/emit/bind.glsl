// What the kernels that bind growth share: their inputs, and bind_item.h.
#ifndef ESPALIER_EMIT_BIND_GLSL
#define ESPALIER_EMIT_BIND_GLSL
#include "shaders/emit/cells.h"
#include "shaders/shared/dispatch.glsl"

layout(set = 0, binding = 8, scalar) uniform BindBlock { BindInputs push; };

// Lanes go through work of any size in strides.
#define FIRST_LANE gl_GlobalInvocationID.x
#define LANES (gl_NumWorkGroups.x * gl_WorkGroupSize.x)

#include "shaders/emit/bind_item.h"
#endif
