#pragma once

#include <algorithm>
#include <vector>

namespace espalier::bakery {

// The least of the items' values that items of so much area don't exceed; the largest where there is less. At least one
// item, with a value and an area each; they are put in another order.
template <class Item>
double quantile(std::vector<Item>& items, double area) {
    auto low = items.begin(), high = items.end() - 1;
    while (low < high) {
        const auto middle = low + (high - low) / 2;
        std::nth_element(low, middle, high + 1, [](const Item& a, const Item& b) { return a.value < b.value; });
        double below = 0;
        for (auto i = low; i <= middle; ++i) below += i->area;
        if (below >= area)
            high = middle;
        else
            area -= below, low = middle + 1;
    }
    return low->value;
}

}  // namespace espalier::bakery
