// Growth drawn within a pass that a host has begun.
#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "tests/plugin/grown_square.hpp"
#include "tests/plugin/pass_host.hpp"

using namespace espalier;

namespace hostpass {
namespace {

using Kind = PassHost::Kind;
using Picture = PassHost::Picture;
constexpr size_t kPixels = size_t(PassHost::kWidth) * PassHost::kHeight;
constexpr float kNear = .05f, kFar = 20;

// A wall under the square, a box in front of the growth and one that runs through it.
const std::vector<PassHost::Box> kBoxes = {{{0, 0, -.2f}, {1, 1, -.004f}, {.5f, .45f, .4f}},
                                           {{.55f, .1f, .2f}, {.8f, .5f, .4f}, {.7f, .2f, .1f}},
                                           {{.15f, .45f, -.1f}, {.4f, .7f, .06f}, {.2f, .3f, .7f}}};

PassHost::View viewFrom(glm::vec3 eye, bool reversed) {
    const float aspect = float(PassHost::kWidth) / PassHost::kHeight;
    glm::mat4 projection = glm::perspectiveRH_ZO(.7f, aspect, kNear, kFar);
    if (reversed) {
        projection[2][2] = 0;
        projection[3][2] = kNear;
    }
    projection[1][1] *= -1;
    return {glm::lookAtRH(eye, glm::vec3(.5f, .5f, 0), glm::vec3(0, 1, 0)), projection};
}
const glm::vec3 kEye(1.3f, .9f, 1.9f);

bool differ(const Picture& a, const Picture& b, size_t pixel) {
    return a.colour[pixel] != b.colour[pixel];
}
size_t count(const Picture& a, const Picture& b) {
    size_t n = 0;
    for (size_t i = 0; i < kPixels; ++i) n += differ(a, b, i);
    return n;
}

// Of one sample: growth is there where it is nearer, and nothing else has changed.
void hideEachOther(PassHost& host, const GrownSquare& grown, const Kind& kind, const PassHost::View& view) {
    const Picture boxes = host.draw(kind, view, kBoxes, nullptr);
    const Picture growth = host.draw(kind, view, {}, grown.context);
    const Picture both = host.draw(kind, view, kBoxes, grown.context);
    const float nothing = kind.reversed ? 0.0f : 1.0f;
    size_t front = 0, behind = 0, wrong = 0;
    for (size_t i = 0; i < kPixels; ++i) {
        const bool grows = growth.depth[i] != nothing;
        const bool nearer =
            grows && (kind.reversed ? growth.depth[i] >= boxes.depth[i] : growth.depth[i] <= boxes.depth[i]);
        front += nearer;
        behind += grows && !nearer;
        const Picture& expected = nearer ? growth : boxes;
        wrong += both.depth[i] != expected.depth[i] || differ(both, expected, i);
    }
    CHECK(wrong == 0);
    CHECK(front > 1500);
    CHECK(behind > 800);
}

float encoded(float v) {
    return v <= .0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - .055f;
}

}  // namespace

TEST_CASE("growth in a host's pass") {
    PassHost host;
    GrownSquare grown(host.device());
    const PassHost::View view = viewFrom(kEye, true);
    const Picture plain = host.draw({}, view, kBoxes, grown.context);

    SUBCASE("hides and is hidden, with any depth, by a render pass or without one") {
        hideEachOther(host, grown, {}, view);
        hideEachOther(host, grown, {.reversed = false}, viewFrom(kEye, false));
        hideEachOther(host, grown, {.renderPass = true}, view);
    }
    SUBCASE("is the same for every way to write one view") {
        // Turned over by the viewport; an eye that looks along +z.
        PassHost::View other = view;
        other.projection[1][1] *= -1;
        other.upwards = true;
        CHECK(count(host.draw({}, other, kBoxes, grown.context), plain) == 0);
        const glm::mat4 turn = glm::scale(glm::mat4(1), glm::vec3(1, 1, -1));
        other = view;
        other.view = turn * view.view;
        other.projection = view.projection * turn;
        CHECK(count(host.draw({}, other, kBoxes, grown.context, true),
                    host.draw({}, view, kBoxes, grown.context, true)) == 0);
        // A mirror shows the same, mirrored.
        const glm::mat4 mirror = glm::scale(glm::mat4(1), glm::vec3(-1, 1, 1));
        other = view;
        other.view = mirror * view.view;
        const Picture mirrored = host.draw({}, other, kBoxes, grown.context, true);
        const Picture straight = host.draw({}, view, kBoxes, grown.context, true);
        size_t unlike = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            const size_t x = i % PassHost::kWidth, j = i - x + PassHost::kWidth - 1 - x;
            unlike += glm::length(mirrored.colour[i] - straight.colour[j]) > .1f;
        }
        CHECK(unlike < kPixels / 100);
    }
    SUBCASE("is multisampled as the pass is") {
        for (const uint32_t samples : {2u, 4u, 8u}) {
            CAPTURE(samples);
            if (!(host.sampleCounts() & samples)) continue;
            const Kind kind{.samples = samples};
            const Picture boxes = host.draw(kind, view, kBoxes, nullptr);
            const Picture both = host.draw(kind, view, kBoxes, grown.context);
            const Picture bare = host.draw({}, view, kBoxes, nullptr);
            const size_t one = count(plain, bare), many = count(both, boxes);
            CHECK(many > one * 95 / 100);
            double apart = 0;
            for (size_t i = 0; i < kPixels; ++i) apart += glm::length(both.colour[i] - plain.colour[i]);
            CHECK(apart / kPixels < .03);
        }
    }
    SUBCASE("is light, linear or encoded") {
        const Kind floats{.colour = VK_FORMAT_R16G16B16A16_SFLOAT, .output = ESP_OUTPUT_LINEAR};
        const Picture linear = host.draw(floats, view, {}, grown.context),
                      shown = host.draw({}, view, {}, grown.context);
        Kind bright = floats;
        bright.output = ESP_OUTPUT_LIGHT;
        const Picture light = host.draw(bright, view, {}, grown.context);
        bright.exposure = 2;
        const Picture more = host.draw(bright, view, {}, grown.context);
        size_t judged = 0, unlike = 0, brighter = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            if (linear.depth[i] == 0) continue;
            ++judged;
            for (int c = 0; c < 3; ++c) unlike += std::abs(encoded(linear.colour[i][c]) - shown.colour[i][c]) > .006f;
            unlike += std::abs(more.colour[i].g - 4 * light.colour[i].g) > .004f * more.colour[i].g;
            brighter += more.colour[i].g > 1;
        }
        CHECK(judged > 1500);
        CHECK(unlike == 0);
        CHECK(brighter > 0);  // than any picture
    }
    SUBCASE("has the depths of its picture where a pass has depths only, and casts by a parallel view") {
        const Kind depths{.colour = VK_FORMAT_UNDEFINED};
        const Picture only = host.draw(depths, view, {}, grown.context), shown = host.draw({}, view, {}, grown.context);
        size_t same = 0, all = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            all += shown.depth[i] != 0;
            same += shown.depth[i] != 0 && std::abs(only.depth[i] - shown.depth[i]) < 1e-5f;
        }
        CHECK(all > 1500);
        CHECK(same > all * 97 / 100);
        // The sun's view of the square from the front.
        glm::mat4 flat = glm::orthoRH_ZO(-1.f, 1.f, -.75f, .75f, .1f, 10.f);
        flat[1][1] *= -1;
        const PassHost::View sun{glm::lookAtRH(glm::vec3(.5f, .5f, 3), glm::vec3(.5f, .5f, 0), glm::vec3(0, 1, 0)),
                                 flat};
        const Picture cast = host.draw({.colour = VK_FORMAT_UNDEFINED, .reversed = false}, sun, {}, grown.context);
        size_t covered = 0;
        for (size_t i = 0; i < kPixels; ++i) {
            const bool cover = cast.depth[i] != 1;
            covered += cover;
            // All of it stands between the square and a hand's breadth in front of it.
            if (cover) CHECK(std::abs(.1f + cast.depth[i] * 9.9f - 2.9f) < .15f);
        }
        CHECK(covered > 3000);
    }
}

TEST_CASE("passes that can't be drawn in are refused") {
    PassHost host;
    GrownSquare grown(host.device());
    EspContext* context = grown.context;
    int handle = 0;
    CHECK(espRecord(context, &handle) == ESP_INVALID_ARGUMENT);
    CHECK(std::string(espLastError(context)).find("nothing has been prepared") != std::string::npos);
    const auto refused = [&](const char* why, auto&& spoil) {
        EspPassFormat format = esp::defaults<EspPassFormat>();
        const uint32_t colour = VK_FORMAT_R8G8B8A8_UNORM;
        format.colourFormats = &colour;
        format.colourCount = 1;
        format.depthFormat = VK_FORMAT_D32_SFLOAT;
        EspPassDef def = esp::defaults<EspPassDef>();
        const PassHost::View view = viewFrom(kEye, true);
        std::memcpy(def.view, &view.view, sizeof def.view);
        std::memcpy(def.projection, &view.projection, sizeof def.projection);
        def.format = &format;
        def.commandBuffer = &handle;
        def.frame = 1;
        spoil(def, format);
        CHECK(espPrepare(context, &def) == ESP_INVALID_ARGUMENT);
        const std::string text = espLastError(context);
        CHECK_MESSAGE(text.find(why) != std::string::npos, text);
    };
    refused("null pointer", [](EspPassDef& def, EspPassFormat&) { def.format = nullptr; });
    refused("commandBuffer", [](EspPassDef& def, EspPassFormat&) { def.commandBuffer = nullptr; });
    refused("samples are", [](EspPassDef&, EspPassFormat& format) { format.samples = 3; });
    refused("holds no depths", [](EspPassDef&, EspPassFormat& f) { f.depthFormat = VK_FORMAT_R32_SFLOAT; });
    refused("colourCount", [](EspPassDef&, EspPassFormat& format) { format.colourCount = 9; });
    refused("no such output", [](EspPassDef&, EspPassFormat& format) { format.output = EspOutput(0); });
    refused("not finite", [](EspPassDef& def, EspPassFormat&) { def.view[3] = NAN; });
    refused("scales", [](EspPassDef& def, EspPassFormat&) { def.view[0] *= 2; });
    refused("neither", [](EspPassDef& def, EspPassFormat&) { def.projection[11] = 0; });
    refused("viewport", [](EspPassDef& def, EspPassFormat&) { def.viewport[2] = 0; });
    refused("focus", [](EspPassDef& def, EspPassFormat&) { def.focus = 0; });
}

}  // namespace hostpass
