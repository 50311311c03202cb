// Included once for four samples a pixel and once for one (ESPALIER_ONE_SAMPLE).
// Leaves: two-sided, lit through, glossy above; each with a colour of its own.
#include "shaders/render/light.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(set = 0, binding = 0) uniform sampler2D colorMap;
layout(set = 0, binding = 1) uniform sampler2D normalMap;
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 tangent;
layout(location = 3) in vec4 uvOpen;
layout(location = 4) flat in uvec3 bits;
layout(location = 0) out vec4 color;

vec3 leafColor(vec3 base) {
    float tint = float(bits.x >> 24u) * (1.0 / 255.0);
    vec3 root = vec3((bits.x >> 19u) & 31u, (bits.x >> 13u) & 63u, (bits.x >> 8u) & 31u) / vec3(31.0, 63.0, 31.0);
    vec3 wanted = root * root;
    float a = float(bits.y & 255u) * (1.0 / 255.0);
    float b = float((bits.y >> 8u) & 255u) * (1.0 / 255.0);
    // The grammar's colour turns the texture's hue; its brightness stays the texture's.
    vec3 weights = vec3(0.3, 0.6, 0.1);
    vec3 turned = dot(base, weights) * wanted / max(dot(wanted, weights), 1e-3);
    base = mix(base, turned, 0.5 * min(1.0, 3.0 * (max(wanted.x, max(wanted.y, wanted.z)) - min(wanted.x, min(wanted.y, wanted.z)))));
    // From old, dark and bluish to young, light and yellow.
    // Whole patches differ too, as plants do.
    const vec3 young = vec3(1.20, 1.08, 0.55);
    const vec3 old = vec3(0.42, 0.56, 0.60);
    base *= mix(old, young, clamp(0.10 + 0.45 * tint + 0.5 * (a - 0.5) + 0.30 * uvOpen.w, 0.0, 1.0));
    return base * (0.80 + 0.40 * b);
}

void main() {
    // The atlas holds the upper sides in its upper half, their paler backs below.
    bool leaf = (bits.z >> 8u) == 1u;
    bool back = !gl_FrontFacing;
    vec2 uv = uvOpen.xy + vec2(0.0, leaf && back ? 0.5 : 0.0);
    vec4 texel = texture(colorMap, uv);
    if (push.alphaCutoff > 0.0) {
#ifdef ESPALIER_ONE_SAMPLE
        if (texel.a < push.alphaCutoff) discard;
    }
#else
        // Sharpened to a pixel's width around the cutoff, so that minified leaves neither swell nor vanish.
        float alpha = (texel.a - push.alphaCutoff) / max(fwidth(texel.a), 1e-3) + 0.5;
        gl_SampleMask[0] = coverage(alpha, bits.y >> 16u);
    } else {
        gl_SampleMask[0] = 15;
    }
#endif
    vec3 n = normalize(normal);
    vec3 m = texture(normalMap, uv).xyz * 2.0 - 1.0;
    vec3 t = normalize(tangent - n * dot(n, tangent));
    n = normalize(t * m.x + cross(n, t) * m.y + n * m.z);
    vec3 eye = normalize(push.frame.v[0].eye - position);
    vec3 face = back ? -n : n;
    uint view = push.frame.v[0].view;
    if (view != kViewShaded) {
        vec3 shown = view == kViewLod ? lodColor(bits.z & 255u) : vec3(0.16, 0.34, 0.10);
        color = view == kViewNormals ? stored(face * 0.5 + 0.5, 0.0) : diagnostic(push.frame, shown, face);
        return;
    }
    vec3 base = leafColor(texel.rgb * push.baseColor.rgb);
    vec3 sun = push.frame.v[0].sunDirection;
    float open = uvOpen.z;
    float side = dot(face, sun);
    float visible = sunVisibility(push.frame, position, side > 0.0 ? face : -face);
    float facing = max(side, 0.0);
    vec3 direct = base * facing;
    if (leaf) {
        // Light that falls on the other side comes through yellower.
        vec3 through = base * vec3(1.5, 1.35, 0.45);
        direct += through * max(-side, 0.0) * 0.65 + through * 0.10;
        direct += gloss(face, eye, sun, 0.42) * facing * (back ? 0.3 : 1.0);
    }
    direct *= push.frame.v[0].sunColor * visible * (0.30 + 0.70 * open);
    // The sky also shines through, and its mirror image lies on the waxy upper side.
    vec3 ambient = base * (skyLight(push.frame, face) + (leaf ? 0.25 * skyLight(push.frame, -face) : vec3(0.0)));
    float edge = 1.0 - max(dot(face, eye), 0.0);
    ambient += skyLight(push.frame, reflect(-eye, face)) * (0.02 + 0.10 * edge * edge * edge) * (back || !leaf ? 0.3 : 1.0);
    color = lit(push.frame, direct, ambient * open * open);
}
