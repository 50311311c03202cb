#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves of trees and bushes on cards, and blades of grass: lit at each vertex. A card's normals point out of its crown, so
// that a crown and its lobes have light and dark sides; the whole part of texture u is how open a corner lies, in
// eighths, 8 being outside; where its v is negative, the whole part is where the card faces: seen from its edge, when it
// would be a line, its leaves shrink away.
#include "shaders/render/light.glsl"
#include "shaders/render/prop_vertex.glsl"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(location = 0) out vec3 uvShare;   // uv; share of the light that is the sky's
layout(location = 1) out vec3 light;     // on a texel's colour; in the view of normals, the normal
layout(location = 2) flat out float fade;
layout(location = 3) flat out float shown;   // of its leaves

// Twigs of one tree differ a little.
vec3 foliageColor(PropVertex v) {
    vec3 young = vec3(1.16, 1.06, 0.72), old = vec3(0.80, 0.92, 0.92);
    float own = fract(max(v.code, 0.0) * 0.618034) - 0.5;
    return push.baseColor.rgb * mix(old, young, clamp(v.tint + 0.5 * own, 0.0, 1.0)) * ((1.0 + 0.2 * own) * v.shade);
}
// What a card's code says, in the model's space; either side.
vec3 cardNormal(float code) {
    const float side = float(kFacingSide);
    vec2 at = (vec2(mod(code, side), floor(code * (1.0 / side))) + 0.5) * (2.0 / side) - 1.0;
    vec3 n = vec3(at.x, 1.0 - abs(at.x) - abs(at.y), at.y);
    if (n.y < 0.0) n.xz = (1.0 - abs(n.zx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.z < 0.0 ? -1.0 : 1.0);
    return normalize(n);
}
// As meadow.glsl: green, in places dry; u is how far up the blade, whose foot has the ground's colour.
vec3 grassColor(PropVertex v) {
    vec3 green = frame.grassColor * (0.70 + 0.58 * v.uv.x);
    vec3 dry = frame.grassColor.yyy * vec3(1.25, 1.15, 0.48) * (0.60 + 0.60 * v.uv.x);
    return mix(green, dry, v.tint) * v.shade;
}

void main() {
    PropVertex v = propVertex(uint(gl_VertexIndex), push.firstInstance + uint(gl_InstanceIndex));
    bool grass = push.grass != 0u;
    vec3 eye = normalize(frame.eye - v.position);
    shown = v.code < 0.0 ? 1.0 : smoothstep(0.06, 0.42, abs(dot(turned(v, cardNormal(v.code)), eye)));
    float open = grass ? 0.72 + 0.28 * v.uv.x : v.open;
    float side = dot(v.normal, frame.sunDirection);
    // Light gets some way into a crown. What is low has little of a crown: its shade is that of other things.
    float high = grass ? 0.0 : push.high * v.scale;
    float into = min(0.9 * frame.unit, 0.5 * high);
    float through = (0.22 + 0.30 * open) * min(0.5 * high / frame.unit, 1.0);
    float visible = mix(through, 1.0, sunVisibility(v.position + frame.sunDirection * into, v.normal));
    // Leaves turn every way: what falls on a crown's far side comes through, the more the thinner it is.
    // How low the sun is, for what rises above its surroundings.
    float above = clamp((v.position.y - frame.groundLevel) * 0.6 / frame.unit - 0.2, 0.0, 1.0);
    float low = (1.0 - smoothstep(0.04, 0.42, frame.sunDirection.y)) * above;
    float facing = clamp(0.42 + 0.58 * side, 0.24 + 0.16 * low, 1.0);
    vec3 tone = grass ? grassColor(v) : foliageColor(v);
    vec3 direct = frame.sunColor * (visible * facing * (0.45 + 0.55 * open));
    // Against the sun, leaves glow.
    if (!grass) direct *= 1.0 + vec3(0.9, 0.7, 0.1) * pow(max(dot(-eye, frame.sunDirection), 0.0), 3.0);
    // They see the sky past each other from wherever they are, and what comes through them is yellower. Under a low sun most
    // light comes from the sky's rim, which shines into crowns from their sides.
    vec3 ambient = grass ? skyLight(v.normal) * open
                         : skyLight(0.55 * v.normal + vec3(0.0, 0.25, 0.0)) * vec3(1.12, 1.10, 0.84) *
                               (0.50 + 0.50 * open + low * (0.42 + 0.22 * open));
    const vec3 weights = vec3(0.3, 0.6, 0.1);
    light = tone * (direct + ambient) * frame.exposure;
    if (explains && frame.view == kViewNormals) light = normalize(v.normal) * 0.5 + 0.5;
    // What lets light through darkens what is behind it less than distances tell.
    float share = dot(ambient, weights) / max(dot(direct + ambient, weights), 1e-5);
    uvShare = vec3(v.uv, share * (grass ? 0.15 : 0.7));
    fade = v.fade;
    gl_Position = frame.viewProjection * vec4(v.position, 1.0);
}
