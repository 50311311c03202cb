// Wind: leaves lean the way it blows and flutter about their stalks, which stay where they are. Gusts go over the plants.
#ifndef ESPALIER_RENDER_WIND_GLSL
#define ESPALIER_RENDER_WIND_GLSL
#include "shaders/render/frame.glsl"

// A constant: some devices run both sides of an `if`.
layout(constant_id = kConstantWindy) const bool windy = false;

// Where an arm from the stalk's end is blown to, as long as before; its normal goes with it. hash: of the leaf.
vec3 blown(vec3 arm, inout vec3 normal, vec3 origin, uint hash) {
    float own = float(hash & 1023u) * (6.2831853 / 1024.0);
    vec3 at = origin / frame.unit;
    float along = dot(at, frame.wind) * kGustTurns - frame.windTurns.x;
    float gust = 1.0 - frame.windGusts * (0.5 - 0.5 * sin(along + 0.8 * sin(dot(at, ESPALIER_GUST_PHASE) + frame.gustsFrom)));
    float bend = frame.windBend * gust;
    vec3 push = frame.wind * (bend * (0.7 + 0.3 * sin(frame.windTurns.y + own))) +
                normal * (0.4 * bend * sin(frame.windTurns.z + 3.0 * own));
    float reach = max(length(arm), 1e-9);
    vec3 to = arm + push * reach;
    normal -= arm * (dot(normal, push) / reach);
    return to * (reach / max(length(to), 1e-9));
}
#endif
