// Texel::bits as walks read them, what other placements bury included. Included after `env` is declared.
uint bitsAt(uint i) {
    if (IS_GIVEN(env.texelTiles)) return env.texelTiles.v[i >> 6u].v[i & 63u].bits;
    return env.texels.v[i].bits;
}
