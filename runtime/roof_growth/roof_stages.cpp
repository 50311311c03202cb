#include "runtime/roof_growth/roof_stages.hpp"

#include <cstddef>

namespace espalier {
namespace {

// Each wave waits for the one before.
constexpr Things kRoofs = 1;
constexpr Kernel kDerive{"roof_growth/derive.comp", kRoofs, kRoofs, kRoofGroup};

}  // namespace

StageList roofStages(const RoofShaders& shaders, const RoofEnv& env, uint32_t first, uint32_t last) {
    Stage stage;
    stage.kernel = kDerive;
    // One pass: on software devices each time stamp wakes all threads, which one house would feel.
    stage.pass = "roof expand";
    stage.push.set(first);
    stage.native.set(env);
    stage.groups = {{}, shaders.waves, 0, kRoofs};
    stage.constants = shaders.constants;
    stage.firstWave = first;
    stage.lastWave = last;
    stage.turn = [shaders, env](Stage& s, uint32_t wave) {
        const bool odd = (wave & 1) != 0;
        s.push.as<uint32_t>() = wave;
        RoofEnv& now = s.native.as<RoofEnv>();
        now.wave = wave;
        now.shapes = odd ? env.next : env.shapes;
        now.next = odd ? env.shapes : env.next;
        s.groups.offset = wave * sizeof(Wave) + offsetof(Wave, groups);
        s.bindings = shaders.bindings[odd];
    };
    return {std::move(stage)};
}

}  // namespace espalier
