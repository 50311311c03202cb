#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// glTF base colour and normal map under sun and sky; or what the other views ask for.
#include "shaders/render/light.glsl"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(set = 0, binding = 1) uniform sampler2D normalMap;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uvs;
layout(location = 0) out vec4 color;

uint walkTexel(uint size) {
    uvec2 at = min(uvec2(clamp(uvs.zw, 0.0, 1.0) * float(size)), uvec2(size - 1u));
    return texelIndex(size, at.x, at.y);
}

vec4 otherView(vec3 n) {
    uint view = frame.view;
    if (view == kViewNormals) return stored(n * 0.5 + 0.5, 0.0);
    vec3 shown = view == kViewLod ? lodColor(push.lod) : vec3(0.5);
    if (push.surface != kNoIndex && view == kViewCharts) {
        SurfaceRef surface = frame.surfaces.v[push.surface];
        SurfaceLevel level = surface.levels[min(frame.layer, surface.levelCount - 1u)];
        uint at = walkTexel(level.size);
        uint bits = level.texels.v[at].bits;
        shown = texelClass(bits) == kTexelEmpty ? vec3(0.02) : hashColor(texelChart(bits));
        // Where links pass; and, on coarse levels, which texel is which.
        if ((level.crossingHead.v[at] & 255u) != 0u) shown = mix(shown, vec3(1.0), 0.6);
        if (frame.layer > 0u && ((at ^ (at >> 3u)) & 1u) != 0u) shown *= 0.8;
    } else if (push.surface != kNoIndex && view == kViewLayer) {
        LayerRef layer = frame.layers.v[push.surface * kMaxLayers + frame.layer];
        float x = layer.fill;
        if (u64(layer.texels) != 0ul) {
            uvec2 at = min(uvec2(clamp(uvs.zw, 0.0, 1.0) * float(layer.size)), uvec2(layer.size - 1u));
            x = layer.texels.v[texelIndex(layer.size, at.x, at.y)];
        }
        shown = layerColor(x);
    }
    return diagnostic(shown, n);
}

// Two meshes share the picture while one takes over: each pixel shows the one or the other.
bool fadedOut() {
    float threshold = ditherAt(gl_FragCoord.xy);
    return push.fade > 0.0 ? threshold >= push.fade : threshold < -push.fade;
}

void main() {
    if (push.fade != 1.0 && fadedOut()) discard;
    vec4 base = texture(colorMap, uvs.xy);
    base = vec4(texelColor(base.rgb), base.a) * push.baseColor;
    if (push.alphaCutoff > 0.0 && base.a < push.alphaCutoff) discard;
    vec3 n = normalize(normal);
    vec3 eye = normalize(frame.eye - position);
    if (dot(n, eye) < 0.0 && !gl_FrontFacing) n = -n;
    vec3 bumped = n;
    float across = dot(tangent.xyz, tangent.xyz);
    if (across > 1e-12 && push.normalScale != 0.0) {
        vec3 m = texture(normalMap, uvs.xy).xyz * 2.0 - 1.0;
        vec3 t = tangent.xyz * inversesqrt(across);
        bumped = normalize(t * (m.x * push.normalScale) + cross(n, t) * (tangent.w * m.y * push.normalScale) + n * m.z);
    }
    uint view = frame.view;
    bool under = explains && view == kViewLayer && frame.layerOpacity < 1.0;
    if (explains && view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    if (explains && !under) {
        color = otherView(bumped);
        return;
    }
    vec3 sun = frame.sunDirection;
    float facing = max(dot(bumped, sun), 0.0) * step(0.0, dot(n, sun));
    float visible = facingSunVisibility(facing, position, n);
    vec3 direct = frame.sunColor * visible *
                  (base.rgb * facing + gloss(bumped, eye, sun, max(push.roughness, 0.35)) * facing);
    color = lit(direct, base.rgb * skyLight(bumped));
    if (under) color = mix(color, otherView(bumped), frame.layerOpacity);
}
