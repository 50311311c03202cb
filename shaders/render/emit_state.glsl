// Where each bucket's instances begin in what is drawn.
#ifndef ESPALIER_RENDER_EMIT_STATE_GLSL
#define ESPALIER_RENDER_EMIT_STATE_GLSL
#include "shaders/emit/emit_records.h"

layout(set = 0, binding = 9, scalar) uniform StateBlock { EmitState state; };
#endif
