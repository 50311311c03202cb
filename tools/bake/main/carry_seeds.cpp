// In: a scene file's seeds and placements, two surfaces. Out: notes about the seeds that lose their ground.
#include "tools/bake/main/carry_seeds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/surface/carry.hpp"

namespace espalier {
namespace {

using nlohmann::json;

constexpr double kDegree = 0.017453292519943295;
constexpr float kStandsWithin = 0.02f;  // of the surface's radius: in scenes of several a seed so near is this one's

struct Placed {
    glm::dvec3 position{0};
    double turn = 0, scale = 1;
    glm::vec3 toObject(glm::dvec3 world) const {
        const glm::dvec3 q = (world - position) / scale;
        const double c = std::cos(turn), s = std::sin(turn);
        return glm::vec3(glm::dvec3(c * q.x - s * q.z, q.y, s * q.x + c * q.z));
    }
};

// Not copied: a copy recurses, however deep a file nests. Of what isn't there: null.
const json& memberOf(const json& object, const char* key) {
    static const json none;
    const auto found = object.find(key);
    return found == object.end() ? none : *found;
}

bool readPoint(const json& list, glm::dvec3& out) {
    if (!list.is_array() || list.size() != 3) return false;
    for (size_t k = 0; k < 3; ++k) {
        if (!list[k].is_number()) return false;
        out[int(k)] = list[k].get<double>();
    }
    return true;
}

// Where the scene places the surface; several times, if it does.
Result<std::vector<Placed>> readPlacements(const json& scene, const SeedsArguments& arguments,
                                           const std::string& file) {
    std::vector<Placed> out;
    if (scene.contains("surface")) return std::vector<Placed>{Placed{}};
    const json& list = memberOf(scene, "surfaces");
    if (!list.is_array() && !list.is_null()) return Failure(file, "'surfaces' is no list");
    auto nameOf = [](const std::string& path) { return std::filesystem::path(path).filename(); };
    for (size_t i = 0; i < list.size(); ++i) {
        const std::string at = "surfaces[" + std::to_string(i) + "]";
        const json& entry = list[i];
        if (!entry.is_object() || !memberOf(entry, "file").is_string()) return Failure(file, at + " names no file");
        const auto name = nameOf(entry["file"].get<std::string>());
        if (list.size() > 1 && name != nameOf(arguments.from) && name != nameOf(arguments.to)) continue;
        const json &turn = memberOf(entry, "turn"), &scale = memberOf(entry, "scale");
        Placed placed;
        if (entry.contains("position") && !readPoint(entry["position"], placed.position))
            return Failure(file, at + ".position is not three numbers");
        if (turn.is_number()) placed.turn = turn.get<double>() * kDegree;
        if (scale.is_number()) placed.scale = scale.get<double>();
        if (!(turn.is_number() || turn.is_null()) || !(scale.is_number() || scale.is_null()) || !(placed.scale > 0))
            return Failure(file, at + ": 'turn' has to be a number, 'scale' one above 0");
        out.push_back(placed);
    }
    if (out.empty()) return Failure(file, "places no surface of the name of " + arguments.from);
    return out;
}

struct Seed {
    std::string name;  // as the scene file has it
    glm::dvec3 position;
};

Result<std::vector<Seed>> readSeeds(const json& scene, const std::string& file) {
    std::vector<Seed> out;
    const json& grammars = memberOf(scene, "grammars");
    if (!grammars.is_array() && !grammars.is_null()) return Failure(file, "'grammars' is no list");
    for (size_t g = 0; g < grammars.size(); ++g) {
        const std::string at = "grammars[" + std::to_string(g) + "]";
        if (!grammars[g].is_object()) return Failure(file, at + " is no object");
        const json& seeds = memberOf(grammars[g], "seeds");
        if (!seeds.is_array() && !seeds.is_null()) return Failure(file, at + ".seeds is no list");
        for (size_t i = 0; i < seeds.size(); ++i) {
            Seed seed{at + ".seeds[" + std::to_string(i) + "]", {}};
            if (!seeds[i].is_object() || !readPoint(memberOf(seeds[i], "position"), seed.position))
                return Failure(file, seed.name + ".position is not three numbers");
            out.push_back(seed);
        }
    }
    return out;
}

}  // namespace

Status findLostSeeds(const SeedsArguments& arguments, const SurfaceData& before, const SurfaceData& after,
                     std::vector<Diagnostic>& notes) {
    std::string file = arguments.scene;
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) file = (std::filesystem::path(file) / "project.json").string();
    auto text = readTextFile(file);
    if (!text) return std::move(text.failure());
    const json scene = json::parse(*text, nullptr, false);
    if (!scene.is_object()) return Failure(file, "is no scene: not a JSON object");
    auto placements = readPlacements(scene, arguments, file);
    if (!placements) return std::move(placements.failure());
    auto seeds = readSeeds(scene, file);
    if (!seeds) return std::move(seeds.failure());

    const bool alone = scene.contains("surface") || scene["surfaces"].size() == 1;
    const float near = kStandsWithin * glm::length(before.boundsMax - before.boundsMin) / 2;
    std::vector<uint8_t> standing(seeds->size(), 0), lost(seeds->size(), 0);
    for (const Placed& placed : *placements) {
        std::vector<glm::vec3> places;
        for (const Seed& seed : *seeds) places.push_back(placed.toObject(seed.position));
        const std::vector<CarriedPlace> carried = carryPlaces(before, after, places);
        for (size_t i = 0; i < carried.size(); ++i) {
            if (!alone && carried[i].height > near) continue;
            (carried[i].lost ? lost : standing)[i] = 1;
        }
    }
    size_t count = 0, gone = 0;
    for (size_t i = 0; i < seeds->size(); ++i) {
        count += standing[i] || lost[i];
        if (!lost[i]) continue;
        ++gone;
        const Seed& seed = (*seeds)[i];
        char note[160];
        std::snprintf(note, sizeof note,
                      "%s at %.3g, %.3g, %.3g has lost its ground: it would stand on what is nearest",
                      seed.name.c_str(), seed.position.x, seed.position.y, seed.position.z);
        notes.push_back({file, 0, 0, {}, note, true});
    }
    const std::string all = std::to_string(count) + " seeds on this surface ";
    if (gone == 0)
        notes.push_back({file, 0, 0, {}, "all " + all + "keep their ground"});
    else
        notes.push_back({file, 0, 0, {}, std::to_string(gone) + " of " + all + "have lost their ground", true});
    return Done{};
}

}  // namespace espalier
