#version 460
// One of each resource that a program may bind.
layout(local_size_x = 8, local_size_y = 4) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D target;
layout(set = 0, binding = 5, std430) buffer Count { uint count; };

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(target)))) return;
    imageStore(target, at, texelFetch(source, at, 0).bgra);
    atomicAdd(count, 1);
}
