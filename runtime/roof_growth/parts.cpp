// An outline -> convex parts (Buron 2013 §3.3, beyond its convex quadrilaterals). Upright lines through all corners cut
// it into trapezoids; neighbours are joined again as long as they stay convex and within the planes that clipping has.
#include <algorithm>
#include <cmath>

#include "runtime/roof_growth/atoms.hpp"

namespace espalier {
namespace {

constexpr float kSame = 1e-4f;                  // metres
constexpr size_t kOwnPlanes = kPartPlanes - 2;  // two are left for cuts

struct Trapezoid {
    float x0, x1;
    uint32_t low, high;  // edges
};
struct OpenPart {
    float x0, x1;
    std::vector<uint32_t> low, high;  // edges, from left to right
    bool closed = false, cutLeft = false, cutRight = false;
};

float heightAt(const OutlineEdge& e, float x) {
    const float d = e.to.x - e.from.x;
    return std::abs(d) < 1e-9f ? e.from.y : e.from.y + (e.to.y - e.from.y) * ((x - e.from.x) / d);
}
float slopeOf(const OutlineEdge& e) {
    return (e.to.y - e.from.y) / (e.to.x - e.from.x);
}

class Cutter {
  public:
    explicit Cutter(std::span<const OutlineEdge> edges) : edges_(edges) {}

    std::vector<OpenPart> run() {
        std::vector<float> xs;
        for (const OutlineEdge& e : edges_) xs.push_back(e.from.x);
        std::sort(xs.begin(), xs.end());
        xs.erase(std::unique(xs.begin(), xs.end(), [](float a, float b) { return b - a < kSame; }), xs.end());
        for (size_t i = 0; i + 1 < xs.size(); ++i) slab(xs[i], xs[i + 1]);
        return std::move(parts_);
    }

  private:
    void slab(float x0, float x1) {
        const float middle = 0.5f * (x0 + x1);
        std::vector<std::pair<float, uint32_t>> crossed;
        for (uint32_t i = 0; i < edges_.size(); ++i) {
            const float a = std::min(edges_[i].from.x, edges_[i].to.x), b = std::max(edges_[i].from.x, edges_[i].to.x);
            if (a < middle && b > middle) crossed.emplace_back(heightAt(edges_[i], middle), i);
        }
        std::sort(crossed.begin(), crossed.end());
        std::vector<OpenPart> begun;
        std::vector<bool> gone(parts_.size(), false);
        for (size_t i = 0; i + 1 < crossed.size(); i += 2) {
            const Trapezoid t{x0, x1, crossed[i].second, crossed[i + 1].second};
            if (!joinTo(t, gone)) begun.push_back(newPart(t));
        }
        for (OpenPart& p : parts_) p.closed = p.closed || p.x1 < x1;
        parts_.insert(parts_.end(), begun.begin(), begun.end());
    }
    // True if the trapezoid goes on from a part on its left.
    bool joinTo(const Trapezoid& t, std::vector<bool>& gone) {
        for (size_t i = 0; i < gone.size(); ++i) {
            OpenPart& p = parts_[i];
            if (p.closed || gone[i] || std::abs(p.x1 - t.x0) > kSame) continue;
            const OutlineEdge &low = edges_[p.low.back()], &high = edges_[p.high.back()];
            if (std::abs(heightAt(low, t.x0) - heightAt(edges_[t.low], t.x0)) > kSame) continue;
            if (std::abs(heightAt(high, t.x0) - heightAt(edges_[t.high], t.x0)) > kSame) continue;
            const bool sameLow = p.low.back() == t.low, sameHigh = p.high.back() == t.high;
            if (!sameLow && slopeOf(edges_[t.low]) < slopeOf(low) - 1e-5f) continue;
            if (!sameHigh && slopeOf(edges_[t.high]) > slopeOf(high) + 1e-5f) continue;
            if (p.low.size() + p.high.size() + (sameLow ? 0 : 1) + (sameHigh ? 0 : 1) > kOwnPlanes) continue;
            if (!sameLow) p.low.push_back(t.low);
            if (!sameHigh) p.high.push_back(t.high);
            p.x1 = t.x1;
            gone[i] = true;
            return true;
        }
        return false;
    }
    OpenPart newPart(const Trapezoid& t) {
        OpenPart part{t.x0, t.x1, {t.low}, {t.high}};
        const float low = heightAt(edges_[t.low], t.x0), high = heightAt(edges_[t.high], t.x0);
        for (OpenPart& p : parts_) {
            if (std::abs(p.x1 - t.x0) > kSame) continue;
            const float l = heightAt(edges_[p.low.back()], t.x0), h = heightAt(edges_[p.high.back()], t.x0);
            if (std::min(h, high) - std::max(l, low) > kSame) part.cutLeft = p.cutRight = true;
        }
        return part;
    }
    std::span<const OutlineEdge> edges_;
    std::vector<OpenPart> parts_;
};

}  // namespace

void cutIntoParts(std::span<const OutlineEdge> edges, std::vector<RoofPart>& parts, std::vector<vec4>& planes) {
    for (const OpenPart& p : Cutter(edges).run()) {
        const uint32_t first = uint32_t(planes.size());
        std::vector<uint32_t> own = p.low;
        own.insert(own.end(), p.high.begin(), p.high.end());
        std::sort(own.begin(), own.end());
        own.erase(std::unique(own.begin(), own.end()), own.end());
        // Upright edges end it where nothing goes on.
        for (uint32_t i = 0; i < edges.size(); ++i) {
            if (std::abs(edges[i].from.x - edges[i].to.x) > kSame) continue;
            const bool left = !p.cutLeft && std::abs(edges[i].from.x - p.x0) < kSame && edges[i].to.y < edges[i].from.y;
            const bool right =
                !p.cutRight && std::abs(edges[i].from.x - p.x1) < kSame && edges[i].to.y > edges[i].from.y;
            const float low = std::min(edges[i].from.y, edges[i].to.y), high = std::max(edges[i].from.y, edges[i].to.y);
            const float x = left ? p.x0 : p.x1;
            const uint32_t below = left ? p.low.front() : p.low.back(), above = left ? p.high.front() : p.high.back();
            const bool meets =
                std::min(high, heightAt(edges[above], x)) - std::max(low, heightAt(edges[below], x)) > kSame;
            // A side that ends upright has no cut, whose plane it takes.
            const size_t cuts = (p.cutLeft ? 1 : 0) + (p.cutRight ? 1 : 0);
            if ((left || right) && meets && own.size() + cuts < kPartPlanes) own.push_back(i);
        }
        for (uint32_t i : own)
            if (!edges[i].open && !edges[i].seam) planes.push_back(edges[i].plane);
        const uint32_t ownCount = uint32_t(planes.size()) - first;
        for (uint32_t i : own)
            if (edges[i].seam) planes.push_back(edges[i].plane);
        if (p.cutLeft) planes.emplace_back(-1, 0, 0, -p.x0);
        if (p.cutRight) planes.emplace_back(1, 0, 0, p.x1);
        parts.push_back({p.x0, p.x1, first, (uint32_t(planes.size()) - first) | (ownCount << 8)});
    }
}

}  // namespace espalier
