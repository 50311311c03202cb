#version 460
#extension GL_EXT_scalar_block_layout : require
// A box along the axes, 36 vertices pulled by index, in the middle of its sides' colour.
layout(push_constant, scalar) uniform Push {
    mat4 viewProjection;
    vec3 low, high, tint;
};
layout(location = 0) out vec4 color;

void main() {
    // Two triangles a side: the side's axis and which end, then corners over the two other axes.
    int side = gl_VertexIndex / 6;
    int axis = side / 2;
    const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1), ivec2(0, 1));
    ivec2 corner = corners[gl_VertexIndex % 6];
    vec3 at;
    at[axis] = float(side % 2);
    at[(axis + 1) % 3] = float(corner.x);
    at[(axis + 2) % 3] = float(corner.y);
    gl_Position = viewProjection * vec4(mix(low, high, at), 1);
    color = vec4(tint * (axis == 1 ? 1.0 : axis == 0 ? 0.55 : 0.8), 1);
}
