#include "runtime/roof_growth/roof_stages.hpp"

#include <cstddef>

namespace espalier {
namespace {

// Each stage waits for the one before.
constexpr Things kRoofs = 1;
constexpr Kernel kDerive{"roof_growth/derive.comp", kRoofs, kRoofs, kRoofGroup};
constexpr Kernel kRows{"roof_growth/rows.comp", kRoofs, kRoofs, kRoofGroup};
// One pass: on software devices each time stamp wakes all threads, which one house would feel.
constexpr const char* kPass = "roof expand";

Stage deriveStage(const RoofShaders& shaders, const RoofEnv& env, uint32_t first, uint32_t last) {
    Stage stage;
    stage.kernel = kDerive;
    stage.pass = kPass;
    stage.push.set(first);
    stage.native.set(env);
    stage.groups = {{}, shaders.waves, 0, kRoofs};
    stage.constants = shaders.constants;
    stage.bindings = shaders.derive;
    stage.laneBytes = shaders.laneBytes;
    stage.firstWave = first;
    stage.lastWave = last;
    stage.turn = [](Stage& s, uint32_t wave) {
        s.push.as<uint32_t>() = wave;
        s.native.as<RoofEnv>().wave = wave;
        s.groups.offset = wave * sizeof(Wave) + offsetof(Wave, groups);
    };
    return stage;
}

Stage rowsStage(const RoofShaders& shaders, const RoofEnv& env) {
    Stage stage;
    stage.kernel = kRows;
    stage.pass = kPass;
    stage.native.set(env);
    stage.groups = {{}, shaders.status, offsetof(RoofStatus, gridGroups), kRoofs};
    stage.bindings = shaders.rows;
    return stage;
}

}  // namespace

StageList roofStages(const RoofShaders& shaders, const RoofEnv& env, uint32_t first, uint32_t last) {
    StageList list;
    list.push_back(deriveStage(shaders, env, first, last));
    list.push_back(rowsStage(shaders, env));
    return list;
}

}  // namespace espalier
