#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A studio's floor: a disc of one colour that goes over into the horizon's colour all around.
#include "shaders/render/light.glsl"
#include "shaders/render/sky.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(location = 0) out vec4 color;

const vec3 kFloor = vec3(0.205, 0.200, 0.192);

void main() {
    // By the pixel's ray, as ground.frag.
    vec2 at = gl_FragCoord.xy * push.rcpSize * 2.0 - 1.0;
    vec3 ray = frame.rayForward + frame.rayRight * at.x - frame.rayUp * at.y;
    vec3 position = frame.eye + ray * ((frame.groundLevel - frame.eye.y) / ray.y);
    const vec3 up = vec3(0.0, 1.0, 0.0);
    if (explains && frame.view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    if (explains && frame.view != kViewLayer) {
        color = frame.view == kViewNormals ? stored(up * 0.5 + 0.5, 0.0) : diagnostic(vec3(0.22), up);
        return;
    }
    vec3 direct = frame.sunColor * (sunVisibility(position, up) * max(frame.sunDirection.y, 0.0)) * kFloor;
    vec3 backdrop = skyColor(normalize(vec3(ray.x, 0.0, ray.z)));
    float away = smoothstep(0.25, 1.0, distance(position.xz, frame.studioAt) / frame.studioRadius);
    // A backdrop is no place that could be shaded by what stands before it.
    color = lit(mix(direct, vec3(0.0), away), mix(kFloor * skyLight(up), backdrop, away));
    color.a *= 1.0 - away;
}
