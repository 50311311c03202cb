#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_demote_to_helper_invocation : require
#include "shaders/shared/extensions.glsl"
// The surface's own mesh.
#include "shaders/render/model.glsl"
