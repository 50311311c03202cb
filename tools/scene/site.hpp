#pragma once

#include <deque>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"

namespace espalier::scene {

// What a site's file says (docs/scene_format.md).
struct SiteFile {
    std::string models, map;  // files; map: empty, there is none
    std::deque<std::string> names;
    std::vector<EspPropPlace> places;  // of models in `names`
    EspSiteDef ground{};               // without texels
};
// `error` tells file, place and cause.
bool readSiteFile(const std::string& path, SiteFile& out, std::string& error);

// Furnishes a scene by a site's file: props, and what lies on the ground.
bool furnish(EspContext* context, const std::string& file, std::string& error);

}  // namespace espalier::scene
