// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// Bark: its texture at two neighbouring octaves of scale, blended by the radius, so that nothing is stretched where
// a stem grows thinner and nothing jumps at a joint.
#include "shaders/render/light.glsl"
#include "shaders/render/bark_color.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 along;
layout(location = 3) flat in uint hash;
layout(location = 0) out vec4 color;

void main() {
#ifdef ESPALIER_ONE_SAMPLE
    if (along.w < ditherAt(gl_FragCoord.xy + frame.ditherFrom)) discard;
#else
    gl_SampleMask[0] = coverage(along.w, hash >> 8u);
#endif
    vec3 n = normalize(normal);
    uint view = frame.view;
    if (explains && view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    if (explains && view != kViewLayer) {
        vec3 shown = view == kViewNormals ? n * 0.5 + 0.5 : view == kViewLod ? lodColor(hash & 7u) :
                     view == kViewDepth ? depthColor((hash >> 3u) & 31u) : vec3(0.30, 0.22, 0.15);
        color = view == kViewNormals ? stored(shown, 0.0) : diagnostic(shown, n);
        return;
    }
    // One turn around is 2 pi r; the nearest lower and upper powers of two of that.
    float octave = floor(along.z);
    float blend = along.z - octave;
    float scale = exp2(-octave) * (1.0 / 6.2831853);
    vec3 base = texelColor(mix(texture(colorMap, vec2(along.x, along.y * scale)).rgb,
                               texture(colorMap, vec2(along.x, along.y * scale * 0.5)).rgb, blend)) * push.baseColor.rgb;
    base = mix(base, kYoungBark, youngBark(along.z));
    vec3 eye = normalize(frame.eye - position);
    vec3 sun = frame.sunDirection;
    float facing = max(dot(n, sun), 0.0);
    float visible = facingSunVisibility(facing, position, n);
    vec3 direct = frame.sunColor * visible * facing * (base + gloss(n, eye, sun, max(push.roughness, 0.5)));
    color = lit(direct, base * skyLight(n) * 0.8);
}
