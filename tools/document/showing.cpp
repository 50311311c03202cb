// What is hidden, and what is locked.
#include <algorithm>

#include "tools/document/document.hpp"
#include "tools/scene/layers.hpp"

namespace espalier::document {

// A seed that isn't planted, since its grammar's text has mistakes, is hidden once it is planted.
bool Document::carryOut(const ShowPlants& action, std::vector<Action>& back, std::string& error) {
    ShowPlants inverse{{}, !action.shown};
    for (uint32_t key : action.keys) {
        const scene::Seed* known = seed(key);
        if (!known) {
            error = "there is no such seed";
            return false;
        }
        if (known->hidden == action.shown) inverse.keys.push_back(key);
    }
    for (uint32_t key : inverse.keys) {
        scene::Seed& changed = scene_.seeds[indexOf(key)];
        changed.hidden = !action.shown;
        if (changed.planted.id) (void)espHideSeed(context_, changed.planted, changed.hidden);
    }
    if (!inverse.keys.empty()) back.push_back(std::move(inverse));
    return true;
}

bool Document::carryOut(const ShowSurfaces& action, std::vector<Action>& back, std::string& error) {
    ShowSurfaces inverse{{}, !action.shown};
    for (uint32_t index : action.surfaces) {
        if (index >= scene_.surfaces.size()) {
            error = "there is no surface " + std::to_string(index);
            return false;
        }
        if (scene_.surfaces[index].hidden == action.shown) inverse.surfaces.push_back(index);
    }
    for (uint32_t index : inverse.surfaces) {
        scene::LoadedSurface& changed = scene_.surfaces[index];
        changed.hidden = !action.shown;
        (void)espHideSurface(context_, changed.id, changed.hidden);
    }
    if (!inverse.surfaces.empty()) back.push_back(std::move(inverse));
    return true;
}

bool Document::carryOut(const LockSurface& action, std::vector<Action>& back, std::string& error) {
    if (action.surface >= scene_.surfaces.size()) {
        error = "there is no surface " + std::to_string(action.surface);
        return false;
    }
    scene::LoadedSurface& surface = scene_.surfaces[action.surface];
    if (surface.locked == action.locked) return true;
    surface.locked = action.locked;
    back.push_back(LockSurface{action.surface, !action.locked});
    return true;
}

bool Document::knowsHouse(uint32_t house, std::string& error) const {
    if (scene_.town && house < espHouseCount(context_)) return true;
    error = scene_.town ? "there is no house " + std::to_string(house) : "there is no town";
    return false;
}

bool Document::carryOut(const ShowHouses& action, std::vector<Action>& back, std::string& error) {
    ShowHouses inverse{{}, !action.shown};
    for (uint32_t house : action.houses) {
        if (!knowsHouse(house, error)) return false;
        if (scene_.town->mark(house).hidden == action.shown) inverse.houses.push_back(house);
    }
    for (uint32_t house : inverse.houses) {
        scene::HouseMark mark = scene_.town->mark(house);
        mark.hidden = !action.shown;
        scene_.town->setMark(mark);
        (void)espHideHouse(context_, house, mark.hidden);
    }
    if (!inverse.houses.empty()) back.push_back(std::move(inverse));
    return true;
}

bool Document::carryOut(const LockHouse& action, std::vector<Action>& back, std::string& error) {
    if (!knowsHouse(action.house, error)) return false;
    scene::HouseMark mark = scene_.town->mark(action.house);
    if (mark.locked == action.locked) return true;
    mark.locked = action.locked;
    scene_.town->setMark(mark);
    back.push_back(LockHouse{action.house, !action.locked});
    return true;
}

bool Document::carryOut(const LockLayer& action, std::vector<Action>& back, std::string& error) {
    if (!scene::isLayersName(action.layer, error)) return false;
    std::vector<std::string>& locked = scene_.lockedLayers;
    const bool now = std::ranges::find(locked, action.layer) != locked.end();
    if (now == action.locked) return true;
    if (action.locked)
        locked.insert(std::ranges::upper_bound(locked, action.layer), action.layer);
    else
        std::erase(locked, action.layer);
    back.push_back(LockLayer{action.layer, !action.locked});
    return true;
}

}  // namespace espalier::document
