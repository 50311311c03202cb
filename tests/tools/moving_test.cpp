// Pictures of what moves beside those of what rests.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::scene;

namespace {

ColourPicture readPicture(const std::string& file) {
    ColourPicture picture;
    std::string error;
    REQUIRE_MESSAGE(readColour(file, picture, error), error);
    return picture;
}

bool showsLeaves(const ColourPicture& picture, size_t at) {
    const auto linear = [&](size_t c) { return std::pow(picture.rgba[at + c] / 255.0, 2.2); };
    return linear(1) >= 1.35 * linear(0) && linear(1) >= 2.2 * linear(2);
}

}  // namespace

TEST_CASE("ivy has one colour and one cover while the camera moves and once it rests") {
    const Folder folder;
    for (const char* camera :
         {"0.2,1.6,2.6,-0.6,1.4,0.3,45", "2.6,1.6,4.2,1.9,1.5,1.3,45", "3.5,1.75,10.4,0.05,1.62,1.3,38"}) {
        ColourPicture pictures[2];
        for (const bool moving : {false, true}) {
            const Ran ran =
                run(program("espalier-capture") + " " + content("sample.json") + " --size 480x270 --camera=" + camera +
                    (moving ? " --moving" : "") + " -o " + folder.file("frames"));
            REQUIRE_MESSAGE(ran.code == 0, ran.output);
            pictures[moving] = readPicture(folder.file("frames/frame_0000.png"));
        }
        double means[2][3] = {}, cover[2] = {};
        for (int k : {0, 1}) {
            for (size_t i = 0; i < pictures[k].rgba.size(); i += 4) {
                if (!showsLeaves(pictures[k], i)) continue;
                ++cover[k];
                for (size_t c = 0; c < 3; ++c) means[k][c] += pictures[k].rgba[i + c];
            }
            for (double& mean : means[k]) mean /= cover[k];
        }
        CAPTURE(camera);
        REQUIRE(cover[0] > double(pictures[0].rgba.size()) / 4 / 10);
        CHECK(cover[1] == doctest::Approx(cover[0]).epsilon(0.05));
        for (int c = 0; c < 3; ++c) CHECK(std::abs(means[1][c] - means[0][c]) <= 2);
    }
}

TEST_CASE("a capture's hour is that of its light") {
    const Folder folder;
    const auto brightness = [&](const char* hour) {
        const Ran ran = run(program("espalier-capture") + " " + content("sample.json") + " --size 160x90 --hour " +
                            hour + " -o " + folder.file("frames"));
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        double sum = 0;
        for (const uint8_t value : readPicture(folder.file("frames/frame_0000.png")).rgba) sum += value;
        return sum;
    };
    CHECK(brightness("12") > 1.3 * brightness("0"));
}

TEST_CASE("some rooms are lit by night, where panes mirror the sky by day") {
    const Folder folder;
    const auto picture = [&](const char* hour) {
        const Ran ran =
            run(program("espalier-capture") + " " + content("hamlet.json") +
                " --size 320x180 --camera=3.5,1.75,-40,-4,2.5,-54,50 --hour " + hour + " -o " + folder.file("frames"));
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        return readPicture(folder.file("frames/frame_0000.png"));
    };
    const ColourPicture night = picture("21"), day = picture("13");
    size_t lit = 0;
    double red = 0, blue = 0;
    for (size_t i = 0; i < night.rgba.size(); i += 4) {
        if (night.rgba[i] < 160 || night.rgba[i] < 1.4 * night.rgba[i + 2]) continue;
        ++lit;
        red += day.rgba[i];
        blue += day.rgba[i + 2];
    }
    CHECK(lit > 200);
    CHECK(lit < night.rgba.size() / 4 / 20);
    CHECK(red < blue);
}
