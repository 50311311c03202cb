#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_demote_to_helper_invocation : require
#include "shaders/shared/extensions.glsl"
// Materials whose textures lie by UVs of their own, or that shine.
#define ESPALIER_MAPPED
#include "shaders/render/model.glsl"
