#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A meadow: grass and worn earth in patches, blades near by, haze far away.
#include "shaders/render/light.glsl"
#include "shaders/render/sky.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D noise;
layout(location = 0) out vec4 color;

void main() {
    // By the pixel's ray: a place interpolated over kilometres would be a few centimetres off.
    vec2 at = gl_FragCoord.xy * push.rcpSize * 2.0 - 1.0;
    vec3 ray = frame.rayForward + frame.rayRight * at.x - frame.rayUp * at.y;
    float along = (frame.groundLevel - frame.eye.y) / ray.y;
    vec3 position = frame.eye + ray * along;
    vec2 xz = position.xz / frame.unit;
    vec4 broad = texture(noise, xz * (1.0 / 41.0)) * 2.0 - 1.0;
    vec4 near = texture(noise, mat2(0.8, 0.6, -0.6, 0.8) * xz * (1.0 / 5.3)) * 2.0 - 1.0;
    float metres = along * length(ray) / frame.unit;
    // Blades are told apart near by only.
    vec4 fine = vec4(0.0);
    vec2 fineAt = mat2(0.6, -0.8, 0.8, 0.6) * xz * vec2(1.0, 0.7) * (1.0 / 1.1);
    vec2 fineX = dFdx(fineAt);
    vec2 fineY = dFdy(fineAt);
    float share = clamp(1.4 - metres * 0.04, 0.0, 1.0);
    for (bool close = share > 0.0; close; close = false)
        fine = (textureGrad(noise, fineAt, fineX, fineY) * 2.0 - 1.0) * share;

    vec2 slope = near.zw * 0.55 + fine.zw * 0.7;
    vec3 n = normalize(vec3(-slope.x, 1.0, -slope.y));
    float grass = smoothstep(-0.35, 0.25, broad.x + 0.9 * near.x + 0.35 * fine.x + 0.15);
    float blades = clamp(0.5 + 0.6 * fine.y + 0.25 * near.y, 0.0, 1.0);
    vec3 green = push.groundColor * mix(0.42, 1.35, blades);
    green = mix(green, push.groundColor.yyy * vec3(1.5, 1.3, 0.6) * (0.6 + 0.6 * blades),
                clamp(0.25 + 0.7 * broad.y + 0.5 * near.x, 0.0, 0.7));
    vec3 earth = mix(vec3(0.075, 0.055, 0.036), vec3(0.150, 0.114, 0.076), 0.5 + 0.5 * fine.x + 0.2 * near.y);
    vec3 base = mix(earth, green, grass);
    if (explains && frame.view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    if (explains && frame.view != kViewLayer) {
        color = frame.view == kViewNormals ? stored(n * 0.5 + 0.5, 0.0) : diagnostic(vec3(0.22), n);
        return;
    }
    float facing = max(dot(n, frame.sunDirection), 0.0);
    vec3 direct = frame.sunColor * (sunVisibility(position, vec3(0.0, 1.0, 0.0)) * facing) * base;
    vec3 ambient = base * skyLight(n);
    // What is far goes over into the land at the horizon.
    float haze = 1.0 - exp(-metres * (1.0 / 420.0));
    color = lit(mix(direct, vec3(0.0), haze), mix(ambient, farLand(ray, 0.0), haze));
}
