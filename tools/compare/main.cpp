// Two pictures in, whether they are alike out: the share of pixels whose channels all differ by at most the
// tolerance must reach the wanted share. Exit code 0: alike, 1: not alike, 2: can't tell.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tools/scene/picture.hpp"

using namespace espalier::scene;

int main(int argc, char** argv) {
    CLI::App app{"Compares two pictures pixel by pixel.", "espalier-compare"};
    app.set_version_flag("--version", ESPALIER_VERSION);
    std::string first, second, diff;
    int tolerance = 5;
    double share = 0.999;
    app.add_option("A", first, "a picture")->required();
    app.add_option("B", second, "the picture to compare it with")->required();
    app.add_option("--tolerance", tolerance, "how far a channel may differ, of 255")
        ->capture_default_str()
        ->check(CLI::Range(0, 255));
    app.add_option("--share", share, "the share of pixels that must be within it")
        ->capture_default_str()
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--diff", diff, "writes a PNG of the differences, brightest where they are largest");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) ? 2 : 0;
    }

    ColourPicture a, b;
    std::string error;
    if (!readColour(first, a, error) || !readColour(second, b, error)) {
        std::fprintf(stderr, "espalier-compare: %s\n", error.c_str());
        return 2;
    }
    if (a.width != b.width || a.height != b.height) {
        std::fprintf(stderr, "espalier-compare: %s is %u x %u, %s is %u x %u\n", first.c_str(), a.width, a.height,
                     second.c_str(), b.width, b.height);
        return 1;
    }
    const size_t pixels = size_t(a.width) * a.height;
    std::vector<uint8_t> picture(pixels * 4, 255);
    size_t within = 0;
    int largest = 0;
    for (size_t i = 0; i < pixels; ++i) {
        int difference = 0;
        for (size_t c = 4 * i; c < 4 * i + 3; ++c) {
            const int d = std::abs(int(a.rgba[c]) - int(b.rgba[c]));
            picture[c] = uint8_t(std::min(255, 8 * d));
            difference = std::max(difference, d);
        }
        within += difference <= tolerance;
        largest = std::max(largest, difference);
    }
    const double part = double(within) / double(pixels);
    const bool alike = part >= share;
    std::printf("%s: %.5f of the pixels differ by at most %d, the largest difference is %d (wanted: %.5f)\n",
                alike ? "alike" : "not alike", part, tolerance, largest, share);
    if (!diff.empty() && !writePng(diff, picture.data(), a.width, a.height, error)) {
        std::fprintf(stderr, "espalier-compare: %s\n", error.c_str());
        return 2;
    }
    return alike ? 0 : 1;
}
