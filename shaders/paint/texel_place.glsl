// An invocation's texel and its places. Included after `env`, a PlacesEnv, is declared.
#include "shaders/paint/texel_bits.glsl"

uint texelOf(uint item) { return env.blocks.v[item / kBlockTexels] * kBlockTexels + item % kBlockTexels; }
uint placesOf(uint item) { return item / kBlockTexels * (kSmoothPlaces * kBlockTexels) + item % kBlockTexels; }

uvec2 whereIs(uint texel) {
    uint across = env.size / 8u;
    uint block = texel / kBlockTexels;
    return uvec2(block % across, block / across) * 8u + uvec2(texel % 8u, texel % kBlockTexels / 8u);
}

vec3 positionAt(uint x, uint y) { return env.texels.v[texelIndex(env.size, x, y)].position; }

uint packedPlace(vec2 uv) {
    return uint(inRange(uv.y, 1.0) * 65534.0) << 16u | uint(inRange(uv.x, 1.0) * 65534.0);
}
