// Instances from their texels. Macros, since samplers can't be arguments of functions everywhere.
#ifndef ESPALIER_EMIT_INSTANCE_TEXELS_GLSL
#define ESPALIER_EMIT_INSTANCE_TEXELS_GLSL
#include "records/emit_records.h"

#define TEXEL(texels, i) texelFetch(texels, int(i))
#define LEAF_INSTANCE(texels, i) FETCH_LeafInstance(TEXEL, texels, i)
#define SPAN_INSTANCE(texels, i) FETCH_SpanInstance(TEXEL, texels, i)
#endif
