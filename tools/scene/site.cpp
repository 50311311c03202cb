// A site's file -> props and the ground's map in a context.
#include "tools/scene/site.hpp"

#include <deque>
#include <filesystem>

#include "tools/scene/json_tree.hpp"
#include "tools/scene/picture.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

class Site {
  public:
    explicit Site(std::string path) : path_(std::move(path)) {}

    bool read(std::string& error) {
        std::string text;
        Json json;
        if (!readText(path_, text, error)) return false;
        if (!readJson(text, json, error)) {
            error = path_ + ":" + error;
            return false;
        }
        const Json* models = member(json, "models", Json::Kind::text);
        const Json* props = member(json, "props", Json::Kind::object);
        const Json* ground = json.find("ground");
        if (models) models_ = beside(models->text);
        if (props)
            for (const auto& [name, places] : props->members) readPlaces(name, places);
        if (ground) readGround(*ground);
        error = error_;
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
    void fail(const Json& at, const std::string& message) {
        if (error_.empty())
            error_ = path_ + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " + message;
    }
    const Json* member(const Json& json, const char* name, Json::Kind kind) {
        const Json* found = json.find(name);
        if (found && found->kind == kind) return found;
        fail(found ? *found : json, std::string("'") + name + "' is missing or of another kind");
        return nullptr;
    }
    std::string beside(const std::string& name) const {
        return (std::filesystem::path(path_).parent_path() / name).lexically_normal().string();
    }
    bool numbers(const Json& json, size_t count, float* out) {
        bool good = json.kind == Json::Kind::list && json.items.size() == count;
        for (size_t i = 0; good && i < count; ++i) {
            good = json.items[i].kind == Json::Kind::number;
            out[i] = float(json.items[i].number);
        }
        if (!good) fail(json, "a list of " + std::to_string(count) + " numbers must stand here");
        return good;
    }
    // A model's places: x, y, z, degrees about the vertical, scale.
    void readPlaces(const std::string& name, const Json& json) {
        constexpr float kRadians = 3.14159265f / 180;
        names_.push_back(name);
        if (json.kind != Json::Kind::list) fail(json, "a model's places must be a list");
        for (const Json& item : json.items) {
            float v[5];
            if (!numbers(item, 5, v)) return;
            places_.push_back({names_.back().c_str(), {v[0], v[1], v[2]}, v[3] * kRadians, v[4]});
        }
    }
    void readGround(const Json& json) {
        const Json* map = member(json, "map", Json::Kind::text);
        const Json* low = member(json, "low", Json::Kind::list);
        const Json* high = member(json, "high", Json::Kind::list);
        if (!map || !low || !high || !numbers(*low, 2, def_.low) || !numbers(*high, 2, def_.high)) return;
        map_ = beside(map->text);
    }

    std::string path_, models_, map_, error_;
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
