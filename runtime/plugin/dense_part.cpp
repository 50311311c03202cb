// Enters: boxes of houses in the plan. Leaves: those in the densest square. A grid of sums tells in one step how much
// stands in a square of cells, so that all squares of all sizes are looked at.
#include "runtime/plugin/dense_part.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace espalier {
namespace {

constexpr int kCells = 64;  // along a side

// Metres. A wider square would be lost in haze. A square's houses count by its width and kUsual: without the latter one
// large house would be the densest part, with the former alone a town's outskirts would be all of it.
constexpr float kWidest = 2000, kUsual = 750;

class BuiltUp {
  public:
    explicit BuiltUp(std::span<const PlanBox> houses) {
        glm::vec2 high(-std::numeric_limits<float>::infinity());
        low_ = -high;
        for (const PlanBox& house : houses) low_ = glm::min(low_, house.low), high = glm::max(high, house.high);
        cell_ = std::max({high.x - low_.x, high.y - low_.y, 1e-3f}) / kCells;
        for (const PlanBox& house : houses) {
            const glm::ivec2 at = cellOf(house);
            const glm::vec2 size = house.high - house.low;
            sum(at.x + 1, at.y + 1) += std::sqrt(std::max(size.x * size.y, 1.0f));  // a hall isn't a hundred houses
        }
        for (int y = 1; y <= kCells; ++y)
            for (int x = 1; x <= kCells; ++x) sum(x, y) += sum(x - 1, y) + sum(x, y - 1) - sum(x - 1, y - 1);
    }

    struct Square {
        glm::ivec2 at{0};
        int side = 0;
    };
    // The widest of the densest.
    Square densest() const {
        Square best;
        double most = -1;
        for (int side = std::clamp(int(kWidest / cell_), 1, kCells); side > 0; --side)
            for (int y = 0; y + side <= kCells; ++y)
                for (int x = 0; x + side <= kCells; ++x) {
                    const double in = sum(x + side, y + side) - sum(x, y + side) - sum(x + side, y) + sum(x, y);
                    const double dense = in / double(float(side) * cell_ + kUsual);
                    if (dense > most * 1.0001) most = dense, best = {{x, y}, side};
                }
        return best;
    }
    bool holds(const Square& square, const PlanBox& house) const {
        const glm::ivec2 from = cellOf(house) - square.at;
        return from.x >= 0 && from.y >= 0 && from.x < square.side && from.y < square.side;
    }

  private:
    glm::ivec2 cellOf(const PlanBox& house) const {
        return glm::clamp(glm::ivec2(((house.low + house.high) * .5f - low_) / cell_), 0, kCells - 1);
    }
    double& sum(int x, int y) { return sums_[size_t(y) * (kCells + 1) + size_t(x)]; }
    double sum(int x, int y) const { return sums_[size_t(y) * (kCells + 1) + size_t(x)]; }

    glm::vec2 low_{0};
    float cell_ = 1;
    std::vector<double> sums_ = std::vector<double>(size_t(kCells + 1) * (kCells + 1));
};

}  // namespace

std::vector<size_t> densePart(std::span<const PlanBox> houses) {
    std::vector<size_t> in;
    if (houses.empty()) return in;
    const BuiltUp town(houses);
    const BuiltUp::Square square = town.densest();
    for (size_t i = 0; i < houses.size(); ++i)
        if (town.holds(square, houses[i])) in.push_back(i);
    return in;
}

}  // namespace espalier
