// A watched picture (Emit::watch): tiles where spans and leaves were or are that are bound anew. The text of kernels, and
// in C++ of a member: `push` and `watched` are around it.
void noteChange(vec3 center, float radius) {
    Reach tiles = reachOf(watched, watched.viewProjection * vec4(center, 1.0f), 1.0f, radius);
    for (int y = tiles.low.y; y <= tiles.high.y; ++y)
        for (int x = tiles.low.x; x <= tiles.high.x; ++x)
            watched.tiles.v[y * tiles.columns + x] = uintBitsToFloat(kChangedTile);
}

// As far as the culling kernels take them to reach.
void noteSpan(vec3 p0, vec3 b1, vec3 b2, vec3 p3, float thick) {
    IF_ANY(push.watched != 0u) {
        vec4 sphere = spanSphere(p0, b1, b2, p3);
        noteChange(vec3(sphere), sphere.w + 2.0f * max(thick, watched.leastPixels / watched.pixelScale));
    }
}
void noteLeaf(vec3 origin, float size, float extent) {
    IF_ANY(push.watched != 0u)
        noteChange(origin, size * leafGrowth(leafShare(watched, size * watched.pixelScale)) * extent);
}
