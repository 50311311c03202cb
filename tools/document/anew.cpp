// A document as its own project's reader would have it, so that who replays what follows begins with the same; and what
// was done before, by the keys that seeds have then.
#include <map>

#include "tools/document/document.hpp"

namespace espalier::document {
namespace {

// Gives the seeds that an action names other keys.
template <class NewKey>
struct RenameSeeds {
    NewKey& newKey;
    void operator()(AddSeeds& action) const { rename(action.seeds); }
    void operator()(ChangeSeeds& action) const { rename(action.seeds); }
    void operator()(RemoveSeeds& action) const { rename(action.keys); }
    void operator()(FreezeSeeds& action) const { rename(action.keys); }
    void operator()(ShowPlants& action) const { rename(action.keys); }
    void operator()(RestoreFrozen& action) const {
        for (RestoreFrozen::Plant& plant : action.plants) plant.seed = newKey(plant.seed);
    }
    // These name none.
    void operator()(SetParam&) const {}
    void operator()(SetText&) const {}
    void operator()(SetLight&) const {}
    void operator()(SetWalk&) const {}
    void operator()(StrokeBegin&) const {}
    void operator()(StrokeDabs&) const {}
    void operator()(StrokeEnd&) const {}
    void operator()(FillLayer&) const {}
    void operator()(LoadLayer&) const {}
    void operator()(LoadTownLayer&) const {}
    void operator()(PruneBranch&) const {}
    void operator()(SetHouse&) const {}
    void operator()(ResetHouse&) const {}
    void operator()(SetField&) const {}
    void operator()(BrushField&) const {}
    void operator()(TrimField&) const {}
    void operator()(AddSurface&) const {}
    void operator()(PlaceSurface&) const {}
    void operator()(AddGrammar&) const {}
    void operator()(AddGraph&) const {}
    void operator()(SetGraphText&) const {}
    void operator()(AddNodes&) const {}
    void operator()(RemoveNodes&) const {}
    void operator()(SetNodeInput&) const {}
    void operator()(ConnectNodes&) const {}
    void operator()(MoveNodes&) const {}
    void operator()(RenameNode&) const {}
    void operator()(ShowNodes&) const {}
    void operator()(MuteNodes&) const {}
    void operator()(SetGraphTime&) const {}
    void operator()(SetLook&) const {}
    void operator()(SetBookmark&) const {}
    void operator()(ShowSurfaces&) const {}
    void operator()(LockSurface&) const {}
    void operator()(ShowHouses&) const {}
    void operator()(LockHouse&) const {}
    void operator()(LockLayer&) const {}
    void operator()(DropLast&) const {}
    void operator()(SetCamera&) const {}
    void operator()(SetView&) const {}
    void operator()(Undo&) const {}
    void operator()(Redo&) const {}
    void operator()(SwapStroke&) const {}

  private:
    void rename(std::vector<SeedRecord>& seeds) const {
        for (SeedRecord& seed : seeds) seed.key = newKey(seed.key);
    }
    void rename(std::vector<uint32_t>& keys) const {
        for (uint32_t& key : keys) key = newKey(key);
    }
};

}  // namespace

std::vector<uint32_t> Document::beginAnew() {
    undone_.clear();
    beyond_ = done_.size();
    std::vector<uint32_t> keys;
    std::map<uint32_t, uint32_t> renamed;
    lastKey_ = 0;
    for (scene::Seed& seed : scene_.seeds) {
        keys.push_back(seed.key);
        seed.key = renamed[seed.key] = ++lastKey_;
    }
    // Seeds that are no more, but would be if something were undone, go on with keys of their own.
    const auto newKey = [&](uint32_t key) {
        const auto [at, fresh] = renamed.try_emplace(key, lastKey_ + 1);
        if (fresh) ++lastKey_;
        return at->second;
    };
    std::map<uint32_t, std::string> unread;
    for (auto& [key, file] : scene_.unreadPlants) unread[newKey(key)] = std::move(file);
    scene_.unreadPlants = std::move(unread);
    for (Step& step : done_)
        for (Action& action : step.back) std::visit(RenameSeeds<decltype(newKey)>{newKey}, action);
    return keys;
}

}  // namespace espalier::document
