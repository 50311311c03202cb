// In: bytes. Out: nothing, if all goes well; footprints are of finite numbers, and not too much is said of them.
#include <cmath>

#include "runtime/roof/footprint.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void town(Bytes bytes) {
    const auto read = parseFootprints(std::string(textOf(bytes)), "fuzzed.json");
    if (!read) return checkMessage(read.failure());
    require(read.value().diagnostics.size() <= kMostMessages + 1, "messages are bounded");
    for (const Footprint& footprint : read.value().footprints) {
        require(!footprint.rings.empty(), "a footprint has an outer ring");
        for (const auto& ring : footprint.rings)
            for (const glm::dvec2& corner : ring)
                require(std::isfinite(corner.x) && std::isfinite(corner.y), "corners are finite");
        for (const auto& number : {footprint.roofHeight, footprint.slope, footprint.direction, footprint.height,
                                   footprint.levels, footprint.roofLevels})
            require(!number || std::isfinite(*number), "what tags say is finite");
    }
}

}  // namespace espalier::fuzz
