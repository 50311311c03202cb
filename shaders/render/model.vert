#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The surface's own mesh.
#include "shaders/render/model_vertex.glsl"
