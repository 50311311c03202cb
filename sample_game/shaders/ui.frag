#version 460
// The window's format is UNORM and holds sRGB values, as ImGui's colours are.
layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 colour;
layout(location = 0) out vec4 outColour;
layout(set = 0, binding = 0) uniform sampler2D picture;

void main() { outColour = colour * texture(picture, uv); }
