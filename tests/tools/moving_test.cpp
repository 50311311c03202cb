// Pictures of what moves beside those of what rests.
#include <doctest/doctest.h>

#include <cmath>

#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::scene;

namespace {

// Mean of the linear green of pixels that show leaves.
double leavesBrightness(const std::string& file) {
    ColourPicture picture;
    std::string error;
    REQUIRE_MESSAGE(readColour(file, picture, error), error);
    const auto linear = [&](size_t at) { return std::pow(picture.rgba[at] / 255.0, 2.2); };
    double sum = 0;
    size_t leaves = 0;
    for (size_t i = 0; i < picture.rgba.size(); i += 4) {
        const double red = linear(i), green = linear(i + 1), blue = linear(i + 2);
        if (green < 1.35 * red || green < 2.2 * blue) continue;
        sum += green;
        ++leaves;
    }
    REQUIRE(leaves > picture.rgba.size() / 4 / 10);
    return sum / double(leaves);
}

}  // namespace

TEST_CASE("ivy isn't darker while the camera moves than once it rests") {
    const Folder folder;
    for (const char* camera : {"0.2,1.6,2.6,-0.6,1.4,0.3,45", "2.6,1.6,4.2,1.9,1.5,1.3,45"}) {
        double brightness[2] = {};
        for (const bool moving : {false, true}) {
            const Ran ran =
                run(program("espalier-capture") + " " + content("sample.json") + " --size 480x270 --camera=" + camera +
                    (moving ? " --moving" : "") + " -o " + folder.file("frames"));
            REQUIRE_MESSAGE(ran.code == 0, ran.output);
            brightness[moving] = leavesBrightness(folder.file("frames/frame_0000.png"));
        }
        CAPTURE(camera);
        CHECK(brightness[1] == doctest::Approx(brightness[0]).epsilon(0.1));
    }
}

TEST_CASE("a capture's hour is that of its light") {
    const Folder folder;
    const auto brightness = [&](const char* hour) {
        const Ran ran = run(program("espalier-capture") + " " + content("sample.json") + " --size 160x90 --hour " +
                            hour + " -o " + folder.file("frames"));
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        ColourPicture picture;
        std::string error;
        REQUIRE_MESSAGE(readColour(folder.file("frames/frame_0000.png"), picture, error), error);
        double sum = 0;
        for (const uint8_t value : picture.rgba) sum += value;
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
        ColourPicture taken;
        std::string error;
        REQUIRE_MESSAGE(readColour(folder.file("frames/frame_0000.png"), taken, error), error);
        return taken;
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
