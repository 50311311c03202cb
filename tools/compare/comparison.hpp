#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/scene/picture.hpp"

namespace espalier::compare {

struct Limits {
    int tolerance = 5;     // of 255, of each channel; 0: the same to the bit
    double share = 0.999;  // of the pixels that must be within it
};

// Pixels, the first row at the top.
struct Box {
    uint32_t left = 0, top = 0, width = 0, height = 0;  // width 0: nothing
};

enum class Verdict { alike, different, unknown };

// What came of two pictures. Where their sizes differ, or one is missing, `why` says so and nothing was measured.
struct Comparison {
    std::string name;           // of both, within their folders; of two files the second
    std::string first, second;  // files; empty: there is none
    Verdict verdict = Verdict::unknown;
    std::string why;  // one sentence; empty if they are alike
    bool measured = false;
    uint32_t width = 0, height = 0;
    double within = 0;                 // share of the pixels
    uint64_t beyond = 0;               // pixels that differ by more than the tolerance
    float largest = 0;                 // difference of a channel, of 255; infinite where one is no number
    Box box;                           // around those pixels
    std::vector<uint8_t> pictures[3];  // rgba of the first, the second and the differences; empty unless asked for
};

// Reads and compares two pictures. kept: what of Comparison::pictures is to stay.
struct Kept {
    bool both = false, difference = false;
};
Comparison compareFiles(const std::string& first, const std::string& second, const Limits& limits, Kept kept);

// "0.99000 of the pixels differ by at most 5 ...": what was measured.
std::string figuresOf(const Comparison& found, const Limits& limits);

}  // namespace espalier::compare
