// Two files in, what differs out: how many pixels by more than the tolerance, where, and by how much at most.
#include "tools/compare/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace espalier::compare {
namespace {

using scene::FloatPicture;

constexpr size_t kChannels = 4;

// The largest difference of a pixel's channels, of 255; what is no number is like itself only.
struct Difference {
    float channels[kChannels];
    bool same = true;  // to the bit

    Difference(const float* a, const float* b) {
        for (size_t c = 0; c < kChannels; ++c) {
            const bool alike = a[c] == b[c] || (std::isnan(a[c]) && std::isnan(b[c]));
            const float d = alike ? 0 : 255 * std::abs(a[c] - b[c]);
            channels[c] = std::isnan(d) ? INFINITY : d;
            same = same && alike;
        }
    }
    float largest() const { return *std::max_element(channels, channels + kChannels); }
    bool within(int tolerance) const {
        constexpr float kRounding = 1e-3f;  // of parts that were whole numbers
        return same || (tolerance > 0 && largest() <= float(tolerance) + kRounding);
    }
    // Eight times as bright; what only alpha tells is seen as grey.
    void draw(uint8_t* rgba) const {
        for (size_t c = 0; c < 3; ++c) rgba[c] = uint8_t(std::min(255.f, 8 * std::max(channels[c], channels[3])));
    }
};

std::vector<uint8_t> bytesOf(const FloatPicture& picture) {
    std::vector<uint8_t> rgba(picture.rgba.size());
    // A number that isn't one becomes 0.
    std::transform(picture.rgba.begin(), picture.rgba.end(), rgba.begin(),
                   [](float value) { return uint8_t(std::lround(255 * (value > 0 ? std::min(value, 1.f) : 0))); });
    return rgba;
}

void measure(const FloatPicture& a, const FloatPicture& b, const Limits& limits, Comparison& out) {
    uint32_t left = a.width, top = a.height, right = 0, bottom = 0;
    std::vector<uint8_t>& drawn = out.pictures[2];
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = 0; x < a.width; ++x) {
            const size_t at = kChannels * (size_t(y) * a.width + x);
            const Difference difference(&a.rgba[at], &b.rgba[at]);
            out.largest = std::max(out.largest, difference.largest());
            if (!drawn.empty()) difference.draw(&drawn[at]);
            if (difference.within(limits.tolerance)) continue;
            ++out.beyond;
            left = std::min(left, x), right = std::max(right, x + 1);
            top = std::min(top, y), bottom = std::max(bottom, y + 1);
        }
    if (out.beyond > 0) out.box = {left, top, right - left, bottom - top};
    out.within = 1 - double(out.beyond) / (double(a.width) * double(a.height));
    out.measured = true;
}

std::string sizeOf(const FloatPicture& picture) {
    return std::to_string(picture.width) + " x " + std::to_string(picture.height);
}

}  // namespace

Comparison compareFiles(const std::string& first, const std::string& second, const Limits& limits, Kept kept) {
    Comparison out;
    out.name = second;
    out.first = first;
    out.second = second;
    FloatPicture a, b;
    if (!scene::readFloats(first, a, out.why) || !scene::readFloats(second, b, out.why)) return out;
    out.width = b.width, out.height = b.height;
    if (a.width != b.width || a.height != b.height) {
        out.verdict = Verdict::different;
        out.why = first + " is " + sizeOf(a) + ", " + second + " is " + sizeOf(b);
        return out;
    }
    if (kept.difference) out.pictures[2].assign(a.rgba.size(), 255);
    measure(a, b, limits, out);
    if (kept.both) out.pictures[0] = bytesOf(a), out.pictures[1] = bytesOf(b);
    out.verdict = out.within >= limits.share ? Verdict::alike : Verdict::different;
    if (out.verdict == Verdict::different) out.why = figuresOf(out, limits);
    return out;
}

std::string figuresOf(const Comparison& found, const Limits& limits) {
    char text[320];
    std::snprintf(text, sizeof text,
                  "%.5f of the pixels differ by at most %d, the largest difference is %.4g (wanted: %.5f; %.0f of %.0f "
                  "differ by more)",
                  found.within, limits.tolerance, double(found.largest), limits.share, double(found.beyond),
                  double(found.width) * double(found.height));
    std::string figures = text;
    if (found.beyond > 0) {
        std::snprintf(text, sizeof text, ", all within %u x %u pixels at %u, %u", found.box.width, found.box.height,
                      found.box.left, found.box.top);
        figures += text;
    }
    return figures;
}

}  // namespace espalier::compare
