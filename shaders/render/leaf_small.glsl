// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// Leaves of few pixels, their light brought along from the vertices.
#include "shaders/render/leaf_alpha.glsl"
#include "shaders/render/leaf_light.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 uvShare;
layout(location = 1) centroid in vec3 own;
layout(location = 2) centroid in vec3 turned;
layout(location = 3) centroid in vec3 mirrored;
layout(location = 4) flat in uint hash;
layout(location = 0) out vec4 color;

void main() {
    vec4 texel = texture(colorMap, uvShare.xy);
    texel.rgb = texelColor(texel.rgb);
    CUT_OUT(texel.a, push.alphaCutoff, hash >> 16u)
    color = sceneColor(texel.rgb * own + dot(texel.rgb, kLeafWeights) * turned + mirrored, uvShare.z);
}
