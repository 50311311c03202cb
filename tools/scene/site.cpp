// A site's file -> props and the ground's map in a context.
#include "tools/scene/site.hpp"

#include <algorithm>
#include <deque>

#include "tools/scene/json_checks.hpp"
#include "tools/scene/picture.hpp"

namespace espalier::scene {
namespace {

class Site : JsonChecks {
  public:
    explicit Site(const std::string& path) : JsonChecks(path), path_(path) {}

    bool read(std::string& error) {
        Json json;
        if (!readJsonFile(path_, json, error)) return false;
        if (isObject(json, "a site", {"models", "props", "ground"})) {
            if (const Json* models = need(json, "models")) models_ = file(*models);
            const Json* props = need(json, "props");
            if (props && props->kind != Json::Kind::object) fail(*props, "'props' must be an object");
            if (props)
                for (const auto& [name, places] : props->members) readPlaces(name, places);
            if (const Json* ground = json.find("ground")) readGround(*ground);
        }
        error = errors();
        return error.empty();
    }
    bool lay(EspContext* context, std::string& error) const {
        if (espSetProps(context, models_.c_str(), places_.data(), uint32_t(places_.size())) != ESP_OK) {
            error = path_ + ": " + espLastError(context);
            return false;
        }
        if (map_.empty()) return true;
        ColourPicture picture;
        if (!readColour(map_, picture, error)) return false;
        EspSiteDef def = def_;
        def.rgba = picture.rgba.data();
        def.width = picture.width;
        def.height = picture.height;
        if (espSetSite(context, &def) == ESP_OK) return true;
        error = path_ + ": " + espLastError(context);
        return false;
    }

  private:
    // A model's places: x, y, z, degrees about the vertical, scale.
    void readPlaces(const std::string& name, const Json& json) {
        constexpr float kRadians = 3.14159265f / 180;
        names_.push_back(name);
        if (json.kind != Json::Kind::list) fail(json, "a model's places must be a list");
        for (const Json& item : json.items) {
            std::array<float, 5> v;
            if (!numbers(item, v)) return fail(item, "a place must be five numbers: x, y, z, degrees, scale");
            places_.push_back({names_.back().c_str(), {v[0], v[1], v[2]}, v[3] * kRadians, v[4]});
        }
    }
    void readGround(const Json& json) {
        if (!isObject(json, "'ground'", {"map", "low", "high"})) return;
        if (const Json* map = need(json, "map")) map_ = file(*map);
        readCorner(json, "low", def_.low);
        readCorner(json, "high", def_.high);
    }
    void readCorner(const Json& json, const char* name, float (&out)[2]) {
        std::array<float, 2> corner{};
        const Json* found = need(json, name);
        if (found && !numbers(*found, corner)) fail(*found, std::string("'") + name + "' must be two numbers");
        std::ranges::copy(corner, out);
    }

    std::string path_, models_, map_;
    std::deque<std::string> names_;  // that places_ points to
    std::vector<EspPropPlace> places_;
    EspSiteDef def_{};
};

}  // namespace

bool furnish(EspContext* context, const std::string& file, std::string& error) {
    Site site(file);
    return site.read(error) && site.lay(context, error);
}

}  // namespace espalier::scene
