// What the code of a rule map is run on, alike by tests/interpreter.comp and by the C++ test: any numbers, by a key, and
// slopes and angles of a place by it.
#ifndef ESPALIER_TESTS_INTERPRETER_CASE_H
#define ESPALIER_TESTS_INTERPRETER_CASE_H
#include "shaders/shared/interpreter.h"

ESPALIER_BEGIN

FN void drawSites(MACHINE_PARAM UintBuf sites, uint firstSite, uint siteCount, u64 key, u64 instanceKey) {
    for (uint j = 0u; j < siteCount; ++j) SET_SLOT(kSlotDraw + j, drawSite(sites.v[firstSite + j], key, instanceKey));
}

FN void giveCase(MACHINE_PARAM RuleMapRef map, u64 key, uint siteCount) {
    resetMachine(MACHINE_ONLY);
    for (uint s = kSlotArg; s < kSlotZero; ++s) SET_SLOT(s, uniformRandom(key, s) * 8.0f - 4.0f);
    vec3 position = vec3(uniformRandom(key, 100u), uniformRandom(key, 101u), uniformRandom(key, 102u));
    vec3 normal = unit3(position - vec3(0.5f));
    vec3 heading = unit3(cross3(normal, vec3(uniformRandom(key, 103u), 0.3f, 0.7f)));
    SET_SLOT(kSlotSlope, atan2Exact(sqrtExact(normal.x * normal.x + normal.z * normal.z), normal.y));
    for (uint i = 0u; i < kMaxDirections; ++i) {
        vec4 d = map.directions[i];
        SET_SLOT(kSlotAngle + i, angleInSurface(heading, normal, vec3(d.x, d.y, d.z)));
    }
    drawSites(MACHINE map.sites, 0u, siteCount, key, key + u64(1u));
}

ESPALIER_END
#endif
