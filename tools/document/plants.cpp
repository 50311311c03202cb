// Plants that stand as they are, and branches that are cut away for good.

#include "tools/document/document.hpp"
#include "tools/scene/hash.hpp"

namespace espalier::document {
namespace {

EspResult readRecords(EspContext* context, EspSeed seed, scene::FrozenPlant& out) {
    size_t size = 0;
    if (EspResult bad = espReadFrozen(context, seed, nullptr, &size)) return bad;
    auto bytes = std::make_shared<std::vector<std::byte>>(size);
    if (EspResult bad = espReadFrozen(context, seed, bytes->data(), &size)) return bad;
    out = std::move(bytes);
    return ESP_OK;
}

bool isPruned(const EspContext* context, uint64_t branch) {
    for (uint32_t i = 0; i < espPrunedCount(context); ++i) {
        uint64_t key = 0;
        if (espPrunedAt(context, i, &key) == ESP_OK && key == branch) return true;
    }
    return false;
}

}  // namespace

std::string Document::unreadPlant(uint32_t seed) const {
    const auto found = scene_.unreadPlants.find(seed);
    return found == scene_.unreadPlants.end() ? "" : found->second;
}

// Sets it, none if it is empty, and returns what it was.
std::string Document::takeUnread(uint32_t seed, const std::string& unread) {
    std::string before = unreadPlant(seed);
    if (unread.empty())
        scene_.unreadPlants.erase(seed);
    else
        scene_.unreadPlants[seed] = unread;
    return before;
}

bool Document::carryOut(const FreezeSeeds& action, std::vector<Action>& back, std::string& error) {
    // As it is now, also in a replay that draws no frame before: edits that haven't grown yet are part of it. What
    // can't grow stands as it was, and is frozen so; a town's grammar that fails is no matter of plants.
    if (action.frozen) (void)espUpdate(context_);
    RestoreFrozen before;
    for (uint32_t key : action.keys) {
        const size_t i = indexOf(key);
        const auto freeze = [&] {
            if (i == scene_.seeds.size()) {
                error = "there is no seed " + std::to_string(key);
                return false;
            }
            scene::Seed& seed = scene_.seeds[i];
            if (failed(espFreezePlant(context_, seed.planted, action.frozen), error)) return false;
            before.plants.push_back({key, seed.frozen, action.frozen ? unreadPlant(key) : takeUnread(key, {})});
            scene::FrozenPlant records;
            if (action.frozen && failed(readRecords(context_, seed.planted, records), error)) return false;
            seed.frozen = std::move(records);
            return true;
        };
        if (freeze()) continue;
        std::vector<Action> ignored;
        std::string none;
        carryOut(before, ignored, none);
        return false;
    }
    back.push_back(std::move(before));
    return true;
}

bool Document::carryOut(const RestoreFrozen& action, std::vector<Action>& back, std::string& error) {
    RestoreFrozen before;
    bool good = true;
    // The last first: a seed that was named twice gets what it had at first.
    for (auto at = action.plants.rbegin(); at != action.plants.rend(); ++at) {
        const auto& [key, plant, unread] = *at;
        scene::Seed& seed = scene_.seeds[indexOf(key)];
        good = !failed(plant ? espFreezeAs(context_, seed.planted, plant->data(), plant->size())
                             : espFreezePlant(context_, seed.planted, 0),
                       error);
        if (!good) break;
        before.plants.push_back({key, std::exchange(seed.frozen, plant), takeUnread(key, unread)});
    }
    if (!before.plants.empty()) back.push_back(std::move(before));
    return good;
}

bool Document::carryOut(const PruneBranch& action, std::vector<Action>& back, std::string& error) {
    const std::optional<uint64_t> key = scene::keyNamed(action.branch);
    if (!key) {
        error = "a branch's key is 16 hexadecimal digits, not '" + action.branch + "'";
        return false;
    }
    if (isPruned(context_, *key) == action.pruned) return true;
    if (failed(espPruneBranch(context_, *key, action.pruned), error)) return false;
    back.push_back(PruneBranch{action.branch, !action.pruned});
    return true;
}

}  // namespace espalier::document
