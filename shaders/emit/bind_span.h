// The span that ends at a node, as an instance in the world, put into its cell. The text of a kernel, and in C++ of a
// member: `push`, `table`, addTriangles(), writeSpan(), bind_item.h and note_change.h are around it.

// As in SpanInstance::bits.
uint stretchBits(Node node, ChunkBrief chunk) {
    uint local = (node.flags >> 8u) & 31u;
    uint place = local % kStretch;
    bool last = place == kStretch - 1u || local + 1u == chunkNodes(chunk.marks);
    return (place << 12u) | (last ? 0x8000u : 0u);
}

SpanInstance instanceOf(LoadedSpan s, Node node, ChunkBrief chunk, uint kind) {
    SpanInstance o;
    o.p0 = s.span.p0;
    o.b1 = s.span.b1;
    o.b2 = s.span.b2;
    o.p3 = s.span.p3;
    o.normal0 = packOct(s.normal0);
    o.normal1 = packOct(s.normal1);
    o.radius0 = s.radius0;
    o.radius1 = s.radius1;
    o.arc0 = s.arc0;
    o.metres = spanLength(s.span);
    vec3 chord = o.p3 - o.p0;
    float bend = 0.75f * max(length(o.b1 - o.p0 - chord / 3.0f), length(o.b2 - o.p3 + chord / 3.0f));
    o.errors = packHalf2x16(vec2(bend, kNeverJoined));
    uint order = uint(twigOrder(chunk.key) * 65535.0f);
    o.bits = kind | (s.tip ? 64u : 0u) | (min(chunk.depth & 0xFFFFu, 31u) << 7u) | stretchBits(node, chunk) | (order << 16u);
    vec4 sphere = spanSphere(o.p0, o.b1, o.b2, o.p3);
    o.center = vec3(sphere);
    o.reach = sphere.w;
    return o;
}

uint trianglesOfBark(uint kind) {
    return table.buckets[table.variants[table.kinds[kind].firstVariant].firstBucket].indexCount / 3u;
}

// Leaves that were bound to node `i` are to be bound again, and chained anew. Not too many: no chain that was never
// written is followed for ever.
void listLeaves(uint i) {
    IF_ANY(push.partly != 0u && i < push.nodesBefore) {
        uint leaf = push.leafHeads.v[i];
        for (uint k = 0u; k < 65536u && leaf < push.leavesBefore; ++k) {
            uint at = atomicAdd(HEAD.largest, 1u);
            if (at < push.leavesBefore) push.work.v[push.leafWork + at] = leaf;
            leaf = push.leafNext.v[leaf];
        }
    }
    push.leafHeads.v[i] = kNoIndex;
}

void bindSpan(uint i) {
    ExpandEnv env;
    env.nodes = push.nodes;
    env.chunks = push.chunks;
    bool concerned = true;
    IF_ANY(push.partly != 0u) concerned = (push.flags.v[i] & kFlagSpan) != 0u;
    if (concerned) {
        listLeaves(i);
        if (takeKey(i, i < push.nodesBefore)) {
            addTriangles(0u - trianglesOfBark(push.spans.v[i].bits & 63u));
            noteSpan(push.spans.v[i].p0, push.spans.v[i].b1, push.spans.v[i].b2, push.spans.v[i].p3,
                     max(push.spans.v[i].radius0, push.spans.v[i].radius1));
        }
        push.spans.v[i].reach = -1.0f;
        Node node = readNode(env, i);
        bool there = !isGap(node);
        ChunkBrief chunk = readChunkBrief(env.chunks, there ? node.chunk : 0u);
        push.spans.v[i].bits = kNoBark | (there ? stretchBits(node, chunk) : 0u);
        uint before = ((node.flags >> 8u) & 31u) > 0u ? i - 1u : chunk.previousNode;
        if (there && before != kNoIndex) {
            Node start = readNode(env, before);
            ChunkBrief from = chunk;
            if (start.chunk != node.chunk) from = readChunkBrief(env.chunks, start.chunk);
            bool sameBranch = from.branch == chunk.branch;
            bool foot = sameBranch && ((start.flags >> 8u) & 31u) == 0u && from.previousNode == kNoIndex;
            uint ia = start.place >> 16u;
            uint ib = node.place >> 16u;
            vec4 a0 = push.surfaces.v[ia].toWorld[0];
            vec4 a1 = push.surfaces.v[ia].toWorld[1];
            vec4 a2 = push.surfaces.v[ia].toWorld[2];
            vec4 b0 = a0;
            vec4 b1 = a1;
            vec4 b2 = a2;
            if (ia != ib) {
                b0 = push.surfaces.v[ib].toWorld[0];
                b1 = push.surfaces.v[ib].toWorld[1];
                b2 = push.surfaces.v[ib].toWorld[2];
            }
            uint kind = (node.flags >> 18u) & 255u;
            bool bark = (node.flags & kNodeBark) != 0u && node.radius > 0.0f && kind < table.kindCount &&
                        table.kinds[kind].variantCount > 0u && table.kinds[kind].bark != 0u;
            LoadedSpan s = spanBetween(start, node, sameBranch, foot, a0, a1, a2, b0, b1, b2);
            SpanInstance o = instanceOf(s, node, chunk, bark ? kind : kNoBark);
            writeSpan(i, o);
            if (bark) {
                float thick = max(o.radius0, o.radius1);
                giveKey(i, spanClass(thick), o.center, (o.bits >> 16u) / (0x10000u / kCellBins));
                noteSpan(o.p0, o.b1, o.b2, o.p3, thick);
                addTriangles(trianglesOfBark(kind));
            }
        }
    }
}
