// The village around the ruin. In: outlines of houses, doors. Out: a map of streets and trodden earth, and where trees,
// hedges, walls and tufts stand.

#include "tools/content/site.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "tools/content/lawn.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/site_layout.hpp"

namespace espalier::content {
namespace {

using glm::vec2;
using Json = nlohmann::ordered_json;
constexpr float kReach = 1;  // as kSiteReach of the shaders

// Where people stand and work: circles, as shades.
std::vector<glm::vec3> wornPlaces(const Site& site) {
    std::vector<glm::vec3> worn;
    for (const char* model : {"bench", "seat", "trough", "woodpile", "cart", "washing", "hives"}) {
        const auto found = site.props.find(model);
        if (found == site.props.end()) continue;
        for (const SitePlace& p : found->second) worn.push_back({p.position.x, p.position.z, 1.1f});
    }
    return worn;
}

void paintMap(const Plan& plan, const std::vector<glm::vec3>& shades, Site& site) {
    const std::vector<glm::vec3> worn = wornPlaces(site);
    for (int y = 0; y < site.map.height; ++y)
        for (int x = 0; x < site.map.width; ++x) {
            const vec2 p = glm::mix(site.low, site.high, (vec2(x, y) + 0.5f) / vec2(site.map.width, site.map.height));
            const float paved = plan.paved(p), house = plan.toHouse(p), court = Plan::toCourt(p);
            // The court's own paving goes on where the path comes to it.
            const float uneven = noise(p / 1.3f, 71) + 0.6f * noise(p / 0.5f, 72);
            // Edges never swap: where they did, far ground would be as bare as at the kerb.
            float earth = 0.62f * ramp(std::min(-0.55f - 0.4f * uneven, -0.1f), -0.05f, paved);        // beside kerbs
            earth = std::max(earth, 0.7f * ramp(std::max(1.1f + 0.6f * uneven, 0.25f), 0.2f, house));  // around houses
            earth = std::max(earth, 0.16f * ramp(std::max(0.9f + uneven, 0.05f), 0.0f, court));
            earth = std::max(earth, (0.82f + 0.2f * uneven) * ramp(-0.28f - 0.25f * uneven, 0.16f, plan.trodden(p)));
            for (glm::vec3 w : worn)
                earth = std::max(earth, 0.55f * ramp(1.2f + 0.4f * uneven, 0.3f, glm::distance(p, vec2(w)) / w.z));
            const Lawn lawn = lawnAt(p);
            earth = std::max(earth, 0.75f * lawn.bare);
            float open = (1 - 0.22f * lawn.clover) * (1 - 0.55f * std::exp(-std::max(house, 0.0f) / 0.9f));
            for (glm::vec3 s : shades) {
                const float d = glm::distance(p, vec2(s)) / s.z;
                if (d < 1.5f) open *= 1 - 0.42f * ramp(1.4f, 0.1f, d);
                earth = std::max(earth, 0.7f * ramp(0.34f, 0.10f, d));
            }
            uint8_t* texel = site.map.at(x, y);
            const float rgb[3] = {0.5f + paved / (2 * kReach), earth, open};
            for (int k = 0; k < 3; ++k) texel[k] = uint8_t(saturate(rgb[k]) * 255 + 0.5f);
            texel[3] = 255;
        }
}

}  // namespace

Result<std::vector<Outline>> readOutlines(const std::string& path) {
    Result<std::vector<std::byte>> bytes = readFile(path);
    if (!bytes) return bytes.failure();
    const auto* text = reinterpret_cast<const char*>(bytes->data());
    const Json json = Json::parse(text, text + bytes->size(), nullptr, false);
    std::vector<Outline> outlines;
    try {
        for (const Json& building : json.at("buildings")) {
            Outline& outline = outlines.emplace_back();
            for (const Json& corner : building.at("outer"))
                outline.push_back({corner.at(0).get<float>(), -corner.at(1).get<float>()});
        }
    } catch (const Json::exception& mistake) {
        return Failure(path, std::string("isn't a town: ") + mistake.what());
    }
    return outlines;
}

Site makeSite(const std::vector<Outline>& houses, const std::vector<Door>& doors, int mapSize) {
    Site site;
    site.low = vec2(-kHalfMap);
    site.high = vec2(kHalfMap);
    site.map = Picture(mapSize, mapSize);
    const Plan plan(houses, doors);
    Layout layout(plan, site);
    layout.lay();
    paintMap(plan, layout.shades(), site);
    return site;
}

std::string siteJson(const Site& site) {
    const auto rounded = [](float x) { return std::round(double(x) * 1000) / 1000; };
    Json json = {
        {"models", "props.glb"},
        {"ground", {{"map", "site.png"}, {"low", {site.low.x, site.low.y}}, {"high", {site.high.x, site.high.y}}}}};
    for (const auto& [model, places] : site.props)
        for (const SitePlace& p : places)
            json["props"][model].push_back({rounded(p.position.x), rounded(p.position.y), rounded(p.position.z),
                                            rounded(p.degrees), rounded(p.scale)});
    return json.dump() + "\n";
}

}  // namespace espalier::content
