// A site's file -> what it says.
#include <algorithm>

#include "tools/scene/json_checks.hpp"
#include "tools/scene/site.hpp"

namespace espalier::scene {
namespace {

class SiteReader : JsonChecks {
  public:
    SiteReader(const std::string& path, SiteFile& out) : JsonChecks(path), path_(path), out_(out) {}

    bool read(std::string& error) {
        Json json;
        if (!readJsonFile(path_, json, error)) return false;
        if (isObject(json, "a site", {"models", "props", "ground"})) {
            if (const Json* models = need(json, "models")) out_.models = file(*models);
            const Json* props = need(json, "props");
            if (props && props->kind != Json::Kind::object) fail(*props, "'props' must be an object");
            if (props)
                for (const auto& [name, places] : props->members) readPlaces(name, places);
            if (const Json* ground = json.find("ground")) readGround(*ground);
        }
        error = errors();
        return error.empty();
    }

  private:
    // A model's places: x, y, z, degrees about the vertical, scale.
    void readPlaces(const std::string& name, const Json& json) {
        constexpr float kRadians = 3.14159265f / 180;
        out_.names.push_back(name);
        if (json.kind != Json::Kind::list) fail(json, "a model's places must be a list");
        for (const Json& item : json.items) {
            std::array<float, 5> v;
            if (!numbers(item, v)) return fail(item, "a place must be five numbers: x, y, z, degrees, scale");
            out_.places.push_back({out_.names.back().c_str(), {v[0], v[1], v[2]}, v[3] * kRadians, v[4]});
        }
    }
    void readGround(const Json& json) {
        if (!isObject(json, "'ground'", {"map", "low", "high"})) return;
        if (const Json* map = need(json, "map")) out_.map = file(*map);
        readCorner(json, "low", out_.ground.low);
        readCorner(json, "high", out_.ground.high);
    }
    void readCorner(const Json& json, const char* name, float (&out)[2]) {
        std::array<float, 2> corner{};
        const Json* found = need(json, name);
        if (found && !numbers(*found, corner)) fail(*found, std::string("'") + name + "' must be two numbers");
        std::ranges::copy(corner, out);
    }

    std::string path_;
    SiteFile& out_;
};

}  // namespace

bool readSiteFile(const std::string& path, SiteFile& out, std::string& error) {
    out = {};
    return SiteReader(path, out).read(error);
}

}  // namespace espalier::scene
