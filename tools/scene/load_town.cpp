// A scene's town -> houses in a context, those that the scene has changed as it says, what their roofs grow by, and
// what was painted over it.
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

// The places of houses that a project knows by an id: the plan may have got and lost others since.
class HousePlaces {
  public:
    explicit HousePlaces(const EspContext* context) {
        for (uint32_t i = 0; i < espHouseCount(context); ++i)
            if (EspHouseInfo info; espHouseInfo(context, i, &info) == ESP_OK) byId_[info.id].push_back(i);
    }
    // Of several of one name it is the one at its old place. Without an id it is that place.
    std::optional<uint32_t> of(const std::string& id, uint32_t index) const {
        if (id.empty()) return index;
        const auto named = byId_.find(id);
        if (named == byId_.end()) return std::nullopt;
        return std::ranges::binary_search(named->second, index) ? index : named->second.front();
    }

  private:
    std::map<std::string, std::vector<uint32_t>> byId_;
};

// A project keeps what it can: a house that is gone, or whose plan leaves no room for it, is told of.
bool changeHouses(EspContext* context, const HousePlaces& places, Scene& out, std::string& error) {
    SceneTown& town = *out.town;
    std::vector<House> kept;
    for (House house : town.houses) {
        const std::string name = house.id.empty() ? std::to_string(house.index) : "'" + house.id + "'";
        const std::optional<uint32_t> place = places.of(house.id, house.index);
        house.id.clear();
        house.index = place.value_or(house.index);
        std::string why = "the plan has none of this name any more";
        if (place) house = completed(context, std::move(house));
        if (place && setHouse(context, house, why)) {
            std::erase_if(kept, [&](const House& earlier) { return earlier.index == house.index; });
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

// What is said of a house that the plan has no more goes with it.
bool markHouses(EspContext* context, const HousePlaces& places, Scene& out, std::string& error) {
    for (HouseMark mark : std::exchange(out.town->marks, {})) {
        const std::optional<uint32_t> place = places.of(mark.id, mark.index);
        if (place && *place < espHouseCount(context)) {
            mark.index = *place;
            mark.id.clear();
            out.town->setMark(mark);
            if (mark.hidden && !fromContext(context, espHideHouse(context, *place, 1), error)) return false;
            continue;
        }
        error = out.town->file + ": 'marks': there is no house " +
                (mark.id.empty() ? std::to_string(mark.index) : "'" + mark.id + "'");
        if (!out.project) return false;
        out.notes.push_back(std::exchange(error, {}));
    }
    return true;
}

}  // namespace

HouseMark SceneTown::mark(uint32_t house) const {
    const auto found = std::ranges::lower_bound(marks, house, {}, &HouseMark::index);
    return found == marks.end() || found->index != house ? HouseMark{house} : *found;
}

void SceneTown::setMark(const HouseMark& mark) {
    auto at = std::ranges::lower_bound(marks, mark.index, {}, &HouseMark::index);
    if (at != marks.end() && at->index == mark.index) at = marks.erase(at);
    if (mark.hidden || mark.locked) marks.insert(at, mark);
}

bool loadTown(EspContext* context, Scene& out, std::string& error) {
    const SceneTown& town = *out.town;
    std::string text;
    if (!readText(town.file, text, error)) return false;
    EspTownDef def = esp::defaults<EspTownDef>();
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
    const HousePlaces places(context);
    if (!changeHouses(context, places, out, error) || !markHouses(context, places, out, error)) return false;
    if (setTownGrammar(context, out, error)) return true;
    error = town.file + ": its houses have no roofs: " + error;
    if (out.project) out.notes.push_back(std::exchange(error, {}));
    return out.project;
}

namespace {

// Between the centres of texels, in texels from the picture's corner.
float bilinear(const GreyPicture& picture, float x, float y) {
    const float u = std::clamp(x - .5f, 0.f, float(picture.width - 1));
    const float v = std::clamp(y - .5f, 0.f, float(picture.height - 1));
    const uint32_t x0 = uint32_t(u), y0 = uint32_t(v);
    const uint32_t x1 = std::min(x0 + 1, picture.width - 1), y1 = std::min(y0 + 1, picture.height - 1);
    const auto at = [&](uint32_t column, uint32_t row) { return picture.texels[size_t(row) * picture.width + column]; };
    const float fx = u - float(x0), fy = v - float(y0);
    return std::lerp(std::lerp(at(x0, y0), at(x1, y0), fx), std::lerp(at(x0, y1), at(x1, y1), fx), fy);
}

}  // namespace

bool moveOver(EspContext* context, const std::string& channel, const TownSquare& from, GreyPicture& picture,
              std::string& error) {
    const std::optional<TownSquare> now = squareOf(context);
    if (!now || *now == from) return true;
    uint32_t side = 0;
    if (!fromContext(context, espReadTownLayer(context, channel.c_str(), nullptr, &side), error)) return false;
    GreyPicture moved{side, side, std::vector<float>(size_t(side) * side)};
    if (!fromContext(context, espReadTownLayer(context, channel.c_str(), moved.texels.data(), &side), error))
        return false;
    const auto inPicture = [&](uint32_t texel, size_t axis, uint32_t count) {
        const float at = now->low[axis] + (float(texel) + .5f) * now->side / float(side);
        return (at - from.low[axis]) * float(count) / from.side;
    };
    for (uint32_t row = 0; row < side; ++row)
        for (uint32_t column = 0; column < side; ++column) {
            const float x = inPicture(column, 0, picture.width), y = inPicture(row, 1, picture.height);
            const bool inside = x >= 0 && y >= 0 && x <= float(picture.width) && y <= float(picture.height);
            if (inside) moved.texels[size_t(row) * side + column] = bilinear(picture, x, y);
        }
    picture = std::move(moved);
    return true;
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
