#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The surface's own mesh, with both of its textures' UV sets.
#define ESPALIER_MAPPED
#include "shaders/render/model_vertex.glsl"
