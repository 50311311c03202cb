// Binding that notes where a watched picture changes.
#ifndef ESPALIER_EMIT_WATCH_GLSL
#define ESPALIER_EMIT_WATCH_GLSL
#include "shaders/emit/bind.glsl"
#include "shaders/emit/leaf_thinning.h"
#include "shaders/emit/sight.h"

layout(set = 0, binding = 7, scalar) uniform WatchBlock { EmitView watched; };

#include "shaders/emit/note_change.h"
#endif
