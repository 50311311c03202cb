// A camera that comes nearer, goes around or walks by small steps: no step changes much more of the picture than those
// around it.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <vector>

#include "tests/tools/program.hpp"

namespace {

using Point = std::array<double, 3>;
struct View {
    Point eye, target;
};

constexpr int kFrames = 22, kNeighbours = 10;
constexpr Point kCourt{0.05, 1.62, 1.3};  // what the sample's own view looks at

// Pixels that differ by more than 40 of 255.
long changed(const std::string& a, const std::string& b) {
    const Ran ran = run(program("espalier-compare") + " " + a + " " + b + " --tolerance 40 --share 0");
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    const size_t at = ran.output.find("; ", ran.output.find("wanted"));
    REQUIRE(at != std::string::npos);
    return std::atol(ran.output.c_str() + at + 2);
}

// A recorded run of the sample that shows one view a frame.
std::string recorded(const std::function<View(int)>& view) {
    std::string text = R"({"espalier_run": 1, "scene": ")" + content("sample.json") +
                       "\", \"width\": 320, \"height\": 180, \"step\": 0.0333}\n";
    for (int i = 0; i < kFrames; ++i) {
        const auto [eye, target] = view(i);
        char line[256];
        std::snprintf(line, sizeof line,
                      "{\"frame\": %d, \"camera\": {\"eye\": [%.6f, %.6f, %.6f], \"target\": [%.6f, %.6f, %.6f], "
                      "\"fov\": 0.66}}\n",
                      i, eye[0], eye[1], eye[2], target[0], target[1], target[2]);
        text += line;
    }
    return text;
}

// How much of the picture each step changes.
std::vector<long> stepsOf(const std::function<View(int)>& view) {
    const Folder folder;
    const std::string file = folder.write("steps.jsonl", recorded(view));
    const Ran ran = run(program("espalier-capture") + " --replay " + file + " -o " + folder.file("frames"));
    REQUIRE_MESSAGE(ran.code == 0, ran.output);
    std::vector<long> steps;
    for (int i = 1; i < kFrames; ++i) {
        char names[2][32];
        for (int k : {0, 1}) std::snprintf(names[k], sizeof names[k], "frames/frame_%04d.png", i - 1 + k);
        steps.push_back(changed(folder.file(names[0]), folder.file(names[1])));
    }
    return steps;
}

// The median of the ten steps that are nearest to a step.
double around(const std::vector<long>& steps, size_t at) {
    const size_t first = std::min(at - std::min<size_t>(at, kNeighbours / 2), steps.size() - 1 - kNeighbours);
    std::vector<long> others;
    for (size_t i = first; i <= first + kNeighbours; ++i) {
        if (i != at) others.push_back(steps[i]);
    }
    std::ranges::sort(others);
    return double(others[kNeighbours / 2 - 1] + others[kNeighbours / 2]) / 2;
}

void checkEven(const std::function<View(int)>& view) {
    const std::vector<long> steps = stepsOf(view);
    for (size_t i = 0; i < steps.size(); ++i) {
        CAPTURE(i);
        CHECK(steps[i] > 0);
        CHECK(double(steps[i]) <= 1.3 * around(steps, i));
    }
}

}  // namespace

TEST_CASE("shadows don't jump while the camera comes nearer") {
    // Towards the court along the sample's view, a centimetre a frame. From 10 m on the shadows' map used to reach half
    // as far.
    checkEven([](int i) {
        const double d = 10.06 - 0.01 * i;
        return View{{kCourt[0] + d * 0.3544, kCourt[1] + d * 0.0134, kCourt[2] + d * 0.9350}, kCourt};
    });
}

TEST_CASE("shadows don't jump while the camera goes around") {
    checkEven([](int i) {
        const double angle = 0.3 + 0.004 * i;
        return View{{kCourt[0] + 8 * std::sin(angle), kCourt[1] + 0.6, kCourt[2] + 8 * std::cos(angle)}, kCourt};
    });
}

TEST_CASE("shadows don't jump while the camera walks past") {
    // To the right, 3 cm a frame, at a walker's height.
    checkEven([](int i) {
        const double x = 0.03 * i;
        return View{{1.5 + x, 1.7, 7.5}, {0.5 + x, 1.5, 0}};
    });
}
