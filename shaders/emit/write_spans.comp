#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Writes the seen spans as instances, each bucket's together.
#include "shaders/emit/emit_inputs.glsl"
#include "shaders/emit/span_thinning.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;

#include "shaders/emit/shown_depth.glsl"

void main() {
    uint k = itemIndex();
    if (k >= push.state.v[0].kept[0]) return;
    uint i = push.kept.v[k].item;
    uint bucket = classBucket(push.kept.v[k].word);
    uint place = classPlace(push.kept.v[k].word);
    if (place >= push.state.v[0].counts[bucket]) return;
    LoadedSpan s = loadSpan(push.nodes, push.chunks, push.surfaces, i);
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
    o.rise = kBarkRise;
    float fade = 1.0;
    if ((view.flags & kFullDetail) == 0u) {
        // Thinner than it can be drawn: drawn at that width, but fainter.
        vec3 center = (s.span.p0 + s.span.p3) * 0.5;
        float pixels = view.pixelScale / (view.parallel != 0u ? 1.0 : max(distance(view.eye, center), 1e-6));
        float thin = min(max(s.radius0, s.radius1) * pixels / view.leastPixels, 1.0);
        o.radius0 = max(s.radius0, view.leastPixels / pixels * min(s.radius0 / max(s.radius1, 1e-9), 1.0));
        o.radius1 = max(s.radius1, view.leastPixels / pixels * min(s.radius1 / max(s.radius0, 1e-9), 1.0));
        fade = spanFade(thin, push.chunks.v[push.nodes.v[i].chunk].key);
    }
    uint kind = (push.nodes.v[i].flags >> 18u) & 255u;
    uint lod = bucket - table.variants[table.kinds[kind].firstVariant].firstBucket;
    o.bits = lod | shownDepth(i) | (s.tip ? 256u : 0u) | (uint(fade * 65535.0 + 0.5) << 16u);
    push.spanInstances.v[push.state.v[0].starts[bucket] + place] = o;
}
