#version 460
// Dear ImGui's vertices: pixels of the window to clip space.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
layout(location = 0) out vec2 outUv;
layout(location = 1) out vec4 outColour;
layout(push_constant) uniform Push {
    vec2 scale;
    vec2 offset;
} push;

void main() {
    outUv = uv;
    outColour = colour;
    gl_Position = vec4(position * push.scale + push.offset, 0, 1);
}
