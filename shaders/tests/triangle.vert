#version 460
// A triangle an instance, over the left half, pulled by index.
layout(location = 0) out vec4 color;
layout(push_constant) uniform Push { vec4 tint; };

void main() {
    const vec2 corners[3] = vec2[](vec2(-1, -1), vec2(0, -1), vec2(-1, 3));
    gl_Position = vec4(corners[gl_VertexIndex % 3], 0.5, 1);
    color = tint;
}
