// Enters: what the last cull has left. Leaves: leaves and ribbons lit, draws of leaves and bark in a pass.
#include <algorithm>
#include <optional>

#include "runtime/gpu/color_texture.hpp"
#include "runtime/render/renderer.hpp"

namespace espalier {
namespace {

TerminalPush pushOf(const Terminals& terminals, uint32_t b) {
    const BucketRecord& bucket = terminals.table().buckets[b];
    const TerminalMaterial& material = terminals.data().materials[bucket.material];
    TerminalPush push{};
    push.bucket = b;
    push.firstVertex = bucket.firstVertex;
    push.vertexCount = bucket.vertexCount;
    push.batch = bucket.batch;
    push.baseColor = material.baseColor;
    push.roughness = material.roughness;
    push.alphaCutoff = material.alphaCutoff;
    return push;
}

}  // namespace

bool Renderer::canBeLit(uint32_t bucket) const {
    const TerminalTable& table = terminals_.table();
    const uint32_t corners = table.buckets[bucket].vertexCount;
    return small_[bucket] && corners <= kLitVertices && corners >= (bucket < table.barkBuckets ? kRibbonVertices : 3u);
}

Renderer::ScenePrograms::Lit& Renderer::litPrograms(ScenePrograms& programs, uint32_t bucket) const {
    const TerminalTable& table = terminals_.table();
    return bucket < table.barkBuckets ? programs.litBark : programs.litLeaves[table.buckets[bucket].vertexCount - 3];
}

Status Renderer::makeLit(ScenePrograms& programs) const {
    const TerminalTable& table = terminals_.table();
    for (uint32_t b = 0; b < table.buckets.size(); ++b) {
        if (!canBeLit(b) || litPrograms(programs, b).light) continue;
        const bool bark = b < table.barkBuckets;
        ScenePrograms::Lit& lit = litPrograms(programs, b);
        std::vector<SpecConstant> constants = constantsOf(Shading::quick, holdsRoots(device_));
        constants.push_back({kConstantCorners, table.buckets[b].vertexCount});
        std::vector<SpecConstant> lighting = constants;
        lighting.push_back({kConstantWindy, now_.pass.windy ? 1u : 0u});
        const Status drawn = bark ? makeSceneProgram(lit.draw, "lit bark", "render/bark_lit.vert",
                                                     "render/bark_small_single.frag", constants, Blend::none)
                                  : makeSceneProgram(lit.draw, "lit leaf", "render/leaf_lit.vert",
                                                     "render/leaf_lit.frag", constants, Blend::none);
        if (!drawn) return drawn;
        Result<Program> made = Program::compute(
            device_, bark ? "render/light_ribbons.comp" : "render/light_leaves.comp", {.constants = lighting});
        if (!made) return made.failure();
        lit.light = std::move(*made);
    }
    return Done{};
}

// In moving pictures on software devices, which shade vertices in one thread, what has three or four vertices is lit
// before it is drawn, in all threads, and once instead of at each vertex.
Status Renderer::lightTerminals(Commands& commands) {
    const EmitState* known = emit_.knownState();
    const uint64_t bytes = known ? std::max(known->spanCount + known->leafCount, 1u) * 8ull * kLitWords : 0;
    const DeviceInfo& info = device_.info();
    const uint64_t room = bytes + bytes / 4 / 16 * 16, most = 16ull * info.limits.maxTexelBufferElements;
    now_.lit = isQuick(now_.shading) && now_.plain && known && room <= std::min<uint64_t>(info.maxBufferBytes, most);
    if (!now_.lit) return Done{};
    if (!litTerminals_ || litTerminals_.size() < bytes) {
        Status made =
            makeTexels(device_, "lit terminals", room, VK_FORMAT_R32G32B32A32_UINT, litTerminals_, litTexels_);
        if (!made) return made;
    }
    commands.barrier(Use::vertex, Use::compute);
    Pass pass(commands, "light");
    const Binding shadow{shadowMap_, shadowSampler_};
    for (uint32_t b = 0; b < terminals_.table().buckets.size(); ++b) {
        if (!isLit(b)) continue;
        const bool bark = b < terminals_.table().barkBuckets;
        LightPush push{pushOf(terminals_, b), {reinterpret_cast<uint64_t*>(litTerminals_.address())}};
        const Binding instances(bark ? emit_.spanTexels() : emit_.leafTexels());
        pass.dispatchItems(
            litPrograms(*now_.scene, b).light, known->counts[b], push,
            {shadow, *now_.frame, emit_.state(), instances, terminals_.vertexTexels(), emit_.drawnTexels()});
    }
    pass.barrier(Use::compute, Use::vertex);
    return Done{};
}

void Renderer::drawTerminals(DrawPass& pass, bool depthOnly) {
    const TerminalTable& table = terminals_.table();
    const EmitState* known = emit_.knownState();
    pass.setIndices(terminals_.batches());
    const uint32_t count = uint32_t(table.buckets.size());
    for (uint32_t i = 0; i < count; ++i) {
        const uint32_t b = (i + table.barkBuckets) % count;  // leaves first: much bark lies under them
        if (known && known->counts[b] == 0) continue;
        const bool bark = b < table.barkBuckets;
        if (!depthOnly && faintLast(b)) continue;
        // A software device begins with what comes before a time stamp, in all threads, while one sets up the rest.
        std::optional<Pass> part;
        if (known && !depthOnly) part.emplace(pass.commands(), bark ? "draw bark" : "draw leaves");
        const uint32_t material = table.buckets[b].material;
        const TerminalPush push = pushOf(terminals_, b);
        const uint64_t offset = offsetof(EmitState, draws) + 2ull * b * sizeof(DrawCommand);
        const Binding color{terminals_.baseColor(material), isQuick(now_.shading) ? quickSampler_ : textureSampler_};
        const Binding normal{terminals_.normalMap(material), textureSampler_};
        const Binding shadow{shadowMap_, shadowSampler_};
        const Binding instances(bark ? emit_.spanTexels() : emit_.leafTexels()), meshes(terminals_.vertexTexels()),
            drawn(emit_.drawnTexels());
        if (!depthOnly && isLit(b))
            pass.drawIndexedIndirect(litPrograms(*now_.scene, b).draw, emit_.state(), offset, 2, push,
                                     {color, shadow, *now_.frame, emit_.state(), litTexels_});
        else if (!depthOnly && bark)
            pass.drawIndexedIndirect(now_.plain && small_[b] ? now_.scene->barkSmall : now_.scene->bark, emit_.state(),
                                     offset, 2, push,
                                     {color, shadow, *now_.frame, emit_.state(), instances, meshes, drawn});
        else if (!depthOnly && now_.plain && small_[b])
            pass.drawIndexedIndirect(now_.scene->leafSmall, emit_.state(), offset, 2, push,
                                     {color, shadow, *now_.frame, emit_.state(), instances, meshes, drawn});
        else if (!depthOnly)
            pass.drawIndexedIndirect(now_.scene->leaf, emit_.state(), offset, 2, push,
                                     {color, normal, shadow, *now_.frame, emit_.state(), instances, meshes, drawn});
        else if (bark)
            pass.drawIndexedIndirect(now_.depths->bark, emit_.state(), offset, 2, push,
                                     {*now_.frame, emit_.state(), instances, meshes, drawn});
        else if (push.alphaCutoff > 0)
            pass.drawIndexedIndirect(now_.depths->leafCut, emit_.state(), offset, 2, push,
                                     {color, *now_.frame, emit_.state(), instances, meshes, drawn});
        else
            pass.drawIndexedIndirect(now_.depths->leaf, emit_.state(), offset, 2, push,
                                     {*now_.frame, emit_.state(), instances, meshes, drawn});
    }
}

void Renderer::drawFaint(DrawPass& pass) const {
    if (!now_.faint) return;
    const EmitState* known = emit_.knownState();
    pass.setIndices(terminals_.batches());
    for (uint32_t b = 0; b < terminals_.table().barkBuckets; ++b) {
        if (!faintLast(b) || (known && known->counts[b] == 0)) continue;
        const TerminalPush push = pushOf(terminals_, b);
        const Binding color{terminals_.baseColor(terminals_.table().buckets[b].material), textureSampler_};
        pass.drawIndexedIndirect(now_.scene->barkFaint, emit_.state(),
                                 offsetof(EmitState, draws) + 2ull * b * sizeof(DrawCommand), 2, push,
                                 {color,
                                  {shadowMap_, shadowSampler_},
                                  *now_.frame,
                                  emit_.state(),
                                  Binding(emit_.spanTexels()),
                                  terminals_.vertexTexels(),
                                  emit_.drawnTexels()});
    }
}

}  // namespace espalier
