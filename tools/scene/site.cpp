// What a site's file says -> props and the ground's map in a context.
#include "tools/scene/site.hpp"

#include "tools/scene/picture.hpp"

namespace espalier::scene {

bool furnish(EspContext* context, const std::string& file, std::string& error) {
    SiteFile site;
    if (!readSiteFile(file, site, error)) return false;
    const auto done = [&](EspResult result) {
        if (result != ESP_OK) error = file + ": " + espLastError(context);
        return result == ESP_OK;
    };
    if (!done(espSetProps(context, site.models.c_str(), site.places.data(), uint32_t(site.places.size()))))
        return false;
    if (site.map.empty()) return true;
    ColourPicture picture;
    if (!readColour(site.map, picture, error)) return false;
    EspSiteDef def = site.ground;
    def.rgba = picture.rgba.data();
    def.width = picture.width;
    def.height = picture.height;
    return done(espSetSite(context, &def));
}

}  // namespace espalier::scene
