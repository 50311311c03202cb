// What a window asks for while something moves: nothing else where devices are fast, cheaper pictures where they
// aren't.
#include <doctest/doctest.h>

#include "tools/scene/moving.hpp"

using namespace espalier;

namespace {

EspDrawDef asked() {
    EspDrawDef draw{};
    draw.look.windowLodPixels = 1;
    draw.look.leafPixels = 8;
    return draw;
}

// So many frames of `frameMs` each with `leaves` in view; the last one's.
EspDrawDef after(int frames, scene::MovingPicture& picture, double frameMs, uint32_t leaves) {
    EspDrawDef draw{};
    for (int i = 0; i < frames; ++i) {
        draw = asked();
        picture.prepare(draw, true, frameMs, true);
        picture.drew(frameMs, leaves);
    }
    return draw;
}

}  // namespace

TEST_CASE("a slow device draws what moves coarsely, at half the size, and all of it again when it rests") {
    scene::MovingPicture picture;
    EspDrawDef draw = asked();
    CHECK(picture.prepare(draw, true, 200, true) == 0.5f);
    CHECK(draw.look.quick == 1);
    CHECK(draw.look.windowLodPixels > 1);
    CHECK(draw.look.leafPixels > 8);
    CHECK(!picture.coarse());  // it wasn't drawn
    picture.drew(200, 100'000);
    CHECK(picture.coarse());
    draw = asked();
    CHECK(picture.prepare(draw, true, 5, false) == 1);  // fast since it is coarse: it stays so
    CHECK(draw.look.quick == 1);
    draw = asked();
    CHECK(picture.prepare(draw, false, 200, true) == 1);
    picture.drew(200, 100'000);
    CHECK(draw.look.quick == 0);
    CHECK(draw.look.windowLodPixels == 1);
    CHECK(draw.look.leafPixels == 8);
    CHECK(!picture.coarse());
}

TEST_CASE("a fast device draws what moves as what rests") {
    scene::MovingPicture picture;
    EspDrawDef draw = asked();
    CHECK(picture.prepare(draw, true, 8, true) == 1);
    picture.drew(9, 100'000);
    CHECK(draw.look.quick == 0);
    CHECK(draw.look.leafPixels == 8);
    CHECK(!picture.coarse());
}

TEST_CASE("leaves are thinned out while frames are late, down to those that are always in view, and come back") {
    scene::MovingPicture picture;
    const float first = after(5, picture, 200, 100'000).look.leafPixels;
    const float later = after(9, picture, 200, 100'000).look.leafPixels;
    CHECK(first > 8 * 1.5f);
    CHECK(later > first);
    CHECK(later <= 8 * 4.0f);
    // Late, but with no more leaves than that: they come back.
    CHECK(after(9, picture, 200, scene::MovingDetail::kLeaves - 1).look.leafPixels < later);
    after(15, picture, 200, 100'000);
    CHECK(after(9, picture, 20, 100'000).look.leafPixels < later);
}

TEST_CASE("what moves is drawn as large as leaves frames in time, and doesn't flicker between sizes") {
    const double late = scene::MovingDetail::kFrameMs;
    for (const double pixelsMs : {5.0, 20.0, 40.0, 80.0, 400.0}) {
        CAPTURE(pixelsMs);
        scene::MovingPicture picture;
        const auto frames = [&](int count, double ms) {
            float share = 0;
            int changes = 0;
            for (int i = 0; i < count; ++i) {
                EspDrawDef draw = asked();
                const float before = std::exchange(share, picture.prepare(draw, true, 200, true));
                if (i > 0 && before != share) ++changes;
                CHECK(draw.look.windowLodPixels == doctest::Approx(scene::MovingDetail::kLod * share / 0.5f));
                const double noise = i % 2 == 0 ? 1.05 : 0.95;
                picture.drew((20 + ms * double(share * share)) * noise, 30'000);
            }
            return std::pair(share, changes);
        };
        frames(200, pixelsMs);
        const auto [share, changes] = frames(200, pixelsMs);
        CHECK(changes == 0);
        CHECK((share == 0.5f || 20 + pixelsMs * double(share * share) <= late));
        CHECK((share == 1.0f || 20 + 1.44 * 1.44 * pixelsMs * double(share * share) > 0.6 * late));
        // Where all becomes dearer it is small soon.
        CHECK(frames(40, 400).first == 0.5f);
    }
}
