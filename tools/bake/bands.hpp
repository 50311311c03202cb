#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/core/jobs.hpp"

namespace espalier::bakery {

inline constexpr uint32_t kBandRows = 64;

// What touches each band of kBandRows of an image's rows, so that a thread that draws a band needn't look at
// everything.
class Bands {
  public:
    // rows(i): the lowest and the highest row that item i touches, as a pair of doubles; may lie outside of the image.
    template <class Rows>
    Bands(size_t count, uint32_t size, Rows&& rows) {
        const uint32_t bands = (size + kBandRows - 1) / kBandRows;
        std::vector<std::pair<uint32_t, uint32_t>> touched(count);  // first band, one after the last
        parallelFor(count, 16384, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const auto [low, high] = rows(i);
                touched[i] = {uint32_t(std::clamp(std::floor(low / kBandRows), 0.0, double(bands))),
                              uint32_t(std::clamp(std::floor(high / kBandRows) + 1, 0.0, double(bands)))};
            }
        });
        first_.assign(bands + 1, 0);
        for (const auto& [from, to] : touched)
            for (uint32_t b = from; b < to; ++b) ++first_[b + 1];
        for (uint32_t b = 0; b < bands; ++b) first_[b + 1] += first_[b];
        items_.resize(first_[bands]);
        std::vector<uint32_t> at(first_.begin(), first_.end() - 1);
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t b = touched[i].first; b < touched[i].second; ++b) items_[at[b]++] = i;
    }

    // Items of the band that begins with this row, ascending.
    std::span<const uint32_t> at(size_t row) const {
        const size_t band = row / kBandRows;
        return {items_.data() + first_[band], first_[band + 1] - first_[band]};
    }

  private:
    std::vector<uint32_t> first_, items_;
};

}  // namespace espalier::bakery
