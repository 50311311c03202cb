// Houses of a town: what a document keeps of them are those that aren't as the town's file says.
#include <algorithm>

#include "tools/document/document.hpp"

namespace espalier::document {

using scene::House;

// What takes the house back to where it is now.
Action Document::houseBack(uint32_t index) const {
    for (const House& house : scene_.town->houses)
        if (house.index == index) return SetHouse{house};
    return ResetHouse{index};
}

bool Document::mayChangeHouse(uint32_t index, std::string& error) const {
    if (!knowsHouse(index, error)) return false;
    if (!scene_.town->mark(index).locked) return true;
    error = "the house is locked, and stays as it is";
    return false;
}

bool Document::carryOut(const SetHouse& action, std::vector<Action>& back, std::string& error) {
    const uint32_t index = action.house.index;
    if (!mayChangeHouse(index, error)) return false;
    House set = scene::completed(context_, action.house);  // so that taking back what follows knows all of it
    if (!scene::setHouse(context_, set, error)) return false;
    back.push_back(houseBack(index));
    std::vector<House>& houses = scene_.town->houses;
    std::erase_if(houses, [&](const House& house) { return house.index == index; });
    const auto place = std::find_if(houses.begin(), houses.end(), [&](const House& h) { return h.index > index; });
    houses.insert(place, std::move(set));
    return true;
}

bool Document::carryOut(const ResetHouse& action, std::vector<Action>& back, std::string& error) {
    if (!mayChangeHouse(action.house, error)) return false;
    if (failed(espResetHouse(context_, action.house), error)) return false;
    back.push_back(houseBack(action.house));
    std::erase_if(scene_.town->houses, [&](const House& house) { return house.index == action.house; });
    return true;
}

}  // namespace espalier::document
