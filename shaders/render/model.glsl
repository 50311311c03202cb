// glTF base colour and normal map under sun and sky; or what the other views ask for. ESPALIER_MAPPED: each texture is
// looked up by UVs of its own, and the material may shine or mirror. ESPALIER_GLASS: what lies behind is seen through it.
#include "shaders/render/light.glsl"
#include "shaders/shared/surface_lookup.h"
#include "shaders/render/meadow.glsl"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(set = 0, binding = 1) uniform sampler2D normalMap;
layout(set = 0, binding = 3) uniform sampler2D noise;
layout(set = 0, binding = 4) uniform sampler2D site;
layout(set = 0, binding = 5) uniform sampler2D paving;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uvs;
layout(location = 5) in vec4 tint;   // the vertex's colour
layout(location = 0) out vec4 color;

#ifdef ESPALIER_MAPPED
#include "shaders/render/mirror.glsl"
layout(set = 0, binding = 6) uniform sampler2D emissiveMap;
layout(set = 0, binding = 7) uniform sampler2D roughnessMap;
layout(set = 0, binding = 9, scalar) uniform MaterialBlock { MaterialRecord material; };
layout(location = 4) in vec2 otherUv;
vec2 lookedUp(vec3 u, vec3 v, uint other) {
    vec3 at = vec3(other != 0u ? otherUv : uvs.xy, 1.0);
    return vec2(dot(u, at), dot(v, at));
}
vec2 colorUv() { return lookedUp(push.colorU, push.colorV, push.colorOther); }
vec2 normalUv() { return lookedUp(material.normalU, material.normalV, material.normalOther); }
vec3 emission() {
    vec2 uv = lookedUp(material.emissiveU, material.emissiveV, material.emissiveOther);
    return material.emissive * texelColor(texture(emissiveMap, uv).rgb);
}
// Roughness and metal.
vec2 finish() {
    vec2 uv = lookedUp(material.roughnessU, material.roughnessV, material.roughnessOther);
    return texture(roughnessMap, uv).gb * vec2(push.roughness, material.metallic);
}
#else
vec2 colorUv() { return uvs.xy; }
vec2 normalUv() { return uvs.xy; }
#endif

const float kHatching = 0.012;   // between stripes, of the distance

uint walkTexel(uint size) {
    uvec2 at = min(uvec2(clamp(uvs.zw, 0.0, 1.0) * float(size)), uvec2(size - 1u));
    return texelIndex(size, at.x, at.y);
}

// Darkens what is no ground: within a chart only texels that others bury are links without a list.
vec3 withBuried(vec3 shown, uint level) {
    uint at = walkTexel(levelSize(frame.surfaces, push.surface, level));
    bool buried = texelClass(readTexel(frame.surfaces, push.surface, level, at).bits) == kTexelLink &&
                  (readHead(frame.surfaces, push.surface, level, at) & 255u) == 0u;
    return buried ? shown * 0.3 : shown;
}

// Darkens stripes of what the limits of the brush in hand keep paint from, by the normals that it goes by.
float hatching() {
    SurfaceRef surface = frame.surfaces.v[push.surface];
    vec3 n = unpackOct(surface.levels[0].aux.v[walkTexel(surface.levels[0].size)].normal);
    n = normalize(vec3(dot(surface.toWorld[0].xyz, n), dot(surface.toWorld[1].xyz, n), dot(surface.toWorld[2].xyz, n)));
    float kept = 1.0 - slopeWeight(frame.limits, n) * heightWeight(frame.limits, position);
    float across = abs(fract((gl_FragCoord.x + gl_FragCoord.y) / (kHatching * frame.pixelScale)) - 0.5);
    return 1.0 - 0.7 * kept * smoothstep(0.25, 0.35, across);
}

float painted(uint index) {
    LayerRef layer = frame.layers.v[push.surface * kMaxLayers + index];
    if (u64(layer.texels) == 0ul) return layer.fill;
    uvec2 at = min(uvec2(clamp(uvs.zw, 0.0, 1.0) * float(layer.size)), uvec2(layer.size - 1u));
    return layer.texels.v[texelIndex(layer.size, at.x, at.y)];
}

vec4 otherView(vec3 n) {
    uint view = frame.view;
    if (view == kViewNormals) return stored(n * 0.5 + 0.5, 0.0);
    vec3 shown = view == kViewLod ? lodColor(push.lod) : vec3(0.5);
    if (push.surface != kNoIndex && view == kViewCharts) {
        uint level = min(frame.layer, frame.surfaces.v[push.surface].levelCount - 1u);
        uint at = walkTexel(levelSize(frame.surfaces, push.surface, level));
        uint bits = readTexel(frame.surfaces, push.surface, level, at).bits;
        shown = texelClass(bits) == kTexelEmpty ? vec3(0.02) : chartColor(texelChart(bits));
        // Where links pass; and, on coarse levels, which texel is which.
        if ((readHead(frame.surfaces, push.surface, level, at) & 255u) != 0u) shown = mix(shown, vec3(1.0), 0.6);
        if (frame.layer > 0u && ((at ^ (at >> 3u)) & 1u) != 0u) shown *= 0.8;
        shown = withBuried(shown, level);
    } else if (push.surface != kNoIndex && view == kViewLayer && frame.layer != kNoIndex) {
        uint layer = frame.layer;
        shown = isColourLayers(layer) ? vec3(painted(layer & 255u), painted((layer >> 8u) & 255u), painted((layer >> 16u) & 255u)) :
                layerColor(painted(layer));
        shown = withBuried(shown, 0u);
    }
    return diagnostic(shown, n);
}

// Where a texture has fewer texels than there are pixels, rough material goes on in a grain of its own.
// plane: the face's normal; footX, footY: how uvs.xy change from pixel to pixel, in texels.
void addGrain(vec3 plane, vec2 footX, vec2 footY, inout vec3 base, inout vec3 bumped) {
    float share = clamp(1.15 - 1.6 * max(dot(footX, footX), dot(footY, footY)), 0.0, 1.0) *
                  clamp(push.roughness * 4.0 - 2.2, 0.0, 1.0);
    vec3 at = position * (1.0 / 0.37) / frame.unit, atX = dFdx(at), atY = dFdy(at);
    vec3 a = abs(plane);
    bool side = a.x > a.y && a.x > a.z, top = !side && a.y > a.z;
    if (share > 0.0) {
        vec2 p = side ? at.zy : top ? at.xz : at.xy;
        vec2 px = side ? atX.zy : top ? atX.xz : atX.xy, py = side ? atY.zy : top ? atY.xz : atY.xy;
        vec4 coarse = textureGrad(noise, p, px, py) * 2.0 - 1.0;
        vec4 fine = textureGrad(noise, p.yx * 3.1, px.yx * 3.1, py.yx * 3.1) * 2.0 - 1.0;
        base *= 1.0 + share * (0.16 * coarse.x + 0.30 * fine.x);
        vec2 slope = share * (0.40 * coarse.zw + 0.45 * fine.wz);
        bumped = normalize(bumped - (side ? vec3(0.0, slope.y, slope.x) : top ? vec3(slope.x, 0.0, slope.y) : vec3(slope, 0.0)));
    }
}

// What lies almost as low as the meadow is overgrown by it (`rest` is the program of such triangles).
void addMeadow(vec3 plane, float metres, inout vec3 base, inout vec3 bumped) {
    float above = (position.y - frame.groundLevel) / frame.unit;
    float share = clamp(1.25 - above * 14.0, 0.0, 1.0) * clamp(plane.y * 4.0 - 2.6, 0.0, 1.0);
    vec2 place = position.xz / frame.unit, placeX = dFdx(place), placeY = dFdy(place);
    vec3 laid = siteAt(site, place, placeX, placeY);
    float pixel = 0.5 * max(length(placeX), length(placeY));
    Meadow meadow = meadowAt(noise, paving, place, placeX, placeY, metres, laid, pixel, !quick);
    // Blades first: the lighter ones reach out farther.
    float lush = dot(meadow.base, vec3(0.3, 0.6, 0.1)) / dot(frame.grassColor, vec3(0.3, 0.6, 0.1));
    share = smoothstep(0.25, 0.75, share * 1.2 + 1.6 * (lush - 1.0) * share * (1.0 - share));
    base = mix(base, meadow.base, share);
    bumped = normalize(mix(bumped, meadow.normal, share));
}

#ifdef ESPALIER_GLASS
// A pane: light that it throws back, over what it lets through. Premultiplied by coverage. lit: what the base colour shows, before that; glint: the sun's own image.
// Where a blended picture has nothing, as around a decal, there is no pane.
vec4 glass(vec4 base, vec3 bumped, vec3 eye, vec3 lit, vec3 glint, float rough) {
    float c = 1.0 - clamp(abs(dot(bumped, eye)), 0.0, 1.0);
    float smoothness = 1.0 - 0.8 * rough;
    float there = material.transmission > 0.0 ? 1.0 : min(base.a * 16.0, 1.0);
    float thrown = there * (0.04 + 0.96 * (c * c) * (c * c) * c) * smoothness * smoothness;
    glint *= there;
    float cover = base.a * (1.0 - material.transmission);
    vec3 seen = lit * cover + skyColor(reflect(-eye, bumped)) * thrown + glint + emission();
    float bright = min(max(glint.r, max(glint.g, glint.b)) * frame.exposure, 1.0);
    float all = max(cover + thrown - cover * thrown, max(bright, 1e-4));
    vec3 mapped = toneMapped(seen / all * frame.exposure);
    return vec4(sqrt(mapped) * all, all);
}
#endif

void main() {
    // What isn't drawn goes on, for the derivatives of the pixels beside it.
    if (!quick && push.fade != 1.0 && fadedOut(push.fade, gl_FragCoord.xy)) demote;   // there one mesh replaces another at once
    vec3 n = normalize(normal);
    vec3 eye = normalize(frame.eye - position);
    if (dot(n, eye) < 0.0 && !gl_FrontFacing) n = -n;
    vec4 base = texture(colorMap, colorUv());
    base = vec4(texelColor(base.rgb), base.a) * push.baseColor * tint;
    if (push.alphaCutoff > 0.0 && base.a < push.alphaCutoff) demote;
    vec3 bumped = n;
    float across = dot(tangent.xyz, tangent.xyz);
    if (across > 1e-12 && push.normalScale != 0.0) {
        vec3 m = texture(normalMap, normalUv()).xyz * 2.0 - 1.0;
        vec3 t = tangent.xyz * inversesqrt(across);
        bumped = normalize(t * (m.x * push.normalScale) + cross(n, t) * (tangent.w * m.y * push.normalScale) + n * m.z);
    }
    uint view = frame.view;
    bool under = explains && view == kViewLayer && frame.layerOpacity < 1.0;
    if (explains && view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    vec4 over = vec4(0.0);
    if (explains) over = otherView(bumped);
    float hatched = 1.0;
    if (explains && view == kViewLayer && push.surface != kNoIndex) hatched = hatching();
    if (explains && !under) {
        color = vec4(over.rgb * hatched, over.a);
        return;
    }
    vec2 texels = vec2(textureSize(colorMap, 0));
    vec2 footX = dFdx(colorUv()) * texels, footY = dFdy(colorUv()) * texels;
    if (!quick && texels.x > 4.0) addGrain(n, footX, footY, base.rgb, bumped);
    if (rest) addMeadow(n, length(frame.eye - position) / frame.unit, base.rgb, bumped);
    vec3 sun = frame.sunDirection;
    float facing = max(dot(bumped, sun), 0.0) * step(0.0, dot(n, sun));
    float visible = facingSunVisibility(facing, position, n);
#if defined(ESPALIER_GLASS)
    float rough = finish().x;
    vec3 glint = frame.sunColor * (visible * facing * gloss(bumped, eye, sun, max(rough, 0.15)));
    color = glass(base, bumped, eye, base.rgb * (frame.sunColor * (visible * facing) + skyLight(bumped)), glint, rough);
    return;
#elif defined(ESPALIER_MAPPED)
    vec2 rough = finish();
    Mirror mirror = mirrorOf(base.rgb, rough.y, rough.x);
    vec3 scattered = base.rgb * (1.0 - rough.y);
    vec3 direct = frame.sunColor * visible * (scattered * facing + mirroredSun(mirror, bumped, eye, sun)) + emission();
    vec3 ambient = scattered * skyLight(bumped) + mirroredSky(mirror, bumped, eye);
#else
    vec3 direct = frame.sunColor * visible *
                  (base.rgb * facing + gloss(bumped, eye, sun, max(push.roughness, 0.35)) * facing);
    vec3 ambient = base.rgb * skyLight(bumped);
#endif
#ifndef ESPALIER_GLASS
    color = lit(direct, ambient);
    if (under) color = mix(color, over, frame.layerOpacity) * vec4(vec3(hatched), 1.0);
#endif
}
