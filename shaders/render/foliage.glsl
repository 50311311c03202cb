// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
#include "shaders/render/leaf_alpha.glsl"
#include "shaders/render/light.glsl"
#include "shaders/render/prop_records.h"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 uvShare;
layout(location = 1) centroid in vec3 light;
layout(location = 2) flat in float fade;
layout(location = 3) flat in float shown;
layout(location = 0) out vec4 color;

// Where one level takes over from another its leaves grow, and then the other's shrink: alpha is a ramp towards their
// middle. fade: PropInstance::fade.
float cutoffOf(float fade) {
    float whole = fade > 0.0 ? smoothstep(0.0, 0.6, fade) : 1.0 - smoothstep(0.4, 1.0, -fade);
    return mix(1.01, push.alphaCutoff, whole * shown);
}

void main() {
    vec4 texel = texture(colorMap, uvShare.xy, -1.0);
    CUT_OUT(texel.a, cutoffOf(fade), 0u)
    color = stored(toneMapped(texelColor(texel.rgb) * light), uvShare.z);
    if (explains)
        color = frame.view == kViewOverdraw  ? oneFragment()
                : frame.view == kViewNormals ? stored(light, 0.0) : stored(vec3(0.10, 0.14, 0.07), 0.6);
}
