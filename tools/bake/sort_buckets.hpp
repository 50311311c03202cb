#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace espalier::bakery {

// Sorts by `less`, a total order that asks for key(item) < keys first: a counting sort by the key, and what has one key
// by itself. Quick where few items share a key, as few edges and triangles share a least point.
template <class Item, class Key, class Less>
void sortBuckets(std::vector<Item>& items, size_t keys, Key&& key, Less&& less) {
    std::vector<uint32_t> first(keys + 1, 0);
    for (const Item& item : items) ++first[key(item) + 1];
    for (size_t k = 0; k < keys; ++k) first[k + 1] += first[k];
    std::vector<uint32_t> at(first.begin(), first.end() - 1);
    std::vector<Item> sorted(items.size());
    for (const Item& item : items) sorted[at[key(item)]++] = item;
    for (size_t k = 0; k < keys; ++k)
        if (first[k + 1] - first[k] > 1) std::sort(sorted.begin() + first[k], sorted.begin() + first[k + 1], less);
    items.swap(sorted);
}

}  // namespace espalier::bakery
