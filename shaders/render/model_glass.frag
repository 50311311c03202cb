#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_demote_to_helper_invocation : require
#include "shaders/shared/extensions.glsl"
// Materials that are seen through, over what has been drawn.
#define ESPALIER_MAPPED
#define ESPALIER_GLASS
#include "shaders/render/sky.glsl"
#include "shaders/render/model.glsl"
