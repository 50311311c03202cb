// Enters: growth and a view. Leaves: what is drawn of it, or triangles.
#include "runtime/emit/emit.hpp"

#include <algorithm>
#include <chrono>

#include "runtime/run/at_once.hpp"

namespace espalier {
namespace {

// Far canopies are drawn with fewer, larger leaves: each goes on its own, by its hash, so that nothing pops at once.
constexpr float kWholePixels = 8, kLeastShare = 0.12f;

}  // namespace

Result<Emit> Emit::create(Device& device, const Terminals& terminals) {
    Emit emit;
    emit.device_ = &device;
    if (Status made = assign(emit.bound_, BoundGrowth::create(device, terminals)); !made) return made.failure();
    if (Status made = assign(emit.view_, CulledView::create(device, terminals)); !made) return made.failure();
    if (Status made = assign(emit.tiles_, TileWatch::create(device)); !made) return made.failure();
    if (Status made = assign(emit.triangles_, TriangleWriter::create(device, terminals)); !made) return made.failure();
    return emit;
}

bool Emit::mayBeNative(const EmitInputs& inputs) const {
    return runsAtOnce(*device_, inputs.native, view_.state());
}

Status Emit::bind(Commands& commands, const EmitInputs& inputs) {
    return bound_.bind(commands, inputs, tiles_, view_.counts());
}

Status Emit::cull(Commands& commands, const EmitInputs& inputs, const EmitView& view, std::string_view passName,
                  bool counted) {
    if (Status s = bind(commands, inputs); !s) return s;
    bound_.lookedAt(commands.serial());
    return view_.cull(commands, bound_, view, passName, counted, mayBeNative(inputs));
}

Status Emit::watch(Commands& commands, const EmitView& view) {
    bound_.lookedAt(commands.serial());
    return tiles_.watch(commands, view);
}

EmitView Emit::takeChanges(Commands& commands, const EmitInputs& inputs, uint32_t mostTiles) {
    const bool stands = mayBeNative(inputs) && bound_.stands();
    bound_.lookedAt(commands.serial());
    return tiles_.take(commands, mostTiles, stands);
}

void Emit::forget() {
    bound_.forget();
    tiles_.forget();
}

void Emit::trim(const GrowthView& growth) {
    if (!bound_.trim(growth)) return;
    tiles_.forget();
    view_.drop();
}

EmitStats Emit::stats() const {
    const EmitState& state = view_.counts();
    EmitStats stats;
    stats.drawnTriangles = state.drawnTriangles;
    stats.fullTriangles = state.fullTriangles;
    stats.spans = state.spanCount;
    stats.leaves = state.leafCount;
    stats.overflow = bound_.overflow();
    stats.bound = state.boundItems;
    stats.buckets.assign(state.counts, state.counts + kMaxBuckets);
    return stats;
}

// What full detail draws. milliseconds: what it took once all was bound.
Result<EmitState> Emit::gather(const EmitInputs& inputs, double& milliseconds) {
    Result<Commands> commands = Commands::begin(*device_, "materialise gather");
    if (!commands) return commands.failure();
    EmitView view{};
    view.flags = kFullDetail;
    view.lodPixels = 1;
    const bool native = mayBeNative(inputs);
    Status recorded = native ? bind(*commands, inputs) : cull(*commands, inputs, view, "materialise gather", true);
    if (recorded) recorded = commands->finish();
    if (!recorded) {
        forget();
        return recorded.failure();
    }
    if (!native) {
        device_->collect();
        milliseconds = device_->milliseconds("materialise gather");
        return view_.counts();
    }
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    Result<EmitState> state = view_.cullNow(bound_, view);
    milliseconds = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    return state;
}

Result<EmittedTriangles> Emit::materialise(const EmitInputs& inputs) {
    double gathering = 0;
    Result<EmitState> state = gather(inputs, gathering);
    if (!state) return state.failure();
    Result<EmittedTriangles> out = triangles_.write(bound_, view_, *state, mayBeNative(inputs));
    if (out) out->gatherMilliseconds = gathering;
    return out;
}

EmitView perspectiveView(const glm::mat4& viewProjection, glm::vec3 eye, float pixelScale, float lodPixels) {
    EmitView view = parallelView(viewProjection, pixelScale, lodPixels);
    view.eye = eye;
    view.parallel = 0;
    return view;
}

void thinOut(EmitView& view, float leafPixels) {
    const float coarser = std::max(leafPixels / kWholePixels, 1.0f);
    view.wholePixels = std::max(leafPixels, 1e-3f);
    view.leastShare = kLeastShare / (coarser * coarser);
    view.leastPixels = 0.5f * std::min(coarser, 2.0f);
    if (coarser > 1) view.flags |= kStretches;
}

EmitView parallelView(const glm::mat4& m, float pixelsPerMetre, float lodPixels) {
    EmitView view{};
    auto row = [&](int i) { return glm::vec4(m[0][i], m[1][i], m[2][i], m[3][i]); };
    const glm::vec4 planes[6] = {row(3) + row(0), row(3) - row(0), row(3) + row(1),
                                 row(3) - row(1), row(2),          row(3) - row(2)};
    for (int i = 0; i < 6; ++i) {
        // A plane without a normal (the far one, at infinity) lets everything through.
        float length = glm::length(glm::vec3(planes[i]));
        view.planes[i] = length > 1e-12f ? planes[i] / length : glm::vec4(0, 0, 0, 1);
    }
    view.pixelScale = pixelsPerMetre;
    view.lodPixels = std::max(lodPixels, 1e-3f);
    view.parallel = 1;
    view.leastPixels = 0.5f;
    view.tilePixels = kDepthTile;
    view.wholePixels = kWholePixels;
    view.leastShare = kLeastShare;
    return view;
}

}  // namespace espalier
