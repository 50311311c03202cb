// Enters: a view that has been drawn, and what binding notes in its tiles. Leaves: the view of what is to be drawn
// again.
#include "runtime/emit/tile_watch.hpp"

#include "runtime/run/emission.hpp"

namespace espalier {
namespace {

uint32_t tilesAlong(const EmitView& view, uint32_t pixels) {
    return (pixels + view.tilePixels - 1) / view.tilePixels;
}

}  // namespace

Result<TileWatch> TileWatch::create(Device& device) {
    TileWatch out;
    out.device_ = &device;
    if (Status made = assign(out.take_, Program::compute(device, "emit/take_tiles.comp")); !made) return made.failure();
    if (Status made = assign(out.record_, Buffer::create(device, "watched view", sizeof(EmitView))); !made)
        return made.failure();
    return out;
}

Status TileWatch::watch(Commands& commands, const EmitView& view) {
    const uint64_t bytes = 4ull * tilesOf(view);
    forget();
    if (!tiles_ || tiles_.size() != bytes) {
        Result<Buffer> watched = Buffer::create(*device_, "watched tiles", bytes);
        if (!watched) return watched.failure();
        Result<Buffer> taken = Buffer::create(*device_, "taken tiles", bytes + 4);
        if (!taken) return taken.failure();
        tiles_ = std::move(*watched);
        taken_ = std::move(*taken);
    }
    usedBy_ = commands.serial();
    EmitView watched = view;
    watched.tiles = addressOf<FloatBuf>(tiles_);
    commands.barrier(Use::compute, Use::transfer);
    if (Status s = commands.upload(record_, std::as_bytes(std::span(&watched, 1))); !s) return s;
    watched_ = watched;
    commands.barrier(Use::compute | Use::vertex, Use::transfer);
    commands.fill(tiles_, kKeptTile);
    commands.fill(taken_, 0);
    commands.barrier(Use::transfer, Use::compute | Use::vertex);
    return Done{};
}

EmitView TileWatch::take(Commands& commands, uint32_t mostTiles, bool growthStands) {
    const bool atOnce = growthStands && device_->finished(usedBy_);
    usedBy_ = commands.serial();
    EmitView view = watched_;
    view.tiles = addressOf<FloatBuf>(taken_);
    view.scene = ++timesTaken_;  // others each time
    TakePush push{};
    push.watched = watched_.tiles;
    push.taken = view.tiles;
    push.tiles = tilesOf(view);
    push.columns = tilesAlong(view, view.width);
    push.most = mostTiles;
    if (atOnce) {
        takeTilesNative(push);
        view.flags |= kTilesStand;
        return view;
    }
    Pass pass(commands, "shadow emit");
    pass.barrier(Use::compute | Use::vertex, Use::compute);
    pass.dispatch(take_, {1, 1, 1}, push);
    pass.barrier(Use::compute, Use::compute | Use::vertex);
    return view;
}

uint32_t tilesOf(const EmitView& view) {
    return tilesAlong(view, view.width) * tilesAlong(view, view.height);
}

}  // namespace espalier
