#version 460
// A picture as it is; the blend unit lays a share of it over what is there.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 outColour;
layout(set = 0, binding = 0) uniform sampler2D picture;

void main() { outColour = vec4(texture(picture, uv).rgb, 1.0); }
