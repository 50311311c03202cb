#include "runtime/pattern/pattern_stages.hpp"

#include <cstddef>

namespace espalier {
namespace {

// Each stage waits for the one before.
constexpr Things kPatterns = 1;
constexpr uint32_t kHashGroups = 64;

Stage& add(StageList& list, const PatternShaders& shaders, const PatternEnv& env, const char* shader,
           const Groups& groups, bool rules = false) {
    Stage& stage = list.emplace_back();
    stage.kernel = {shader, kPatterns, kPatterns, kPatternGroup};
    stage.pass = "patterns";
    stage.push.set(shaders.env);
    stage.native.set(env);
    stage.groups = groups;
    stage.laneBytes = rules ? shaders.laneBytes : 0;
    return stage;
}

}  // namespace

StageList patternStages(const PatternShaders& shaders, const PatternEnv& env) {
    StageList list;
    const auto over = [&](size_t groups) { return Groups{{}, shaders.status, groups, kPatterns}; };
    for (uint32_t w = 0; w < kPatternWavesAhead; ++w) {
        add(list, shaders, env, "pattern/begin.comp", {});
        add(list, shaders, env, "pattern/derive.comp", over(offsetof(PatternStatus, deriveGroups)), true);
        add(list, shaders, env, "pattern/place.comp", over(offsetof(PatternStatus, pieceGroups)), true);
        add(list, shaders, env, "pattern/look.comp", over(offsetof(PatternStatus, pieceGroups)));
        add(list, shaders, env, "pattern/meet.comp", over(offsetof(PatternStatus, pairGroups)));
        add(list, shaders, env, "pattern/decide.comp", over(offsetof(PatternStatus, setGroups))).rounds =
            kPatternRounds;
        add(list, shaders, env, "pattern/go_on.comp", over(offsetof(PatternStatus, shapeGroups)));
    }
    return list;
}

StageList patternHashStages(const PatternShaders& shaders, const PatternEnv& env) {
    StageList list;
    add(list, shaders, env, "pattern/hash.comp", {{kHashGroups, 1, 1}});
    return list;
}

}  // namespace espalier
