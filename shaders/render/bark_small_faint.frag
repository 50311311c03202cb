#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#define ESPALIER_FAINT
#include "shaders/render/bark_small.glsl"
