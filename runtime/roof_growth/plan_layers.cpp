// Enters: dabs, pictures, records. Leaves: texels of layers over a town's site, and the rectangles that have changed.
#include "runtime/roof_growth/plan_layers.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {
namespace {

constexpr float kAround = 4;     // metres of the site beyond its houses
constexpr float kTexel = 0.25f;  // metres
constexpr uint32_t kMostTexels = 2048, kLeastTexels = 128;
constexpr uint32_t kBlock = 8;

void boundsOf(const RoofHouse& house, glm::vec2& low, glm::vec2& high) {
    for (const auto& ring : house.rings)
        for (glm::vec2 p : ring) {
            const glm::vec2 world(float(house.origin.x) + p.x, float(-house.origin.y) - p.y);
            low = glm::min(low, world);
            high = glm::max(high, world);
        }
}

}  // namespace

void PlanRect::add(const PlanRect& r) {
    x0 = std::min(x0, r.x0);
    y0 = std::min(y0, r.y0);
    x1 = std::max(x1, r.x1);
    y1 = std::max(y1, r.y1);
}

PlanLayers::PlanLayers(const RoofStructure& structure) {
    glm::vec2 low(1e9f), high(-1e9f);
    for (const RoofHouse& house : structure.houses) boundsOf(house, low, high);
    if (low.x > high.x) low = high = glm::vec2(0);
    const float side = std::ceil(std::max(high.x - low.x, high.y - low.y) + 2 * kAround);
    site_.low = (low + high) * 0.5f - 0.5f * side;
    site_.size = kLeastTexels;
    while (site_.size < kMostTexels && float(site_.size) * kTexel < side) site_.size *= 2;
    site_.perMetre = float(site_.size) / side;
}

PlanLayer* PlanLayers::find(const std::string& name) {
    for (PlanLayer& layer : layers_)
        if (layer.name == name) return &layer;
    return nullptr;
}

PlanLayer& PlanLayers::make(const std::string& name, float fill, uint64_t number) {
    if (PlanLayer* known = find(name)) return *known;
    std::vector<float> texels(size_t(site_.size) * site_.size, fill);
    return layers_.emplace_back(PlanLayer{name, std::move(texels), number});
}

void PlanLayers::drop(const std::string& name) noexcept {
    std::erase_if(layers_, [&](const PlanLayer& layer) { return layer.name == name; });
}

PlanRect PlanLayers::rectOf(glm::vec2 low, glm::vec2 high) const {
    const auto texel = [&](float at, float add) {
        return uint32_t(std::clamp(std::floor(at) + add, 0.0f, float(site_.size)));
    };
    low = (low - site_.low) * site_.perMetre;
    high = (high - site_.low) * site_.perMetre;
    return {texel(low.x, 0), texel(low.y, 0), texel(high.x, 1), texel(high.y, 1)};
}

PlanRect PlanLayers::under(const RoofHouse& house, float reach) const {
    glm::vec2 low(1e9f), high(-1e9f);
    boundsOf(house, low, high);
    // A bilinear read takes in half a texel more, and beyond the site its border.
    PlanRect r = rectOf(low - reach - 0.5f / site_.perMetre, high + reach + 0.5f / site_.perMetre);
    r.x0 = std::min(r.x0, site_.size - 1);
    r.y0 = std::min(r.y0, site_.size - 1);
    r.x1 = std::max(r.x1, 1u);
    r.y1 = std::max(r.y1, 1u);
    return r;
}

float PlanLayers::mean(const PlanLayer& layer, const RoofHouse& house) const {
    const PlanRect r = under(house, 0);
    double sum = 0;
    for (uint32_t y = r.y0; y < r.y1; ++y)
        for (uint32_t x = r.x0; x < r.x1; ++x) sum += layer.texels[size_t(y) * site_.size + x];
    return float(sum / (double(r.x1 - r.x0) * double(r.y1 - r.y0)));
}

void PlanLayers::keep(const PlanLayer& layer, PlanRecord& kept, const PlanRect& rect) const {
    const uint32_t side = site_.size / kBlock;
    kept.holds.resize(size_t(side) * side);
    for (uint32_t by = rect.y0 / kBlock; by * kBlock < rect.y1; ++by)
        for (uint32_t bx = rect.x0 / kBlock; bx * kBlock < rect.x1; ++bx) {
            const uint32_t block = by * side + bx;
            if (kept.holds[block]) continue;
            // Where there is no memory for it the block isn't among those that are held.
            kept.texels.resize((kept.blocks.size() + 1) * kBlock * kBlock);
            kept.blocks.push_back(block);
            kept.holds[block] = true;
            float* to = &kept.texels[(kept.blocks.size() - 1) * kBlock * kBlock];
            for (uint32_t y = by * kBlock; y < (by + 1) * kBlock; ++y, to += kBlock)
                std::copy_n(&layer.texels[size_t(y) * site_.size + bx * kBlock], kBlock, to);
        }
}

PlanRect PlanLayers::below(const DabRecord& dab, float radius) const {
    const glm::vec2 at(dab.position.x, dab.position.z);
    return rectOf(at - radius, at + radius);
}

bool PlanLayers::meets(const BrushRecord& brush, std::span<const DabRecord> dabs) const {
    return std::ranges::any_of(dabs, [&](const DabRecord& dab) { return !below(dab, 1 / brush.perRadius).empty(); });
}

PlanRect PlanLayers::dabs(PlanLayer& layer, BrushRecord brush, bool smooths, std::span<const DabRecord> dabs,
                          PlanRecord& kept) {
    brush.flags = 0;
    const float radius = 1 / brush.perRadius;
    const int reach = std::max(1, int(kSmoothReach * radius * site_.perMetre + 0.5f)), last = int(site_.size) - 1;
    PlanRect all;
    for (const DabRecord& dab : dabs) {
        const PlanRect r = below(dab, radius);
        if (r.empty()) continue;
        keep(layer, kept, r);
        all.add(r);
        // The rows that smoothing reads, as they were.
        const int top = std::max(int(r.y0) - reach, 0), bottom = std::min(int(r.y1) + reach, last + 1);
        const auto row = [&](int y) { return layer.texels.begin() + ptrdiff_t(y) * ptrdiff_t(site_.size); };
        const std::vector<float> before = smooths ? std::vector<float>(row(top), row(bottom)) : std::vector<float>();
        const auto old = [&](int x, int y) {
            return before[size_t(std::clamp(y, 0, last) - top) * site_.size + size_t(std::clamp(x, 0, last))];
        };
        for (uint32_t y = r.y0; y < r.y1; ++y)
            for (uint32_t x = r.x0; x < r.x1; ++x) {
                const vec3 p(site_.low.x + (float(x) + 0.5f) / site_.perMetre, dab.position.y,
                             site_.low.y + (float(y) + 0.5f) / site_.perMetre);
                float& value = layer.texels[size_t(y) * site_.size + x];
                float target = brush.target;
                if (smooths) {
                    const int i = int(x), j = int(y);
                    target = 0.25f * (old(i - reach, j) + old(i + reach, j) + old(i, j - reach) + old(i, j + reach));
                }
                value = towards(value, target, dabWeight(brush, dab, p, vec3(0, 1, 0)));
            }
    }
    return all;
}

PlanRect PlanLayers::replace(PlanLayer& layer, std::span<const float> texels, PlanRecord& kept) {
    keep(layer, kept, whole());
    dropEqual(texels, kept);
    std::ranges::copy(texels, layer.texels.begin());
    return whole();
}

PlanRect PlanLayers::fill(PlanLayer& layer, float value, PlanRecord& kept) {
    keep(layer, kept, whole());
    std::ranges::fill(layer.texels, value);
    return whole();
}

PlanRect PlanLayers::swap(PlanLayer& layer, PlanRecord& kept) const {
    const uint32_t side = site_.size / kBlock;
    PlanRect all;
    for (size_t i = 0; i < kept.blocks.size(); ++i) {
        const uint32_t x = kept.blocks[i] % side * kBlock, y = kept.blocks[i] / side * kBlock;
        for (uint32_t row = 0; row < kBlock; ++row)
            std::swap_ranges(&kept.texels[(i * kBlock + row) * kBlock],
                             &kept.texels[(i * kBlock + row) * kBlock] + kBlock,
                             &layer.texels[size_t(y + row) * site_.size + x]);
        all.add({x, y, x + kBlock, y + kBlock});
    }
    return all;
}

void PlanLayers::close(const PlanLayer& layer, PlanRecord& kept) const {
    dropEqual(layer.texels, kept);
}

// Keeps the blocks that differ from `texels`.
void PlanLayers::dropEqual(std::span<const float> texels, PlanRecord& kept) const {
    const uint32_t side = site_.size / kBlock;
    PlanRecord changed;
    for (size_t i = 0; i < kept.blocks.size(); ++i) {
        const uint32_t x = kept.blocks[i] % side * kBlock, y = kept.blocks[i] / side * kBlock;
        const float* was = &kept.texels[i * kBlock * kBlock];
        bool same = true;
        for (uint32_t row = 0; row < kBlock; ++row)
            same = same &&
                   std::equal(was + row * kBlock, was + (row + 1) * kBlock, &texels[size_t(y + row) * site_.size + x]);
        if (same) continue;
        changed.blocks.push_back(kept.blocks[i]);
        changed.texels.insert(changed.texels.end(), was, was + kBlock * kBlock);
    }
    kept = std::move(changed);
}

}  // namespace espalier
