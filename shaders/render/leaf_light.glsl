// How a leaf takes the light: two-sided, lit through, waxy above. Near leaves ask at each pixel, small ones at each
// vertex.
#ifndef ESPALIER_RENDER_LEAF_LIGHT_GLSL
#define ESPALIER_RENDER_LEAF_LIGHT_GLSL
#include "shaders/render/light.glsl"

// Of a texel's colour c: c * own + dot(c, kLeafWeights) * turned is the leaf's.
struct LeafTint {
    vec3 own, turned;
};
const vec3 kLeafWeights = vec3(0.3, 0.6, 0.1);

// tint: Leaf::tint; hash: of the leaf; patchTone: -1 to 1, whole patches differ as plants do.
LeafTint leafTint(vec3 baseColor, uint tint, uint hash, float patchTone, uint kind) {
    float age = float(tint >> 24u) * (1.0 / 255.0);
    vec3 root = vec3((tint >> 19u) & 31u, (tint >> 13u) & 63u, (tint >> 8u) & 31u) / vec3(31.0, 63.0, 31.0);
    vec3 wanted = root * root;
    float a = float(hash & 255u) * (1.0 / 255.0);
    float b = float((hash >> 8u) & 255u) * (1.0 / 255.0);
    // The grammar's colour turns the texture's hue; its brightness stays the texture's.
    float strong = max(wanted.x, max(wanted.y, wanted.z)) - min(wanted.x, min(wanted.y, wanted.z));
    float turn = 0.5 * min(1.0, 3.0 * strong);
    // From old, dark and bluish to young, light and yellow.
    const vec3 young = vec3(1.22, 1.14, 0.50);
    const vec3 old = vec3(0.30, 0.42, 0.36);
    vec3 grown = mix(old, young, clamp(0.04 + 0.88 * age * age + 0.30 * (a - 0.5) + 0.20 * patchTone, 0.0, 1.0)) * (0.72 + 0.56 * b);
    // Now and then one withers.
    float withered = step(0.985, float((hash >> 16u) & 255u) * (1.0 / 255.0)) * (1.0 - age);
    grown = mix(grown, vec3(2.6, 1.5, 0.45), withered);
    // What somebody chose keeps its hue, and is darker or lighter by age.
    if (kind >= kOwnMeshes) grown = vec3(clamp(1.7 * dot(grown, kLeafWeights), 0.55, 1.25));
    if (shippedMesh(kind) == kMeshBlossom) grown = vec3(0.85 + 0.3 * b);
    LeafTint o;
    o.own = baseColor * grown * (1.0 - turn);
    // Age makes a grammar's colour darker or lighter, and leaves its hue.
    o.turned = dot(grown, kLeafWeights) * turn * wanted / max(dot(wanted, kLeafWeights), 1e-3) * dot(baseColor, kLeafWeights);
    return o;
}
vec3 leafColor(LeafTint tint, vec3 texel) { return texel * tint.own + dot(texel, kLeafWeights) * tint.turned; }

// So much of a leaf's light from the sky is dimmed by occlusion: what lets light through darkens what is behind it less
// than distances tell.
const float kLeafShade = 0.7;

// Light that the leaf's colour scales, and light that its wax mirrors, from the sun and from the sky.
struct LeafLight {
    vec3 sun, sunMirror, sky, skyMirror;
};

// face: the normal of the side that is seen; eye: towards it; open: share of the sky that is seen; visible: of the sun.
LeafLight leafLight(vec3 face, vec3 eye, float open, float visible, uint kind, bool back) {
    bool leaf = shippedMesh(kind) != kMeshPebble;
    vec3 sun = frame.sunDirection;
    float side = dot(face, sun);
    float facing = max(side, 0.0);
    vec3 falling = frame.sunColor * visible * (0.16 + 0.84 * open);
    LeafLight o;
    o.sun = falling * facing;
    o.sunMirror = vec3(0.0);
    o.sky = skyLight(face);
    if (leaf) {
        // What falls on the other side comes through, through green yellower, of the sun's light and of the sky's.
        vec3 through = kind >= kOwnMeshes || kind == kMeshBlossom ? vec3(1.2) : vec3(1.5, 1.35, 0.45);
        o.sun += falling * through * (max(-side, 0.0) * 0.55 + 0.06);
        o.sunMirror = falling * (gloss(face, eye, sun, 0.42) * facing * (back ? 0.3 : 1.0));
        o.sky += 0.40 * through * skyLight(-face);
        // Leaves about it are lit, too, and throw back what is green and warm; what looks up sees less of them.
        o.sky *= vec3(1.24, 1.22, 1.04) * (0.86 + 0.42 * face.y);
    }
    // In the shade the sky's mirror image on the wax is what tells leaves apart.
    float edge = 1.0 - max(dot(face, eye), 0.0);
    float wax = (0.04 + 0.20 * edge * edge * edge) * (back || !leaf ? 0.3 : 1.0);
    float reached = open * (0.60 + 0.40 * open);
    o.sky *= reached;
    o.skyMirror = skyLight(reflect(-eye, face)) * wax * reached;
    return o;
}
#endif
