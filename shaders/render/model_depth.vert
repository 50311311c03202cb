#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Its depths only: a software device shades vertices in one thread, and works out whatever they put out.
#define ESPALIER_DEPTH_ONLY
#include "shaders/render/model_vertex.glsl"
