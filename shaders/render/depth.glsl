// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// Distance along the view of every second pixel, for ambient occlusion.
#include "shaders/render/frame.glsl"
#include "shaders/render/scene_sampler.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform SceneSampler depthMap;
layout(location = 0) out float distanceAlong;

void main() {
    float z = texelFetch(depthMap, min(ivec2(gl_FragCoord.xy) * 2, sceneSize(depthMap) - 1), 0).x;
    distanceAlong = z > 0.0 ? frame.nearPlane / z : 1e6;
}
