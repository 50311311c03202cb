// The light on leaves of few pixels, found at their vertices or before them.
#ifndef ESPALIER_RENDER_LEAF_SMALL_LIGHT_GLSL
#define ESPALIER_RENDER_LEAF_SMALL_LIGHT_GLSL
#include "shaders/render/leaf_light.glsl"
#include "shaders/render/leaf_vertex.glsl"

// Of a texel's colour c, c * own + dot(c, kLeafWeights) * turned + mirrored is the leaf's.
struct SmallLeaf {
    vec3 own, turned, mirrored;
    float share;    // of the light that is the sky's
    float pictured; // added to v: the atlas holds the upper sides in its upper half, their paler backs below
};

// v.normal: unit.
SmallLeaf smallLeaf(TerminalPush push, LeafVertex v) {
    uint kind = (v.instance.bits >> 8u) & 255u;
    vec3 eye = normalize(frame.eye - v.position);
    bool back = shippedMesh(kind) != kMeshTuft && dot(v.normal, eye) < 0.0;
    vec3 face = back ? -v.normal : v.normal;
    float visible = sunVisibility(v.position, dot(face, frame.sunDirection) > 0.0 ? face : -face);
    LeafLight light = leafLight(face, eye, v.open, visible, kind, back);
    LeafTint tint = leafTint(push.baseColor.rgb, v.instance.tint, v.instance.hash, v.patchTone, kind);
    vec3 all = (light.sun + light.sky) * frame.exposure;
    SmallLeaf o;
    o.own = tint.own * all;
    o.turned = tint.turned * all;
    o.mirrored = (light.sunMirror + light.skyMirror) * frame.exposure;
    o.share = kLeafShade * dot(light.sky, kLeafWeights) / max(dot(light.sun + light.sky, kLeafWeights), 1e-5);
    o.pictured = back && showsBack(kind) ? 0.5 : 0.0;
    return o;
}
#endif
