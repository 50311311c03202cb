#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#define ESPALIER_CUT
#include "shaders/render/roof_tile.glsl"
