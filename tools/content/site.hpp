#pragma once

// How the sample's site is laid out: streets, paths to doors, trodden earth, where props stand. From the houses'
// outlines, so that nothing stands in a wall or on a street.

#include <map>

#include "runtime/core/result.hpp"
#include "tools/content/doors.hpp"
#include "tools/content/model.hpp"

namespace espalier::content {

using Outline = std::vector<glm::vec2>;  // corners in world x and z

struct SitePlace {
    glm::vec3 position{0};
    float degrees = 0, scale = 1;
};

struct Site {
    glm::vec2 low{0}, high{0};                            // world x and z of the map's corners
    Picture map;                                          // as EspSiteDef
    std::map<std::string, std::vector<SitePlace>> props;  // by model
};

// The outlines of a town's file in plan metres, its y being north.
Result<std::vector<Outline>> readOutlines(const std::string& path);
Site makeSite(const std::vector<Outline>& houses, const std::vector<Door>& doors, int mapSize);
// What `scene::furnish` reads: site.json, which names props.glb and site.png beside it.
std::string siteJson(const Site& site);

}  // namespace espalier::content
