// Enters: grids of cells and a view. Leaves: draws. One kernel looks at grids, one at the rows of near ones and counts
// cells by mesh and level of detail, one scans, one writes the instances (Buron 2013 §3.3: cells that are wholly
// clipped are never made, those that an outline crosses are clipped when drawn, the others pay nothing).
#include "runtime/render/roof_draw.hpp"

#include <algorithm>

#include "runtime/emit/roof_triangles.hpp"
#include "runtime/render/roof_profile.hpp"

namespace espalier {
namespace {

constexpr uint32_t kSlots = 8;  // views that recordings in flight may still read
constexpr uint32_t kMostRows = 1u << 20, kMostTiles = 3u << 20, kMostCuts = 1u << 19, kMostRectangles = 1u << 19;
constexpr float kLeastCellPixels = 4.5f;  // pixels below which cells are a pattern
// Meshes are measured in cells, though their heights are metres: errors count for more than they seem.
constexpr float kErrorScale = 5;

}  // namespace

Result<std::unique_ptr<RoofDraw>> RoofDraw::create(Device& device, TerminalData meshes) {
    auto out = std::make_unique<RoofDraw>();
    out->device_ = &device;
    out->bounds_ = terminalBounds(meshes);
    for (TerminalVariant& v : meshes.variants)
        for (TerminalLod& lod : v.lods)
            if (lod.pixels == 0) lod.error *= kErrorScale;
    const std::vector<RoofProfile> profiles = roofProfiles(meshes);
    if (Status made = assign(out->profiles_, makeBuffer(device, "roof profiles", profiles)); !made)
        return made.failure();
    if (Status made = assign(out->terminals_, Terminals::create(device, std::move(meshes))); !made)
        return made.failure();
    // Exact, so that counting and writing decide alike, whatever a compiler makes of either.
    Status kernels = makeCompute(device, {{out->cullGrids_, "render/roof_cull_grids.comp", exactly()},
                                          {out->cullRows_, "render/roof_cull_rows.comp", exactly()},
                                          {out->scan_, "render/roof_scan.comp", exactly()},
                                          {out->writeRows_, "render/roof_write_rows.comp", exactly()}});
    if (!kernels) return kernels.failure();
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
        BufferUse use;
    } buffers[] = {{out->views_, "roof views", kSlots * sizeof(EmitView), BufferUse::device},
                   {out->envs_, "roof draw environments", kSlots * sizeof(RoofDrawEnv), BufferUse::device},
                   {out->state_, "roof draw state", sizeof(RoofDrawState), BufferUse::device},
                   {out->readback_, "roof draw counts", sizeof(RoofDrawState), BufferUse::readback}};
    for (const auto& b : buffers) {
        if (Status made = assign(b.buffer, Buffer::create(device, b.name, b.bytes, b.use)); !made)
            return made.failure();
    }
    std::fill(out->readback_.mappedAs<uint32_t>().begin(), out->readback_.mappedAs<uint32_t>().end(), 0u);
    return out;
}

Status RoofPrograms::make(Device& device, const PassFormat& pass, Shading shading) {
    const bool shaded = !pass.colors.empty();
    const struct {
        Program& program;
        const char* name;
        const char* vertex;
        const char* fragment;
    } rows[] = {{tile, "roof tile", "render/roof_tile.vert", "render/roof_tile.frag"},
                {cutTile, "cut roof tile", "render/roof_cut_tile.vert", "render/roof_tile.frag"},
                {rectangle, "far roof", "render/roof_rectangle.vert", "render/roof_rectangle.frag"}};
    for (const auto& r : rows) {
        if (r.program) continue;
        GraphicsDesc desc = inPass(pass, r.name, r.vertex, shaded ? r.fragment : "", constantsOf(shading));
        desc.blend = blendOf(shading);
        if (Status made = assign(r.program, Program::graphics(device, desc)); !made) return made;
    }
    return Done{};
}

Status RoofDraw::reserve(const RoofView& roofs) {
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t count, most, size;
    } rows[] = {{rows_, "roof rows", uint64_t(roofs.rowCount) + roofs.gridCount, kMostRows, sizeof(RoofRow)},
                {tiles_, "roof tiles", roofs.tileCount, kMostTiles, sizeof(RoofTile)},
                {cuts_, "cut roof tiles", roofs.clippedCount + roofs.gridCount, kMostCuts, sizeof(RoofCutTile)},
                {rectangles_, "far roofs", 2ull * roofs.gridCount, kMostRectangles, sizeof(RoofTile)}};
    for (const auto& r : rows) {
        const uint64_t bytes = std::min<uint64_t>(std::max<uint64_t>(r.count + r.count / 4, 1024), r.most) * r.size;
        if (Status made = makeAtLeast(*device_, r.buffer, r.name, bytes); !made) return made;
    }
    return Done{};
}

Status RoofDraw::cull(Commands& commands, const RoofView& roofs, const EmitView& view, bool shadow,
                      std::string_view passName) {
    if (Status s = reserve(roofs); !s) return s;
    const uint32_t slot = slot_++ % kSlots;
    RoofDrawEnv env{};
    env.roofs.grids = roofs.grids;
    env.roofs.runs = roofs.runs;
    env.roofs.regions = roofs.regions;
    env.roofs.parts = roofs.parts;
    env.roofs.planes = roofs.planes;
    env.roofs.meshes = roofs.meshes;
    env.roofs.plots = roofs.plots;
    env.roofs.layers = roofs.layers;
    env.roofs.site = roofs.site;
    env.shownLayer = roofs.shownLayer;
    env.view = addressOf<EmitViewBuf>(views_, slot * sizeof(EmitView));
    env.table = addressOf<EmitTableBuf>(terminals_.tableBuffer());
    env.state = addressOf<RoofDrawStateBuf>(state_);
    env.rows = addressOf<RoofRowBuf>(rows_);
    env.tiles = addressOf<RoofTileBuf>(tiles_);
    env.cuts = addressOf<RoofCutTileBuf>(cuts_);
    env.rectangles = addressOf<RoofTileBuf>(rectangles_);
    env.profiles = addressOf<RoofProfileBuf>(profiles_);
    env.gridCount = roofs.gridCount;
    env.rowRoom = uint32_t(rows_.size() / sizeof(RoofRow));
    env.tileRoom = uint32_t(tiles_.size() / sizeof(RoofTile));
    env.cutRoom = uint32_t(cuts_.size() / sizeof(RoofCutTile));
    env.rectangleRoom = uint32_t(rectangles_.size() / sizeof(RoofTile));
    env.leastCell = kLeastCellPixels;
    env.flags = shadow ? kRoofShadow : 0;
    RoofDrawState fresh{};
    fresh.rowGroups[1] = fresh.rowGroups[2] = 1;

    Pass pass(commands, passName);
    pass.barrier(Use::compute | Use::vertex | Use::fragment | Use::indirect | Use::transfer,
                 Use::transfer | Use::compute);
    if (Status s = allDone({commands.upload(views_, std::as_bytes(std::span(&view, 1)), slot * sizeof(EmitView)),
                            commands.upload(envs_, std::as_bytes(std::span(&env, 1)), slot * sizeof(RoofDrawEnv)),
                            commands.upload(state_, std::as_bytes(std::span(&fresh, 1)))});
        !s)
        return s;
    pass.barrier(Use::transfer, Use::compute | Use::vertex | Use::fragment);
    RoofCullPush push{};
    push.env = addressOf<RoofDrawEnvBuf>(envs_, slot * sizeof(RoofDrawEnv));
    pass.dispatchItems(cullGrids_, roofs.gridCount, push);
    pass.barrier(Use::compute, Use::compute | Use::indirect);
    const uint64_t groups = offsetof(RoofDrawState, rowGroups);
    pass.dispatchIndirect(cullRows_, state_, groups, push);
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(scan_, {1, 1, 1}, push);
    pass.barrier(Use::compute, Use::compute | Use::indirect);
    pass.dispatchIndirect(writeRows_, state_, groups, push);
    pass.barrier(Use::compute, Use::indirect | Use::vertex | Use::transfer);
    if (!shadow) {
        commands.copy(state_, readback_, sizeof(RoofDrawState));
        commands.barrier(Use::transfer, Use::host);
    }
    env_ = envs_.address() + slot * sizeof(RoofDrawEnv);
    return Done{};
}

void RoofDraw::draw(DrawPass& pass, const Buffer& frame, const RoofPrograms& programs, const Binding* shadow) const {
    const TerminalTable& table = terminals_.table();
    const std::vector<Binding> bindings = shadow ? std::vector<Binding>{*shadow, frame} : std::vector<Binding>{frame};
    RoofDrawPush push{};
    push.env.v = reinterpret_cast<RoofDrawEnv*>(env_);
    push.vertices = addressOf<TerminalVertexBuf>(terminals_.vertices());
    push.roughness = 0.9f;
    pass.drawIndirect(programs.rectangle, state_, offsetof(RoofDrawState, rectangleDraw), 1, push, bindings);
    pass.setIndices(terminals_.batches());
    for (uint32_t b = 0; b < table.buckets.size(); ++b) {
        const BucketRecord& bucket = table.buckets[b];
        push.bucket = b;
        push.firstVertex = bucket.firstVertex;
        push.vertexCount = bucket.vertexCount;
        push.batch = bucket.batch;
        push.roughness = terminals_.data().materials[bucket.material].roughness;
        for (uint32_t cut : {0u, 1u}) {
            const uint64_t offset =
                offsetof(RoofDrawState, draws) + 2ull * (kMaxBuckets * cut + b) * sizeof(DrawCommand);
            pass.drawIndexedIndirect(cut ? programs.cutTile : programs.tile, state_, offset, 2, push, bindings);
        }
    }
}

RoofDrawStats RoofDraw::stats() const {
    const RoofDrawState& state = *reinterpret_cast<const RoofDrawState*>(readback_.mapped());
    RoofDrawStats stats;
    for (uint32_t b = 0; b < kMaxBuckets; ++b) {
        stats.tiles += state.whole[b];
        stats.cutTiles += state.cut[b];
    }
    stats.rectangles = state.rectangles;
    stats.triangles = state.triangles;
    stats.overflow = state.overflow;
    return stats;
}

}  // namespace espalier
