// What a window asks for while something moves: nothing else where devices are fast, cheaper pictures where they
// aren't.
#include <doctest/doctest.h>

#include <utility>
#include <vector>

#include "tools/scene/moving.hpp"

using namespace espalier;

namespace {

EspLook asked() {
    EspLook look{};
    look.lodPixels = 1;
    look.leafPixels = 8;
    return look;
}

// So many frames of `frameMs` each with `leaves` in view; the last one's.
EspLook after(int frames, scene::MovingPicture& picture, double frameMs, uint32_t leaves, bool strokes = false) {
    EspLook look{};
    for (int i = 0; i < frames; ++i) {
        look = asked();
        picture.prepare(look, true, frameMs, true);
        picture.drew(frameMs, leaves, strokes);
    }
    return look;
}

}  // namespace

TEST_CASE("a slow window draws what moves coarsely, at half the size, and all of it again when it rests") {
    scene::MovingPicture picture;
    EspLook look = asked();
    CHECK(picture.prepare(look, true, 200, true) == 0.5f);
    CHECK(look.quick == 1);
    CHECK(look.lodPixels > 1);
    CHECK(look.leafPixels > 8);
    CHECK(!picture.coarse());  // it wasn't drawn
    picture.drew(200, 100'000);
    CHECK(picture.coarse());
    look = asked();
    CHECK(picture.prepare(look, true, 5, false) == 1);  // fast since it is coarse: it stays so
    CHECK(look.quick == 1);
    look = asked();
    CHECK(picture.prepare(look, false, 200, true) == 1);
    picture.drew(200, 100'000);
    CHECK(look.quick == 0);
    CHECK(look.lodPixels == 1);
    CHECK(look.leafPixels == 8);
    CHECK(!picture.coarse());
}

TEST_CASE("a fast window draws what moves as what rests") {
    scene::MovingPicture picture;
    EspLook look = asked();
    CHECK(picture.prepare(look, true, 8, true) == 1);
    picture.drew(9, 100'000);
    CHECK(look.quick == 0);
    CHECK(look.leafPixels == 8);
    CHECK(!picture.coarse());
}

TEST_CASE("leaves are thinned out while frames are late, down to those that are always in view, and come back") {
    scene::MovingPicture picture;
    const float first = after(5, picture, 200, 100'000).leafPixels;
    const float later = after(9, picture, 200, 100'000).leafPixels;
    CHECK(first > 8 * 1.5f);
    CHECK(later > first);
    CHECK(later <= 8 * 4.0f);
    // Late, but with no more leaves than that: they come back.
    CHECK(after(9, picture, 200, scene::MovingDetail::kLeaves - 1).leafPixels < later);
    after(15, picture, 200, 100'000);
    CHECK(after(9, picture, 20, 100'000).leafPixels < later);
}

TEST_CASE("where small pictures with few leaves are late, all is drawn coarser, and as before once they are in time") {
    constexpr float kLod = scene::MovingDetail::kLod, kMost = scene::MovingDetail::kMostLod;
    constexpr uint32_t few = scene::MovingDetail::kLeaves;
    scene::MovingPicture picture;
    CHECK(after(20, picture, 75, 10 * few).lodPixels == doctest::Approx(kLod));   // leaves are given up first
    CHECK(after(20, picture, 75, few, true).lodPixels == doctest::Approx(kLod));  // a stroke's may take longer
    CHECK(after(18, picture, 75, few).lodPixels > 0.95f * kMost);
    // Then the picture becomes smaller, with the same detail in its larger pixels.
    CHECK(after(60, picture, 75, few).lodPixels == doctest::Approx(kMost / 1.2f));
    CHECK(after(5, picture, 60, few).lodPixels == doctest::Approx(kMost / 1.2f));  // in time because it is coarse
    CHECK(after(60, picture, 50, few).lodPixels == doctest::Approx(kLod / 1.2f));
}

namespace {

// A window whose frames take `base` and, of a whole picture's pixels, `pixels`; both ms. It knows what a frame took
// some frames later.
struct PretendWindow {
    double base, pixels;
    size_t lag;
    std::vector<double> took = {};  // of each frame
    scene::MovingPicture picture = {};
    float share = 0;      // of the last frame
    bool spends = false;  // half pictures were late, so that detail may have been given up

    // As many frames; how often the share changed.
    int move(int count, bool strokes = false) {
        int changes = 0;
        for (int i = 0; i < count; ++i) {
            EspLook look = asked();
            const float before = std::exchange(share, picture.prepare(look, true, 200, true));
            if (i > 0 && before != share) ++changes;
            const float lod = look.lodPixels * 0.5f / share;
            spends = spends || cost(0.5f) >= 0.9 * scene::MovingDetail::kFrameMs;
            if (!spends)
                CHECK(lod == doctest::Approx(scene::MovingDetail::kLod));
            else
                CHECK((lod >= scene::MovingDetail::kLod * 0.999f && lod <= scene::MovingDetail::kMostLod * 1.001f));
            took.push_back(cost(share) * (i % 2 == 0 ? 1.05 : 0.95));
            picture.drew(took[took.size() > lag ? took.size() - 1 - lag : 0], 30'000, strokes);
        }
        return changes;
    }
    void rest() {
        EspLook look = asked();
        picture.prepare(look, false, 200, true);
        took.push_back(300);
        picture.drew(300, 30'000);
    }
    double cost(float of) const { return base + pixels * double(of) * double(of); }
};

}  // namespace

TEST_CASE("what moves is drawn as large as leaves frames in time, and doesn't flicker between sizes") {
    const double late = scene::MovingDetail::kFrameMs;
    for (const size_t lag : {0, 1, 2})
        for (const double pixels : {5.0, 20.0, 40.0, 60.0, 80.0, 400.0}) {
            CAPTURE(lag);
            CAPTURE(pixels);
            PretendWindow window{20, pixels, lag};
            window.move(200);
            CHECK(window.move(200) == 0);
            CHECK((window.share <= 0.5f || window.cost(window.share) <= late));
            CHECK((window.share == 1.0f || window.cost(window.share * 1.2f) > 0.6 * late));
            // It isn't forgotten while all rests, nor judged by the whole picture that is drawn then.
            const float share = window.share;
            window.rest();
            CHECK(window.move(60) == 0);
            CHECK(window.share == share);
            // Where all becomes dearer it is small soon.
            window.pixels = 400;
            window.move(40);
            CHECK(window.share <= 0.5f);
        }
}

TEST_CASE("less than half a side is drawn only where that is late with all detail given up, and half again in time") {
    PretendWindow window{70, 40, 1};
    window.move(20);
    CHECK(window.share == 0.5f);  // detail goes first
    window.move(100);
    CHECK(window.share == doctest::Approx(0.5f / 1.2f));
    CHECK(window.move(200) == 0);
    window.base = 45;  // half a side would be in time, but for a little
    CHECK(window.move(200) == 0);
    window.base = 25;
    window.move(40);
    CHECK(window.share >= 0.5f);
}

TEST_CASE("a picture that becomes too dear is made no smaller than it takes") {
    for (const size_t lag : {0, 1, 2}) {
        CAPTURE(lag);
        PretendWindow window{20, 5, lag};
        window.move(200);
        REQUIRE(window.share == 1.0f);
        window.pixels = 60;  // 80 ms; at the next size below 61.7
        window.move(100);
        CHECK(window.share == doctest::Approx(1 / 1.2f));
    }
}

TEST_CASE("a stroke's frames, which may take longer, don't make the picture smaller") {
    PretendWindow window{20, 5, 1};
    window.move(200);
    REQUIRE(window.share == 1.0f);
    window.base = 80;
    CHECK(window.move(100, true) == 0);
    window.base = 20;
    window.move(5);
    CHECK(window.share == 1.0f);
}

TEST_CASE("whole pictures of what moves are as coarse as half ones are in their own pixels") {
    scene::MovingPicture picture;
    EspLook look = asked();
    CHECK(picture.prepare(look, true, 200, false) == 1);
    CHECK(look.lodPixels == scene::MovingDetail::kLod);
}
