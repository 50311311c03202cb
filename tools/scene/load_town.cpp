// A scene's town -> houses in a context, those that the scene has changed as it says, and what their roofs grow by.
#include <algorithm>
#include <optional>
#include <utility>

#include "tools/scene/scene_parts.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

// The place of the house that a project knows by an id: the plan may have got and lost others since. Of several of one
// name it is the one at its old place.
std::optional<uint32_t> placeOf(const EspContext* context, const House& house) {
    std::optional<uint32_t> found;
    for (uint32_t i = 0; i < espHouseCount(context); ++i) {
        EspHouseInfo info;
        if (espHouseInfo(context, i, &info) != ESP_OK || house.id != info.id) continue;
        if (!found || i == house.index) found = i;
    }
    return found;
}

// A project keeps what it can: a house that is gone, or whose plan leaves no room for it, is told of.
bool changeHouses(EspContext* context, Scene& out, std::string& error) {
    SceneTown& town = *out.town;
    std::vector<House> kept;
    for (House house : town.houses) {
        const std::string name = house.id.empty() ? std::to_string(house.index) : "'" + house.id + "'";
        const std::optional<uint32_t> place = house.id.empty() ? house.index : placeOf(context, house);
        house.id.clear();
        house.index = place.value_or(house.index);
        std::string why = "the plan has none of this name any more";
        if (place) house = completed(context, std::move(house));
        if (place && setHouse(context, house, why)) {
            kept.push_back(std::move(house));
            continue;
        }
        error = town.file + ": house " + name + " of the scene: " + why;
        if (!out.project) return false;
        out.notes.push_back(std::exchange(error, {}));
    }
    std::ranges::stable_sort(kept, {}, &House::index);
    town.houses = std::move(kept);
    return true;
}

}  // namespace

bool loadTown(EspContext* context, Scene& out, std::string& error) {
    const SceneTown& town = *out.town;
    std::string text;
    if (!readText(town.file, text, error)) return false;
    EspTownDef def = espDefaultTownDef();
    def.name = town.file.c_str();
    def.text = text.data();
    def.length = text.size();
    std::copy(town.placing.position.begin(), town.placing.position.end(), def.position);
    def.turn = town.placing.turn;
    def.ground = town.ground ? 1 : 0;
    if (town.groundColour) std::copy(town.groundColour->begin(), town.groundColour->end(), def.groundColour);
    if (!fromContext(context, espLoadTown(context, &def), error)) return false;
    out.plannedRoofs.clear();
    for (uint32_t i = 0; i < espHouseCount(context); ++i) {
        const House house = houseNow(context, i);
        out.plannedRoofs.push_back({house.shape, house.slope, house.eaveHeight});
    }
    if (!changeHouses(context, out, error)) return false;
    if (setTownGrammar(context, out, error)) return true;
    error = town.file + ": its houses have no roofs: " + error;
    if (out.project) out.notes.push_back(std::exchange(error, {}));
    return out.project;
}

bool setTownGrammar(EspContext* context, const Scene& scene, std::string& error) {
    const SceneTown& town = *scene.town;
    if (town.grammar >= 0)
        return fromContext(context, espSetTownGrammar(context, scene.grammars[size_t(town.grammar)].id), error);
    for (const LoadedGrammar& grammar : scene.grammars)
        if (espSetTownGrammar(context, grammar.id) == ESP_OK) return true;
    error = "none of the scene's grammars makes roofs; town.grammar does";
    return false;
}

}  // namespace espalier::scene
