// Two pictures in, whether they are alike out: the share of pixels whose channels all differ by at most the
// tolerance must reach the wanted share. Exit code 0: alike, 1: not alike, 2: can't tell.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <new>

#include "tools/command_line.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::scene;

namespace {

constexpr size_t kChannels = 4;

struct Comparison {
    double within = 0;                // share of the pixels
    float largest = 0;                // difference of a channel, of 255
    std::vector<uint8_t> difference;  // as a picture
};

// tolerance: of 255; 0: only what is the same to the bit is within it. What is no number is like itself only. shown:
// with the picture.
Comparison compare(const FloatPicture& a, const FloatPicture& b, int tolerance, bool shown) {
    constexpr float kRounding = 1e-3f;  // of parts that were whole numbers
    Comparison out;
    const size_t pixels = size_t(a.width) * a.height;
    if (shown) out.difference.assign(pixels * kChannels, 255);
    size_t within = 0;
    for (size_t i = 0; i < pixels; ++i) {
        bool near = true;
        float pixel[kChannels];
        for (size_t c = 0; c < kChannels; ++c) {
            const float x = a.rgba[kChannels * i + c], y = b.rgba[kChannels * i + c];
            const bool same = x == y || (std::isnan(x) && std::isnan(y));
            const float d = same ? 0 : std::abs(x - y);
            pixel[c] = std::isnan(d) ? INFINITY : 255 * d;
            near = near && (same || (tolerance > 0 && pixel[c] <= float(tolerance) + kRounding));
            out.largest = std::max(out.largest, pixel[c]);
        }
        // What only alpha tells is seen as grey.
        for (size_t c = 0; shown && c < 3; ++c)
            out.difference[kChannels * i + c] = uint8_t(std::min(255.f, 8 * std::max(pixel[c], pixel[3])));
        within += near;
    }
    out.within = double(within) / double(pixels);
    return out;
}

int fail(const std::string& message) {
    std::fprintf(stderr, "espalier-compare: %s\n", message.c_str());
    return 2;
}

struct Question {
    std::string first, second, diff;
    int tolerance = 5;
    double share = 0.999;
};

int answer(const Question& asked) {
    FloatPicture a, b;
    std::string error;
    if (!readFloats(asked.first, a, error) || !readFloats(asked.second, b, error)) return fail(error);
    if (a.width != b.width || a.height != b.height) {
        std::fprintf(stderr, "espalier-compare: %s is %u x %u, %s is %u x %u\n", asked.first.c_str(), a.width, a.height,
                     asked.second.c_str(), b.width, b.height);
        return 1;
    }
    const Comparison found = compare(a, b, asked.tolerance, !asked.diff.empty());
    const bool alike = found.within >= asked.share;
    const double pixels = double(a.width) * double(a.height);
    std::printf(
        "%s: %.5f of the pixels differ by at most %d, the largest difference is %.4g (wanted: %.5f; %.0f of %.0f "
        "differ by "
        "more)\n",
        alike ? "alike" : "not alike", found.within, asked.tolerance, double(found.largest), asked.share,
        std::round((1 - found.within) * pixels), pixels);
    if (!asked.diff.empty() && !writePng(asked.diff, found.difference.data(), a.width, a.height, error))
        return fail(error);
    return alike ? 0 : 1;
}

int compareAsAsked(int argc, char** argv) {
    CLI::App app{
        "Compares two pictures pixel by pixel, alpha too. Ends with 0: alike, 1: not alike, also by their sizes, 2: "
        "can't tell.",
        "espalier-compare"};
    app.set_version_flag("--version", ESPALIER_VERSION);
    Question asked;
    const auto isShare = [](const std::string& text) {
        char* end = nullptr;
        const double value = std::strtod(text.c_str(), &end);
        return end != text.c_str() && *end == 0 && value >= 0 && value <= 1
                   ? ""
                   : "'" + text + "' isn't a share from 0 to 1";
    };
    app.add_option("A", asked.first, "a picture")->required();
    app.add_option("B", asked.second, "the picture to compare it with")->required();
    app.add_option("--tolerance", asked.tolerance, "how far a channel may differ, of 255; 0: not by a bit, in EXR too")
        ->capture_default_str()
        ->check(CLI::Range(0, 255));
    app.add_option("--share", asked.share, "the share of pixels that must be within it")
        ->capture_default_str()
        ->check(isShare, "FLOAT in [0 - 1]");
    app.add_option("--diff", asked.diff, "writes a PNG of the differences, brightest where they are largest");
    if (const auto ends = espalier::parseCommandLine(app, argc, argv)) return *ends;

    if (espalier::writtenOver({asked.first, asked.second}, {asked.diff}))
        return fail("--diff " + asked.diff + " would overwrite a picture to compare");
    const std::filesystem::path ending = std::filesystem::path(asked.diff).extension();
    if (!ending.empty() && ending != ".png") return fail("--diff writes .png, not '" + asked.diff + "'");
    try {
        return answer(asked);
    } catch (const std::bad_alloc&) {
        return fail("there is too little memory to compare " + asked.first + " with " + asked.second);
    }
}

}  // namespace

int main(int argc, char** argv) {
    return espalier::runProgram(
        "espalier-compare", [&] { return compareAsAsked(argc, argv); }, 2);
}
