#version 460
#extension GL_GOOGLE_include_directive : require
// The march over the intrinsic walk.
#define ESPALIER_TABLES
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/march.glsl"
