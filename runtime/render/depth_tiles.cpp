// In: a picture's depths. Out: the farthest of each tile, kept for some pictures.
#include "runtime/render/depth_tiles.hpp"

#include <algorithm>

#include "shaders/render/frame_records.h"

namespace espalier {

Result<DepthTiles> DepthTiles::create(Device& device, uint32_t samples) {
    DepthTiles tiles;
    Result<Program> made = Program::compute(device, samples == 1 ? "render/tiles_single.comp" : "render/tiles.comp");
    if (!made) return made.failure();
    tiles.program_ = std::move(*made);
    return tiles;
}

// Into those of the oldest picture.
Status DepthTiles::find(Commands& commands, Image& depths, const Sampler& sampler, uint64_t models, EmitView& view) {
    Picture& to = *std::ranges::min_element(pictures_, {}, &Picture::serial);
    const uint32_t count = tilesOf(view);
    if (Status s = makeAtLeast(commands.device(), to.buffer, "depth tiles", count * sizeof(float)); !s) return s;
    view.tiles = addressOf<FloatBuf>(to.buffer);
    to.view = view;
    to.serial = commands.serial();
    to.models = models;
    commands.transition(depths, ImageState::sampled);
    Pass pass(commands, "emit");
    pass.dispatchItems(program_, count, TilesPush{view.tiles}, {{depths, sampler}});
    pass.barrier(Use::compute, Use::compute);
    return Done{};
}

void DepthTiles::lookBack(const Device& device, uint64_t models, EmitView& view) const {
    const Picture* past = nullptr;
    for (const Picture& p : pictures_)
        if (p.buffer && device.finished(p.serial) && p.view.width == view.width && p.view.height == view.height &&
            p.view.pixelScale == view.pixelScale && p.models == models && (!past || p.serial > past->serial))
            past = &p;
    view.flags |= kTilesStand;
    view.tiles.v = past ? past->view.tiles.v : nullptr;
    if (!past) return;
    view.viewProjection = past->view.viewProjection;
    view.drift = std::max(glm::distance(view.eye, past->view.eye), 1e-6f);
}

}  // namespace espalier
