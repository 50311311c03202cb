#ifndef ESPALIER_EMIT_PUSH_GLSL
#define ESPALIER_EMIT_PUSH_GLSL
#include "shaders/emit/emit_records.h"

layout(push_constant, scalar) uniform Data { EmitPush push; };
#endif
