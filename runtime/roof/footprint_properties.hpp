#pragma once

// What a feature says of itself, whichever program wrote the file.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace espalier {

// Tags are looked for among the properties themselves (Overpass turbo, OSMnx, QuickOSM, a plan's keys), in an object
// `tags` (osmtogeojson), and in texts `other_tags`, `all_tags` or `tags` of the form "key"=>"value" or of JSON (GDAL,
// QGIS). `roof_shape` counts as `roof:shape`, and Overture's names as OpenStreetMap's. Refers to the feature.
class FeatureTags {
  public:
    // properties: an object, or anything else, which has no tags.
    explicit FeatureTags(const nlohmann::json& properties);
    FeatureTags(FeatureTags&&) = default;
    FeatureTags(const FeatureTags&) = delete;

    // The value of the key, by OpenStreetMap's name; null where it isn't given, or empty, as in tables.
    const nlohmann::json* find(const std::string& key) const;
    // Its text, in small letters; empty where it isn't given or is no text of a usual length.
    std::string text(const std::string& key) const;
    // Whether it is given and says neither "no" nor false.
    bool says(const std::string& key) const;

    // Calls each(key) for every key, by OpenStreetMap's spelling of the roof's.
    template <class Each>
    void forKeys(const Each& each) const {
        for (const nlohmann::json* source : sources_)
            for (const auto& item : source->items()) each(spelled(item.key()));
    }

  private:
    static std::string spelled(std::string key);

    std::vector<const nlohmann::json*> sources_;
    std::vector<std::unique_ptr<nlohmann::json>> parsed_;  // those sources that were texts
};

}  // namespace espalier
