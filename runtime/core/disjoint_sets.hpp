#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace espalier {

// Disjoint sets of 0 to n - 1, which are joined and found by path halving. A set's root is its least member, whatever
// the order of joins.
class DisjointSets {
  public:
    explicit DisjointSets(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

    uint32_t find(uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(uint32_t a, uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    // Numbers the sets by their first member, without gaps: into `out` for each member. Returns how many there are.
    uint32_t number(std::vector<uint32_t>& out) {
        uint32_t count = 0;
        out.resize(parent_.size());
        for (uint32_t i = 0; i < parent_.size(); ++i) {
            const uint32_t root = find(i);
            out[i] = root == i ? count++ : out[root];
        }
        return count;
    }

    // The same in the room that the sets have taken, without those that don't count, as sets of one are: `none` for
    // them.
    template <class Counts>
    std::vector<uint32_t> takeNumbers(Counts&& counts, uint32_t none, uint32_t& count) && {
        count = 0;
        for (uint32_t i = 0; i < parent_.size(); ++i)  // a parent comes before, and has its number already
            parent_[i] = parent_[i] != i ? parent_[parent_[i]] : counts(i) ? count++ : none;
        return std::move(parent_);
    }

  private:
    std::vector<uint32_t> parent_;
};

}  // namespace espalier
