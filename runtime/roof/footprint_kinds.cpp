// In: tags of a feature (wiki.openstreetmap.org, Key:building; Overture's buildings theme). Out: whether it is a house.
#include "runtime/roof/footprint_kinds.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "runtime/roof/footprint_values.hpp"

namespace espalier {

namespace {

// Keys that say what an area is. One of the first without a building is no house in any file; the others are names that
// tables of houses may well use for a column, and count where houses are told by a tag.
constexpr size_t kSureKinds = 14;
constexpr std::array kOtherKinds{"natural",  "water",    "waterway", "landuse",  "leisure",     "amenity",
                                 "highway",  "railway",  "aeroway",  "boundary", "parking",     "landcover",
                                 "golf",     "sport",    "place",    "tourism",  "barrier",     "power",
                                 "man_made", "historic", "shop",     "indoor",   "area:highway"};
// Buildings that don't stand, or don't stand yet.
constexpr std::array kGone{"proposed", "planned", "demolished", "razed", "removed", "destroyed"};
constexpr std::array kOpen{"roof", "carport", "canopy"};

constexpr size_t kMostReasons = 1000, kToldReasons = 8;

template <size_t N>
bool among(const std::string& text, const std::array<const char*, N>& words) {
    return std::find(words.begin(), words.end(), text) != words.end();
}

std::string shown(const FeatureTags& tags, const std::string& key) {
    const std::string value = tags.text(key).substr(0, 40);
    return value.empty() ? key : key + "=" + value;
}

double numberOr(const FeatureTags& tags, const char* key, double other) {
    const nlohmann::json* value = tags.find(key);
    return value ? readNumber(*value).value_or(other) : other;
}

// Says that it lies below the ground. A layer below 0 alone is doubtful: houses under a bridge have one, too. It
// counts where nothing says how far the house rises.
bool underground(const FeatureTags& tags) {
    const std::string location = tags.text("location");
    if (location == "underground" || location == "underwater" || tags.says("is_underground")) return true;
    const bool rises = tags.find("height") || tags.find("roof:height") || numberOr(tags, "roof:levels", 0) > 0 ||
                       numberOr(tags, "building:levels", 0) > 0;
    if (rises) return false;
    if (tags.text("parking") == "underground") return true;
    if (tags.find("building:levels") && numberOr(tags, "building:levels:underground", 0) > 0) return true;
    const bool above = location == "overground" || location == "surface" || location == "outdoor";
    return numberOr(tags, "layer", 0) < 0 && !above;
}

// Overture's themes beside its buildings.
bool ofAnotherTheme(const FeatureTags& tags) {
    const std::string theme = tags.text("theme");
    return !theme.empty() && theme != "buildings" && tags.find("type");
}

}  // namespace

bool namesBuilding(const FeatureTags& tags) {
    return tags.find("building") || tags.find("building:part");
}

std::optional<std::string> whyNoHouse(const FeatureTags& tags, Listing listing) {
    const bool building = tags.says("building"), part = tags.says("building:part");
    const std::string kind = building ? tags.text("building") : tags.text("building:part");
    if (!building && !part) {
        if (tags.find("building") && !readYes(*tags.find("building"))) return "building=no";
        if (ofAnotherTheme(tags)) return shown(tags, "theme");
        const size_t kinds = listing == Listing::plan ? 0 : listing == Listing::bare ? kSureKinds : kOtherKinds.size();
        for (size_t i = 0; i < kinds; ++i)
            if (tags.says(kOtherKinds[i])) return shown(tags, kOtherKinds[i]);
        if (listing == Listing::tagged) return "no tag building";
    }
    if (among(kind, kGone)) return "building=" + kind;
    if (underground(tags)) return "underground";
    return {};
}

bool isOpen(const FeatureTags& tags) {
    if (among(tags.text("building"), kOpen) || among(tags.text("building:part"), kOpen)) return true;
    for (const char* key : {"wall", "walls", "building:walls"})
        if (const nlohmann::json* value = tags.find(key); value && !readYes(*value)) return true;
    return false;
}

void LeftOut::add(std::string reason) {
    ++count_;
    if (reasons_.size() >= kMostReasons && !reasons_.count(reason)) reason = "other reasons";
    ++reasons_[reason];
}

std::string LeftOut::text() const {
    std::vector<std::pair<std::string, size_t>> all(reasons_.begin(), reasons_.end());
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string list;
    size_t told = 0;
    for (size_t i = 0; i < all.size() && i < kToldReasons; told += all[i++].second)
        list += (i ? ", " : "") + std::to_string(all[i].second) + " " + all[i].first;
    if (told < count_) list += ", " + std::to_string(count_ - told) + " for other reasons";
    return std::to_string(count_) +
           (count_ == 1 ? " feature is no house: left out (" : " features are no houses: left out (") + list + ")";
}

}  // namespace espalier
