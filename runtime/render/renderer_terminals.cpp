// Enters: what the last cull has left. Leaves: draws of leaves and bark in a pass.
#include "runtime/render/renderer_impl.hpp"

namespace espalier {

void RendererImpl::drawTerminals(DrawPass& pass, bool depthOnly) {
    const EmitTable& table = terminals_.table();
    pass.setIndices(terminals_.batches());
    for (uint32_t i = 0; i < table.bucketCount; ++i) {
        const uint32_t b = (i + table.barkBuckets) % table.bucketCount;  // leaves first: much bark lies under them
        const BucketRecord& bucket = table.buckets[b];
        const TerminalMaterial& material = terminals_.data().materials[bucket.material];
        TerminalPush push{};
        push.bucket = b;
        push.firstVertex = bucket.firstVertex;
        push.vertexCount = bucket.vertexCount;
        push.batch = bucket.batch;
        push.baseColor = material.baseColor;
        push.roughness = material.roughness;
        push.alphaCutoff = material.alphaCutoff;
        const uint64_t offset = offsetof(EmitState, draws) + 2ull * b * sizeof(DrawCommand);
        const Binding color{terminals_.baseColor(bucket.material), textureSampler_};
        const Binding normal{terminals_.normalMap(bucket.material), textureSampler_};
        const Binding shadow{shadowMap_, shadowSampler_};
        const bool bark = b < table.barkBuckets;
        const Binding instances(bark ? emit_.spanTexels() : emit_.leafTexels()), meshes(terminals_.vertexTexels()),
            drawn(emit_.drawnTexels());
        if (!depthOnly && bark)
            pass.drawIndexedIndirect(!explained_ && small_[b] ? scene_->barkSmall : scene_->bark, emit_.state(), offset,
                                     2, push, {color, shadow, *frame_, emit_.state(), instances, meshes, drawn});
        else if (!depthOnly && !explained_ && small_[b])
            pass.drawIndexedIndirect(scene_->leafSmall, emit_.state(), offset, 2, push,
                                     {color, shadow, *frame_, emit_.state(), instances, meshes, drawn});
        else if (!depthOnly)
            pass.drawIndexedIndirect(scene_->leaf, emit_.state(), offset, 2, push,
                                     {color, normal, shadow, *frame_, emit_.state(), instances, meshes, drawn});
        else if (bark)
            pass.drawIndexedIndirect(barkDepth_, emit_.state(), offset, 2, push,
                                     {*frame_, emit_.state(), instances, meshes, drawn});
        else if (material.alphaCutoff > 0)
            pass.drawIndexedIndirect(leafCutDepth_, emit_.state(), offset, 2, push,
                                     {color, *frame_, emit_.state(), instances, meshes, drawn});
        else
            pass.drawIndexedIndirect(leafDepth_, emit_.state(), offset, 2, push,
                                     {*frame_, emit_.state(), instances, meshes, drawn});
    }
}

}  // namespace espalier
