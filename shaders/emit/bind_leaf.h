// A loose terminal on its span: an instance in the world, put into its cell. The text of a kernel, and in C++ of a member:
// `push`, `table`, addTriangles(), readLeaf(), spanInstance(), writeLeaf(), bind_item.h and note_change.h are around it.

LoadedSpan spanUnder(SpanInstance o) {
    LoadedSpan s;
    s.span.p0 = o.p0;
    s.span.b1 = o.b1;
    s.span.b2 = o.b2;
    s.span.p3 = o.p3;
    s.normal0 = unpackOct(o.normal0);
    s.normal1 = unpackOct(o.normal1);
    s.radius0 = o.radius0;
    s.radius1 = o.radius1;
    return s;
}

uint variantOf(uint bits, uint hash) {
    KindRecord kind = table.kinds[(bits >> 8u) & 255u];
    return kind.firstVariant + (hash >> 3u) % kind.variantCount;
}
uint trianglesOfLeaf(uint variant) { return table.buckets[table.variants[variant].firstBucket].indexCount / 3u; }

void takeLeaf(uint i) {
    uint bits = push.leafInstances.v[i].bits;
    uint variant = variantOf(bits, push.leafInstances.v[i].hash);
    addTriangles(0u - trianglesOfLeaf(variant));
    noteLeaf(push.leafInstances.v[i].origin, decodeLeafSize(bits & 255u), table.variants[variant].extent);
}

void bindLeaf(uint i) {
    Leaf record = readLeaf(i);
    uint item = push.leafBase + i;
    if (takeKey(item, i < push.leavesBefore)) takeLeaf(i);
    LeafPose pose = unpackLeaf(record.place, record.pose, record.tint);
    bool known = record.node < push.nodeCount && pose.mesh < table.kindCount &&
                 table.kinds[pose.mesh].variantCount > 0u && table.kinds[pose.mesh].bark == 0u;
    if (known) {
        push.leafNext.v[i] = atomicExchange(push.leafHeads.v[record.node], i);
        SpanInstance under = spanInstance(record.node);
        uint hash = leafHash(record);
        KindRecord kind = table.kinds[pose.mesh];
        uint v = kind.firstVariant + (hash >> 3u) % kind.variantCount;
        if (under.reach >= 0.0f) {
            PlacedLeaf leaf = placeLeaf(spanUnder(under), pose, hash, table.variants[v].extent);
            LeafInstance o;
            o.origin = leaf.origin;
            o.axisX = leaf.axisX * leaf.size;
            o.axisY = leaf.axisY * leaf.size;
            o.axisZ = leaf.axisZ * leaf.size;
            o.normal = packOct(leaf.normal);
            o.tint = record.tint;
            o.hash = hash;
            float height = clamp(leaf.height / max(1.1f * leaf.size, 1e-6f), 0.0f, 1.0f);
            o.bits = (record.place & 0xFFFFu) | (((under.bits >> 7u) & 31u) << 16u) | (uint(height * 2047.0f + 0.5f) << 21u);
            writeLeaf(i, o);
            giveKey(item, kLeafClass, o.origin, (hash >> 8u) / (0x1000000u / kCellBins));
            addTriangles(trianglesOfLeaf(v));
            noteLeaf(o.origin, decodeLeafSize(o.bits & 255u), table.variants[v].extent);
        }
    }
}
