#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Depths of what is cut out of its triangles.
#define ESPALIER_DEPTH_ONLY
#define ESPALIER_CUT_OUT
#include "shaders/render/model_vertex.glsl"
