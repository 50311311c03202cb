// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// Leaves that are large enough to show their veins: lit at each pixel, each with a colour of its own.
#include "shaders/render/leaf_alpha.glsl"
#include "shaders/render/leaf_light.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(set = 0, binding = 1) uniform sampler2D normalMap;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
layout(location = 3) in vec4 uvOpen;
layout(location = 4) flat in uvec3 bits;
layout(location = 0) out vec4 color;

void main() {
    // The atlas holds the upper sides in its upper half, their paler backs below.
    uint kind = bits.z >> 8u;
    bool back = shippedMesh(kind) != kMeshTuft && !gl_FrontFacing;
    vec2 uv = uvOpen.xy + vec2(0.0, back && showsBack(kind) ? 0.5 : 0.0);
    vec4 texel = texture(colorMap, uv);
    texel.rgb = texelColor(texel.rgb);
    CUT_OUT(texel.a, push.alphaCutoff, bits.y >> 16u)
    vec3 n = normalize(normal);
    vec3 m = texture(normalMap, uv).xyz * 2.0 - 1.0;
    vec3 t = normalize(tangent - n * dot(n, tangent));
    n = normalize(t * m.x + cross(n, t) * m.y + n * m.z);
    vec3 face = back ? -n : n;
    uint view = frame.view;
    if (explains && view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    if (explains && view != kViewLayer) {
        vec3 shown = view == kViewLod ? lodColor(bits.z & 7u) :
                     view == kViewDepth ? depthColor((bits.z >> 3u) & 31u) : vec3(0.16, 0.34, 0.10);
        color = view == kViewNormals ? stored(face * 0.5 + 0.5, 0.0) : diagnostic(shown, face);
        return;
    }
    vec3 base = leafColor(leafTint(push.baseColor.rgb, bits.x, bits.y, uvOpen.w, kind), texel.rgb);
    float visible = sunVisibility(position, dot(face, frame.sunDirection) > 0.0 ? face : -face);
    vec3 eye = normalize(frame.eye - position);
    LeafLight light = leafLight(face, eye, uvOpen.z, visible, kind, back);
    color = lit(base * light.sun + light.sunMirror, base * light.sky + light.skyMirror);
    color.a *= kLeafShade;
}
