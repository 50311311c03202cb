// A document as its own project's reader would have it, so that who replays what follows begins with the same; and what
// was done before, by the keys that seeds have then.
#include <algorithm>
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
    void operator()(RestoreFrozen& action) const {
        for (auto& [key, plant] : action.plants) key = newKey(key);
    }
    template <class Other>
    void operator()(Other&) const {}

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
    out_ = done_.size();
    const std::vector<scene::Seed> before = scene_.seeds;
    std::ranges::stable_sort(scene_.seeds, {}, &scene::Seed::grammar);
    std::vector<uint32_t> keys;
    std::map<uint32_t, uint32_t> renamed;
    lastKey_ = 0;
    bool sorted = true;
    for (size_t i = 0; i < before.size(); ++i) {
        scene::Seed& seed = scene_.seeds[i];
        sorted = sorted && before[i].key == seed.key;
        keys.push_back(seed.key);
        seed.key = renamed[seed.key] = ++lastKey_;
    }
    // Seeds that are no more, but would be if something were undone, go on with keys of their own.
    const auto newKey = [&](uint32_t key) {
        const auto [at, fresh] = renamed.try_emplace(key, lastKey_ + 1);
        if (fresh) ++lastKey_;
        return at->second;
    };
    for (Step& step : done_)
        for (Action& action : step.back) std::visit(RenameSeeds<decltype(newKey)>{newKey}, action);
    std::string ignored;
    if (!sorted) (void)plant(ignored);
    return keys;
}

}  // namespace espalier::document
