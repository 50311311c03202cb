// In: bytes. Out: nothing, if all goes well; of a site that is accepted all numbers are finite, and places have a
// model.
#include <cmath>

#include "tests/fuzz/promise.hpp"
#include "tools/scene/site.hpp"

namespace espalier::fuzz {

void site(Bytes bytes) {
    const MemoryFile file(bytes);
    scene::SiteFile read;
    std::string error;
    if (!scene::readSiteFile(file.path(), read, error)) return require(!error.empty(), "a failure has a message");
    require(!read.models.empty(), "a site has models");
    for (const EspPropPlace& place : read.places) {
        require(place.model != nullptr && std::string_view(place.model).size() <= bytes.size(), "a place has a model");
        for (const float number : {place.position[0], place.position[1], place.position[2], place.turn, place.scale})
            require(std::isfinite(number), "a place is of finite numbers");
    }
}

}  // namespace espalier::fuzz
