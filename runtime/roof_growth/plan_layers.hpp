#pragma once

// Painted layers over a town's site, seen from above. They lie on the CPU: a dab reaches few of their texels.

#include <deque>
#include <span>
#include <string>
#include <vector>

#include "runtime/roof/structure.hpp"
#include "shaders/paint/brush.h"
#include "shaders/shared/roof_records.h"

namespace espalier {

struct PlanLayer {
    std::string name;
    std::vector<float> texels;  // site.size² of 0 to 1, see RoofSite
    uint64_t number = 0;        // the caller's
    int strokes = 0;            // likewise
};

// Texels [x0, x1) × [y0, y1).
struct PlanRect {
    uint32_t x0 = ~0u, y0 = ~0u, x1 = 0, y1 = 0;
    bool empty() const { return x0 >= x1 || y0 >= y1; }
    void add(const PlanRect& r);
    PlanRect within(const PlanRect& r) const {
        return {std::max(x0, r.x0), std::max(y0, r.y0), std::min(x1, r.x1), std::min(y1, r.y1)};
    }
    bool meets(const PlanRect& r) const { return x0 < r.x1 && r.x0 < x1 && y0 < r.y1 && r.y0 < y1; }
};

// What blocks of 8×8 texels held before a stroke touched them.
struct PlanRecord {
    std::vector<uint32_t> blocks;
    std::vector<float> texels;
    std::vector<bool> holds;  // [block], until close()
    uint64_t bytes() const { return blocks.size() * 4 + texels.size() * 4; }
};

class PlanLayers {
  public:
    PlanLayers() = default;
    // A square that holds all houses and 4 m around them, with texels of a quarter of a metre where 2,048 a side do.
    explicit PlanLayers(const RoofStructure& structure);

    const RoofSite& site() const { return site_; }
    PlanLayer* find(const std::string& name);
    const PlanLayer* find(const std::string& name) const { return const_cast<PlanLayers*>(this)->find(name); }
    // The layer, made if need be, all of it `fill`. It stays where it is in memory until one is dropped.
    PlanLayer& make(const std::string& name, float fill, uint64_t number = 0);
    void drop(const std::string& name) noexcept;
    const std::deque<PlanLayer>& all() const { return layers_; }
    PlanRect whole() const { return {0, 0, site_.size, site_.size}; }

    // Whether any of the dabs reaches a texel.
    bool meets(const BrushRecord& brush, std::span<const DabRecord> dabs) const;
    // These return what may have changed; blocks that the record doesn't hold yet are kept in it first.
    // A dab paints what lies below it, whatever its height; limits of slope, height and side don't count.
    PlanRect dabs(PlanLayer& layer, BrushRecord brush, bool smooths, std::span<const DabRecord> dabs, PlanRecord& kept);
    // Closes the record; where there is no memory for it, the layer stays as it is.
    PlanRect replace(PlanLayer& layer, std::span<const float> texels, PlanRecord& kept);
    PlanRect fill(PlanLayer& layer, float value, PlanRecord& kept);
    // Exchanges what the record holds with the layer: twice is as before.
    PlanRect swap(PlanLayer& layer, PlanRecord& kept) const;
    // Drops from a record what is as it was.
    void close(const PlanLayer& layer, PlanRecord& kept) const;

    // Texels that a house and what it reaches over read: where it lies beyond the site, some of the border.
    PlanRect under(const RoofHouse& house, float reach) const;
    // The mean over the house's bounds.
    float mean(const PlanLayer& layer, const RoofHouse& house) const;

  private:
    void keep(const PlanLayer& layer, PlanRecord& kept, const PlanRect& rect) const;
    void dropEqual(std::span<const float> texels, PlanRecord& kept) const;
    PlanRect rectOf(glm::vec2 low, glm::vec2 high) const;
    PlanRect below(const DabRecord& dab, float radius) const;

    RoofSite site_{{0, 0}, 1, 8};
    std::deque<PlanLayer> layers_;
};

}  // namespace espalier
