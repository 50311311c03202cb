// Enters: what each picture's shadows depend on. Leaves: whether they are drawn anew, and how much of them.
#include "runtime/render/shadow_state.hpp"

namespace espalier {
namespace {

constexpr uint32_t kFirst = 2;         // so many changes in a row are no stroke yet
constexpr uint32_t kStrokeFrames = 2;  // some tiles are redrawn in every second picture of a stroke
constexpr uint32_t kPeriod = 8;        // pictures, where all has to be redrawn while something changes in each

ShadowScene withGrowthOf(ShadowScene scene, const ShadowScene& now) {
    scene.growth = now.growth;
    scene.nodes = now.nodes;
    scene.leaves = now.leaves;
    return scene;
}

}  // namespace

bool NearShadows::begin(const ShadowScene& now, const ShadowWish& wish) {
    now_ = now;
    changes_ = now.growth == growthBefore_ ? 0 : changes_ + 1;
    growthBefore_ = now.growth;
    stroke_ = wish.mayLag && changes_ > kFirst;
    coarseNow_ = stroke_ || (wish.mayLag && wish.quick);
    const bool good = drawn_ && now == shown_ && (!coarse_ || coarseNow_);
    behind_ = wish.shadows && (good ? coarse_ : stroke_);
    return wish.shadows && !good;
}

// In a stroke most pictures leave it as it is, some redraw a few of its tiles: what is left follows when growth rests.
NearShadows::Redraw NearShadows::redraw(bool grows, uint64_t bindings) const {
    const bool onlyGrown = drawn_ && withGrowthOf(shown_, now_) == now_;
    const bool inTiles = onlyGrown && kept_ && grows && bindings_ == bindings;
    if (!stroke_) return inTiles ? Redraw::allTiles : Redraw::whole;
    if (inTiles) return changes_ % kStrokeFrames == 0 ? Redraw::fewTiles : Redraw::nothing;
    return onlyGrown && changes_ % kPeriod != 0 ? Redraw::nothing : Redraw::whole;
}

void NearShadows::drewWhole(bool kept, uint64_t bindings) {
    ++whole_;
    shown_ = now_;
    kept_ = kept;
    bindings_ = bindings;
    coarse_ = coarseNow_;
    behind_ |= coarse_;
    drawn_ = true;
}

void NearShadows::drewAllTiles() {
    ++partly_;
    shown_ = now_;
    coarse_ = false;
}

// If they may lag: while houses change in every picture, shadows far away follow in every eighth and when they rest.
bool WideShadows::begin(const ShadowScene& now, bool mayLag) {
    changes_ = now == before_ ? 0 : changes_ + 1;
    before_ = now;
    const bool turned = shown_.sun != now.sun;
    behind_ = mayLag && drawn_ && !turned && changes_ > kFirst && changes_ % kPeriod != 0;
    return !behind_ && (!drawn_ || shown_ != now);
}

void WideShadows::drew(const ShadowScene& now, const glm::mat4& toTexture) {
    shown_ = now;
    toTexture_ = toTexture;
    drawn_ = true;
}

}  // namespace espalier
