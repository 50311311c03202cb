#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"

namespace espalier::scene {

// How its roof is dressed, as of EspHouseLook.
struct HouseLook {
    std::string covering = "any";    // as of nameOf(EspCovering)
    std::vector<float> colour = {};  // red, green, blue, linear; none: as the grammar says
    float overhang = 0;              // metres; 0: as the grammar says
    std::string chimneys = "any";    // or "none", "all"
    template <class V>
    void fields(V&& v) {
        v("covering", covering), v("colour", colour), v("overhang", overhang), v("chimneys", chimneys);
    }
    bool operator==(const HouseLook&) const = default;
};

// A house of a town as a designer wants it, whatever the town's file says.
struct House {
    uint32_t index = 0;         // in the town
    std::string shape = "hip";  // as of nameOf(EspRoofShape)
    float slope = 0;            // tangent of the pitch; 0: the shape's own
    float eaveHeight = 0;       // metres above the house's base; 0: as it is
    struct Edge {
        uint32_t edge = 0;     // from this corner to the next
        std::string end = {};  // "gable", "eave", or as the shape says
        float slope = 0;       // 0: as the shape says
        template <class V>
        void fields(V&& v) {
            v("edge", edge), v("end", end), v("slope", slope);
        }
        bool operator==(const Edge&) const = default;
    };
    std::vector<Edge> edges = {};                    // that have something of their own
    std::vector<std::array<float, 2>> corners = {};  // world x and z, of all rings; none: as they are
    // How many of them each ring has, the outer one first; none: all are the outer one's, courtyards stay.
    std::vector<uint32_t> rings = {};
    std::optional<HouseLook> look = {};  // none: as it is
    std::string id = {};                 // that a project knows it by, whatever its place is then; no part of a run
    template <class V>
    void fields(V&& v) {
        v("house", index), v("shape", shape), v("slope", slope), v("eave_height", eaveHeight), v("edges", edges);
        v("corners", corners), v.optional("rings", rings), v.optional("look", look);
    }
    bool operator==(const House&) const = default;
};

// Corners from `first` to before `end`.
struct Ring {
    size_t first = 0, end = 0, number = 0;
    size_t after(size_t corner) const { return corner + 1 == end ? first : corner + 1; }
    size_t before(size_t corner) const { return corner == first ? end - 1 : corner - 1; }
    size_t size() const { return end - first; }
};
// Of a corner, which there must be.
Ring ringOf(const House& house, size_t corner);

// As it stands; without edges and corners if there is no such house.
House houseNow(const EspContext* context, uint32_t index);
// With what it leaves out as that stands: so the record says all of the house, whatever becomes of it meanwhile.
House completed(const EspContext* context, House house);
// False: `error` tells why, and the house stands as it did.
bool setHouse(EspContext* context, const House& house, std::string& error);

// What the town's layers lie over: from `low`, x and z, so many metres to the east and to the south. A plan that has
// got or lost houses has another.
struct TownSquare {
    std::array<float, 2> low{};
    float side = 0;
    bool operator==(const TownSquare&) const = default;
};
// None without a town.
std::optional<TownSquare> squareOf(const EspContext* context);

// A layer that can be painted over the town: its grammar reads it, or it was painted before.
struct TownLayer {
    std::string name;
    float fill = 0;  // where nothing is painted
    bool painted = false;
};
// In the grammar's order; empty without a town.
std::vector<TownLayer> townLayers(const EspContext* context);

bool shapeNamed(const std::string& name, EspRoofShape& out);
const char* nameOf(EspRoofShape shape);
bool coveringNamed(const std::string& name, EspCovering& out);
const char* nameOf(EspCovering covering);
bool chimneysNamed(const std::string& name, EspChimneys& out);
const char* nameOf(EspChimneys chimneys);

}  // namespace espalier::scene
