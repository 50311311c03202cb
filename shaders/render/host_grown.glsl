// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// Depth of the nearest growth in each pixel that is nearer than what the host has drawn there; 0: there is none.
#include "shaders/render/scene_sampler.glsl"

layout(set = 0, binding = 0) uniform SceneSampler sceneDepth;
layout(set = 0, binding = 1) uniform sampler2D hostNear;
layout(location = 0) out float grown;

#ifdef ESPALIER_ONE_SAMPLE
const int kSamples = 1;
#else
const int kSamples = 4;
#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float nearest = 0.0;
    for (int i = 0; i < kSamples; ++i) nearest = max(nearest, texelFetch(sceneDepth, at, i).x);
    grown = nearest > texelFetch(hostNear, at, 0).x ? nearest : 0.0;
}
