// The frame that is drawn. A uniform block: software devices read it once for all lanes, by address lane by lane.
#ifndef ESPALIER_RENDER_FRAME_GLSL
#define ESPALIER_RENDER_FRAME_GLSL
#include "shaders/render/frame_records.h"
#include "shaders/shared/constants.h"

layout(set = 0, binding = 8, scalar) uniform FrameBlock { FrameRecord frame; };

// Any view but the shaded one. A constant: some devices run both sides of an `if`.
layout(constant_id = kConstantExplains) const bool explains = false;
// Fewer samples of shadows and textures.
layout(constant_id = kConstantQuick) const bool quick = false;

// What only some triangles or pictures need is in a program of its own: some devices run both sides of an `if`, and a loop's
// body once when nothing of it is wanted.
layout(constant_id = kConstantRest) const bool rest = false;

// Textures hold the square roots of linear colours, instead of sRGB: what software devices filter fastest.
layout(constant_id = kConstantRooted) const bool rooted = false;
vec3 texelColor(vec3 texel) { return rooted ? texel * texel : texel; }
#endif
