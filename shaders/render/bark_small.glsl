// Included once for four samples a pixel, once for one (ESPALIER_ONE_SAMPLE), and once for one over all that has been
// drawn, to be blended with it (ESPALIER_FAINT).
// Bark of few pixels, its light brought along from the vertices.
#include "shaders/render/light.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec4 uvFade;
layout(location = 1) centroid in vec3 own;
layout(location = 2) centroid in vec3 other;
layout(location = 3) flat in uint hash;
layout(location = 0) out vec4 color;

void main() {
#if defined(ESPALIER_ONE_SAMPLE)
    if (uvFade.z < ditherAt(gl_FragCoord.xy + frame.ditherFrom)) discard;
#elif !defined(ESPALIER_FAINT)
    gl_SampleMask[0] = coverage(uvFade.z, hash >> 8u);
#endif
    vec3 texel = texelColor(texture(colorMap, uvFade.xy).rgb);
    color = sceneColor(texel * own + other, uvFade.w);
#ifdef ESPALIER_FAINT
    color = vec4(color.rgb * uvFade.z, uvFade.z);   // that share of the pixel
#endif
}
