// The walk as Buron 2015 §5 prints it, for comparison: straight lines in the image, jumps from link texel to
// inner texel, headings turned by the angle between the borders' tangents. Lengths become texels by the chart's
// mean scale. It uses the same WalkState, but Walk::direction holds the heading in UV: (cos, sin, 0).
#ifndef ESPALIER_SHARED_PAPER_WALK_H
#define ESPALIER_SHARED_PAPER_WALK_H
#include "shaders/shared/walk.h"

ESPALIER_BEGIN

// A link texel's pointer: the inner texel that it refers to and the turn of headings that jump there.
struct PaperLink {
    bool found;
    bool open;          // the border leads nowhere
    uint place;
    vec2 uv;            // centre of the texel referred to
    float turnCos, turnSin;
};

FN uint paperTexelBits(SurfaceBuf surfaces, uint instance, uint level, ivec2 at) {
    int size = int(surfaces.v[instance].levels[level].size);
    if (at.x < 0 || at.y < 0 || at.x >= size || at.y >= size) return 0u;
    return readTexel(surfaces, instance, level, texelIndex(uint(size), uint(at.x), uint(at.y))).bits;
}
FN bool paperInner(uint bits, uint chart) { return texelClass(bits) == kTexelInner && texelChart(bits) == chart; }
FN bool paperLinking(uint bits, uint chart) { return texelClass(bits) > kTexelInner && texelChart(bits) == chart; }
FN ivec2 paperTexel(vec2 uv, float fsize) {
    return ivec2(int(floorExact(limited(uv.x * fsize, -2.0f, fsize + 1.0f))),
                 int(floorExact(limited(uv.y * fsize, -2.0f, fsize + 1.0f))));
}
FN vec2 paperCentre(ivec2 at, float fsize) {
    return vec2(float(at.x) + 0.5f, float(at.y) + 0.5f) * rcpExact(fsize);
}

// The inner texel of `chart` nearest to uv within a ring of `at`; (-9, -9): none.
FN ivec2 paperNearestInner(SurfaceBuf surfaces, uint instance, uint level, uint chart, vec2 uv, ivec2 at) {
    float fsize = float(surfaces.v[instance].levels[level].size);
    ivec2 found = ivec2(-9, -9);
    float best = 1e30f;
    for (int i = 0; i < 9; ++i) {
        ivec2 q = ivec2(at.x + i % 3 - 1, at.y + i / 3 - 1);
        vec2 d = paperCentre(q, fsize) - uv;
        if (dot2(d, d) < best && paperInner(paperTexelBits(surfaces, instance, level, q), chart)) {
            best = dot2(d, d);
            found = q;
        }
    }
    return found;
}

// Is `at` an indirection texel as the paper has them: outside of the chart and next to an inner texel of it? (Our
// gutters are wider; their outer texels are background here.)
FN bool paperIndirection(SurfaceBuf surfaces, uint instance, uint level, uint chart, ivec2 at) {
    if (!paperLinking(paperTexelBits(surfaces, instance, level, at), chart)) return false;
    float fsize = float(surfaces.v[instance].levels[level].size);
    return paperNearestInner(surfaces, instance, level, chart, paperCentre(at, fsize), at).x >= 0;
}

// The pointer of the link texel `at`: by the nearest of the crossings listed around it.
FN PaperLink paperLinkOf(SurfaceBuf surfaces, uint instance, uint level, uint chart, ivec2 at) {
    uint size = surfaces.v[instance].levels[level].size;
    float fsize = float(size);
    vec2 centre = paperCentre(at, fsize);
    uint nearest = kNoIndex;
    float best = 1e30f;
    float along = 0.0f;
    for (int i = 0; i < 9; ++i) {
        int x = at.x + i % 3 - 1;
        int y = at.y + i / 3 - 1;
        if (x < 0 || y < 0 || x >= int(size) || y >= int(size)) continue;
        uint head = readHead(surfaces, instance, level, texelIndex(size, uint(x), uint(y)));
        for (uint k = 0u; k < (head & 0xFFu); ++k) {
            uint index = surfaces.v[instance].levels[level].crossingRefs.v[(head >> 8u) + k];
            vec2 a = surfaces.v[instance].crossings.v[index].a;
            vec2 e = surfaces.v[instance].crossings.v[index].b - a;
            float lambda = limited(dot2(centre - a, e) * rcpExact(larger(dot2(e, e), 1e-30f)), 0.0f, 1.0f);
            vec2 off = a + e * lambda - centre;
            if (dot2(off, off) < best && (surfaces.v[instance].crossings.v[index].flags >> 16u) == chart) {
                best = dot2(off, off);
                nearest = index;
                along = lambda;
            }
        }
    }
    PaperLink link = {};
    link.found = false;
    link.open = false;
    link.place = 0u;
    link.uv = centre;
    link.turnCos = 1.0f;
    link.turnSin = 0.0f;
    if (nearest == kNoIndex) return link;
    Crossing c = surfaces.v[instance].crossings.v[nearest];
    if ((c.flags & 3u) == kCrossingOpen) {
        link.open = true;
        return link;
    }
    uint toInstance = (c.target >> 16u) == 0xFFFFu ? instance : c.target >> 16u;
    uint toChart = c.target & 0xFFFFu;
    uint coarsest = surfaces.v[toInstance].charts.v[toChart].coarsestLevel;
    uint toLevel = level < coarsest ? level : coarsest;
    float toSize = float(surfaces.v[toInstance].levels[toLevel].size);
    vec2 e1 = c.b - c.a;
    vec2 e2 = c.tb - c.ta;
    vec2 to = c.ta + e2 * along;
    ivec2 inner = paperNearestInner(surfaces, toInstance, toLevel, toChart, to, paperTexel(to, toSize));
    float k = rsqrtExact(larger(dot2(e1, e1) * dot2(e2, e2), 1e-36f));
    link.found = inner.x >= 0;
    link.place = (toInstance << 16u) | toChart;
    link.uv = paperCentre(inner, toSize);
    link.turnCos = dot2(e1, e2) * k;
    link.turnSin = cross2(e1, e2) * k;
    return link;
}

FN vec3 paperPosition(SurfaceBuf surfaces, uint place, uint level, vec2 uv) {
    uint instance = place >> 16u;
    uint coarsest = surfaces.v[instance].charts.v[place & 0xFFFFu].coarsestLevel;
    uint at = level < coarsest ? level : coarsest;
    return surfaces.v[instance].levels[at].texels.v[texelAt(surfaces.v[instance].levels[at].size, uv)].position;
}

// The best link for a jump by way of the link texel p0 (§5.1).
FN PaperLink paperBestLink(SurfaceBuf surfaces, uint instance, uint level, uint chart, vec2 from, vec2 at) {
    float fsize = float(surfaces.v[instance].levels[level].size);
    ivec2 p0 = paperTexel(at, fsize);
    PaperLink best = paperLinkOf(surfaces, instance, level, chart, p0);
    ivec2 near1 = paperNearestInner(surfaces, instance, level, chart, at, p0);
    ivec2 current = paperTexel(from, fsize);
    if (near1.x < 0 || (near1.x == current.x && near1.y == current.y)) return best;
    uint place = (instance << 16u) | chart;
    vec3 here = paperPosition(surfaces, place, level, from);
    vec3 reference = unit3(paperPosition(surfaces, place, level, paperCentre(near1, fsize)) - here);
    float bestCosine = -2.0f;
    for (int i = 0; i < 9; ++i) {
        ivec2 q = ivec2(near1.x + i % 3 - 1, near1.y + i / 3 - 1);
        if (!paperIndirection(surfaces, instance, level, chart, q)) continue;
        PaperLink link = paperLinkOf(surfaces, instance, level, chart, q);
        if (!link.found) continue;
        float cosine = dot3(reference, unit3(paperPosition(surfaces, link.place, level, link.uv) - here));
        if (cosine > bestCosine) {
            bestCosine = cosine;
            best = link;
        }
    }
    return best;
}

FN void paperRefresh(SurfaceBuf surfaces, uint level, INOUT(WalkState) w) {
    uint instance = w.walk.place >> 16u;
    uint chart = w.walk.place & 0xFFFFu;
    w.orientation = surfaces.v[instance].charts.v[chart].orientation;
    uint coarsest = surfaces.v[instance].charts.v[chart].coarsestLevel;
    w.level = level < coarsest ? level : coarsest;
    Patch p = {};
    if (patchAt(surfaces, instance, w.level, chart, w.orientation, w.walk.uv, p)) {
        standOn(w, p, rcpExact(float(surfaces.v[instance].levels[w.level].size)));
    }
}

// As resumeWalk, but Walk::direction is the heading in UV.
FN bool resumePaperWalk(SurfaceBuf surfaces, uint level, Walk walk, OUT(WalkState) w) {
    bool found = resumeWalk(surfaces, level, walk, w);
    w.walk.direction = walk.direction;
    return found;
}

// As startWalk: `direction` is in object space, the heading is its image under the inverse Jacobian.
FN bool startPaperWalk(SurfaceBuf surfaces, uint level, uint place, vec2 uv, vec3 direction, OUT(WalkState) w) {
    bool found = startWalk(surfaces, level, place, uv, direction, w);
    vec2 rate = tangentRate(w.du, w.dv, w.walk.direction);
    rate = rate * rsqrtExact(dot2(rate, rate));
    w.walk.direction = vec3(rate.x, rate.y, 0.0f);
    return found;
}

FN void rotatePaperHeading(INOUT(WalkState) w, float angle) {
    float s = 0.0f;
    float c = 0.0f;
    sinCosExact(angle, s, c);
    vec3 d = w.walk.direction;
    w.walk.direction = vec3(d.x * c - d.y * s, d.x * s + d.y * c, 0.0f);
}

// The heading in object space, unit: the paper's walk as headingTo and the nodes' tangents want it.
FN vec3 paperHeading3(WalkState w) { return unit3(w.du * w.walk.direction.x + w.dv * w.walk.direction.y); }

// The four cases of §5. Events as walkAdvance: kWalkSeam after a jump with length left to walk.
FN uint paperAdvance(SurfaceBuf surfaces, uint level, INOUT(WalkState) w, INOUT(float) remaining,
                     OUT(vec3) jointNormal) {
    uint instance = w.walk.place >> 16u;
    uint chart = w.walk.place & 0xFFFFu;
    uint tries = (w.flags & 0xFFu) + 1u;
    float scale = surfaces.v[instance].scale;
    float perUv = surfaces.v[instance].charts.v[chart].metresPerUv * scale;
    float fsize = float(surfaces.v[instance].levels[w.level].size);
    remaining = inRange(remaining, kWalkMaxRadii * surfaces.v[instance].radius * scale);
    jointNormal = w.normal;
    vec2 heading = vec2(w.walk.direction.x, w.walk.direction.y);
    vec2 from = w.walk.uv;
    vec2 delta = heading * divExact(remaining, perUv);
    vec2 to = from + delta;
    uint bits = paperTexelBits(surfaces, instance, w.level, paperTexel(to, fsize));
    if (paperInner(bits, chart)) {   // case 1
        w.walk.uv = to;
        w.walk.arc = w.walk.arc + remaining;
        remaining = 0.0f;
        paperRefresh(surfaces, level, w);
        jointNormal = w.normal;
        w.flags = 0u;
        return kWalkDone;
    }
    float fraction = 1.0f;
    bool linking = paperIndirection(surfaces, instance, w.level, chart, paperTexel(to, fsize));
    if (!linking) {   // cases 3 and 4: halve the segment until a link texel is met
        float low = 0.0f;
        float high = 1.0f;
        for (uint i = 0u; i < 16u && !linking; ++i) {
            fraction = 0.5f * (low + high);
            ivec2 middle = paperTexel(from + delta * fraction, fsize);
            linking = paperIndirection(surfaces, instance, w.level, chart, middle);
            if (paperInner(paperTexelBits(surfaces, instance, w.level, middle), chart)) low = fraction;
            else high = fraction;
        }
    }
    if (!linking || tries > kWalkMaxTries) {
        w.flags = 0u;
        return kWalkLost;
    }
    PaperLink link = paperBestLink(surfaces, instance, w.level, chart, from, from + delta * fraction);
    float walked = remaining * fraction;
    if (!link.found) {
        w.flags = 0u;
        return link.open ? kWalkOpen : kWalkLost;
    }
    w.walk.place = link.place;   // case 2
    w.walk.uv = link.uv;
    w.walk.direction = vec3(heading.x * link.turnCos - heading.y * link.turnSin,
                            heading.x * link.turnSin + heading.y * link.turnCos, 0.0f);
    w.walk.arc = w.walk.arc + walked;
    remaining = remaining - walked;
    paperRefresh(surfaces, level, w);
    jointNormal = w.normal;
    bool done = !(remaining > 0.0f);
    w.flags = done ? 0u : tries;
    return done ? kWalkDone : kWalkSeam;
}

// Walks `length` metres. Returns kWalkDone, kWalkOpen or kWalkLost.
FN uint paperStep(SurfaceBuf surfaces, uint level, INOUT(WalkState) w, float length) {
    float remaining = length;
    vec3 jointNormal = vec3(0.0f);
    uint event = kWalkRetry;
    while (walkGoesOn(event)) {
        event = paperAdvance(surfaces, level, w, remaining, jointNormal);
    }
    return event;
}

ESPALIER_END
#endif
