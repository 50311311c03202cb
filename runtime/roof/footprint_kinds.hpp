#pragma once

// Which features of a file are houses.

#include <map>
#include <optional>
#include <string>

#include "runtime/core/result.hpp"
#include "runtime/roof/footprint_properties.hpp"

namespace espalier {

// What the file as a whole says of its features.
enum class Listing {
    tagged,  // some feature has a tag `building` or `building:part`: only such ones are houses
    bare,    // none has: all are houses but those that say what else they are (a cadastre's footprints)
    plan     // a list of buildings
};

// Whether the feature has a tag `building` or `building:part`, whatever it says.
bool namesBuilding(const FeatureTags& tags);

// Why the feature is no house that can be seen, in a word or two; none: it is one.
std::optional<std::string> whyNoHouse(const FeatureTags& tags, Listing listing);

// A roof on posts: building=roof, a carport, wall=no.
bool isOpen(const FeatureTags& tags);

// Features that were left out, by reason.
class LeftOut {
  public:
    void add(std::string reason);
    bool empty() const { return count_ == 0; }
    // One line: how many, and why.
    std::string text() const;

  private:
    std::map<std::string, size_t> reasons_;
    size_t count_ = 0;
};

}  // namespace espalier
