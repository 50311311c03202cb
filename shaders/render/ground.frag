#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The meadow under it all, and haze far away.
#include "shaders/render/light.glsl"
#include "shaders/render/meadow.glsl"
#include "shaders/render/sky.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D noise;
layout(set = 0, binding = 4) uniform sampler2D site;
layout(set = 0, binding = 5) uniform sampler2D paving;
layout(location = 0) out vec4 color;

void main() {
    // By the pixel's ray: a place interpolated over kilometres would be a few centimetres off.
    vec2 at = gl_FragCoord.xy * push.rcpSize * 2.0 - 1.0;
    vec3 ray = frame.rayForward + frame.rayRight * at.x - frame.rayUp * at.y;
    float along = (frame.groundLevel - frame.eye.y) / ray.y;
    vec3 position = frame.eye + ray * along;
    vec2 place = position.xz / frame.unit;
    float metres = along * length(ray) / frame.unit;
    vec2 placeX = dFdx(place), placeY = dFdy(place);
    vec3 laid = siteAt(site, place, placeX, placeY);
    Meadow meadow = meadowAt(noise, paving, place, placeX, placeY, metres, laid, max(abs(dFdx(laid.x)), abs(dFdy(laid.x))), true);
    if (explains && frame.view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    if (explains && frame.view != kViewLayer) {
        color = frame.view == kViewNormals ? stored(meadow.normal * 0.5 + 0.5, 0.0) : diagnostic(vec3(0.22), meadow.normal);
        return;
    }
    float facing = max(dot(meadow.normal, frame.sunDirection), 0.0);
    vec3 direct = frame.sunColor * (sunVisibility(position, vec3(0.0, 1.0, 0.0)) * facing) * meadow.base;
    vec3 ambient = meadow.base * skyLight(meadow.normal) * meadow.open;
    // What is far goes over into the land at the horizon.
    float haze = hazeAt(metres);
    color = lit(mix(direct, vec3(0.0), haze), mix(ambient, farLand(ray, 0.0), haze));
}
