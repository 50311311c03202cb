#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/grammar/grammar.hpp"
#include "shaders/render/frame_records.h"

namespace espalier {

// What the view of a layer shows by this name: number(name, others), a layer's number or nothing, where it must be none
// of `others`; of a layer of colours those of its channels by colourLayers. kNoIndex: there is neither.
template <class Number>
uint32_t shownLayers(const std::string& name, Number&& number) {
    std::vector<uint32_t> numbers;
    if (const std::optional<uint32_t> grey = number(name, numbers)) return *grey;
    for (const char* channel : kChannels)
        if (const std::optional<uint32_t> one = number(name + channel, numbers)) numbers.push_back(*one);
    return numbers.size() == 3 ? colourLayers(numbers[0], numbers[1], numbers[2]) : kNoIndex;
}

}  // namespace espalier
