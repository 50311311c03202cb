#version 460
// Runs a rule map's whole code once per item over random inputs; the host does the same.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/interpreter.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
    RuleMapBuf map;
    FloatBuf results;
    uint count;
    uint words;
    uint siteCount;
    uint repeats;
};

void main() {
    uint i = itemIndex();
    if (i >= count) return;
    u64 key = u64(i);
    resetMachine(MACHINE_ONLY);
    for (uint s = kSlotArg; s < kSlotZero; ++s) SLOT(s) = uniformRandom(key, s) * 8.0f - 4.0f;
    ScopePlace place;
    place.position = vec3(uniformRandom(key, 100u), uniformRandom(key, 101u), uniformRandom(key, 102u));
    place.normal = unit3(place.position - vec3(0.5f));
    place.heading = unit3(cross3(place.normal, vec3(uniformRandom(key, 103u), 0.3f, 0.7f)));
    place.texCoord = vec2(0.25f, 0.75f);
    place.curvature = 2.0f;
    place.lowest = 0.25f;
    givePlace(MACHINE map.v[0], kInputSlope | 15u, place);
    drawSites(MACHINE map.v[0].sites, 0u, siteCount, key, key + u64(1u));
    CodeRange range;
    range.first = 0u;
    range.count = words;
    for (uint r = 0u; r < repeats; ++r) runCode(MACHINE map.v[0].code, range);
    for (uint r = 0u; r < kRegisters; ++r) results.v[i * (kRegisters + 2u) + r] = SLOT(r);
    results.v[i * (kRegisters + 2u) + kRegisters] = SLOT(kSlotAngle);
    results.v[i * (kRegisters + 2u) + kRegisters + 1u] = SLOT(kSlotSlope);
}
