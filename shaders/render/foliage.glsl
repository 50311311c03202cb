// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
#include "shaders/render/leaf_alpha.glsl"
#include "shaders/render/light.glsl"
#include "shaders/render/prop_fade.glsl"
#include "shaders/render/prop_records.h"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 uvShare;
layout(location = 1) in vec3 light;
layout(location = 2) flat in float fade;
layout(location = 0) out vec4 color;

void main() {
    if (fadedOut(fade)) discard;
    vec4 texel = texture(colorMap, uvShare.xy);
    CUT_OUT(texel.a, push.alphaCutoff, 0u)
    color = stored(toneMapped(texelColor(texel.rgb) * light), uvShare.z);
    if (explains) color = frame.view == kViewOverdraw ? oneFragment() : stored(vec3(0.10, 0.14, 0.07), 0.6);
}
