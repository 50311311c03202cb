// The scene's stored colour -> what a picture holds.
#ifndef ESPALIER_RENDER_ENCODE_GLSL
#define ESPALIER_RENDER_ENCODE_GLSL

// Linear -> sRGB, by roots, which cost less than its power: 0.0004 off at most. root: x's square root.
vec3 encodedColor(vec3 x, vec3 root) {
    return mix(x * 12.92, 0.833753 * root + 0.298108 * sqrt(root) - 0.055317 * x - 0.076904,
               greaterThan(x, vec3(0.0031308)));
}

// c: as stored() of tone.glsl; open: ambient visibility; encode: to sRGB; at: the pixel.
vec4 pictureColor(vec4 c, float open, bool encode, ivec2 at) {
    vec3 root = c.rgb * sqrt(1.0 - c.a * (1.0 - open));
    vec3 x = root * root;
    if (encode) x = encodedColor(x, root);
    // Half a step of noise, the same on every run, so that the sky shows no bands.
    uint h = (uint(at.x) * 0x9E3779B1u) ^ (uint(at.y) * 0x85EBCA77u);
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    return vec4(x + (float(h >> 24u) * (1.0 / 255.0) - 0.5) * (1.0 / 255.0), 1.0);
}

// sRGB -> linear.
vec3 decodedColor(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}
#endif
