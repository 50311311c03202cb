#version 460
#extension GL_GOOGLE_include_directive : require
// The march of a regrowth, see expand_again.h.
#define ESPALIER_AGAIN
#define ESPALIER_TABLES
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/march.glsl"
