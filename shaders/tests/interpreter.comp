#version 460
// Runs a rule map's whole code once per item over random inputs; the host does the same.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/tests/interpreter_case.h"

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
    giveCase(MACHINE map.v[0], u64(i), siteCount);
    CodeRange range;
    range.first = 0u;
    range.count = words;
    for (uint r = 0u; r < repeats; ++r) runCode(MACHINE map.v[0].code, range);
    for (uint r = 0u; r < kRegisters; ++r) results.v[i * (kRegisters + 2u) + r] = SLOT(r);
    results.v[i * (kRegisters + 2u) + kRegisters] = SLOT(kSlotAngle);
    results.v[i * (kRegisters + 2u) + kRegisters + 1u] = SLOT(kSlotSlope);
}
