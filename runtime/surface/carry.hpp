#pragma once

// What was painted over a surface, carried to another that was baked from the model after a change: charts lie
// elsewhere then, places in space don't.

#include <span>
#include <vector>

#include "runtime/surface/surface.hpp"
#include "runtime/surface/uv_picture.hpp"

namespace espalier {

struct CarriedLayer {
    UvPicture layer;   // over the walk's UV square, of the new surface's finest level; 0 beyond charts and gutters
    double fresh = 0;  // m² of new ground with no old one near
    double lost = 0;   // m² of old ground, painted above 0, that no new one is near
};

// Which place of one surface lies where on the other: the nearest one whose outside points the same way within 60°, not
// farther than `within` metres; 0: a hundredth of the new surface's radius, at least two texels.
class SurfaceMatch {
  public:
    SurfaceMatch(const SurfaceData& from, const SurfaceData& to, double within = 0);
    // fresh: what ground without an old place has.
    CarriedLayer carry(const UvPicture& layer, float fresh = 0) const;
    uint32_t size() const { return size_; }  // texels a side of the new surface's finest level

  private:
    struct Ground {
        uint32_t x, y;
        float area;       // m²; 0: gutter
        glm::vec2 other;  // place on the other surface's UV square; x < 0: none
    };
    static std::vector<Ground> match(const SurfaceData& here, const SurfaceData& there, double within);

    uint32_t size_;
    std::vector<Ground> new_, old_;
    uint32_t oldSize_;
};

// places: in the earlier surface's space.
// What became of the ground that places on or beside the earlier surface stand on: the nearest there is. lost: nothing
// of the new surface is as near to it as a SurfaceMatch of the same `within` asks.
struct CarriedPlace {
    float height = 0;  // metres from the place to the earlier surface
    bool lost = false;
};
std::vector<CarriedPlace> carryPlaces(const SurfaceData& from, const SurfaceData& to, std::span<const glm::vec3> places,
                                      double within = 0);

}  // namespace espalier
