// In: bytes. Out: nothing, if all goes well; every roof that is made of the footprints in them must pass the check.
#include "runtime/roof/check.hpp"
#include "runtime/roof/shapes.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {

void roof(Bytes bytes) {
    auto town = parseFootprints({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzzed.json");
    if (!town) return checkMessage(town.failure());
    for (const Footprint& footprint : town->footprints) {
        RoofStructure made;
        std::vector<Diagnostic> said;
        bool any = appendRoof(footprint, made, said);
        require(any == !made.houses.empty(), "it says whether it made a house");
        require(any || !said.empty(), "what is left out has a reason");
        for (uint32_t house = 0; house < made.houses.size(); ++house)
            require(checkRoof(made, house).empty(), "a house passes the check");
    }
}

}  // namespace espalier::fuzz
