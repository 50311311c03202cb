// Views that explain a picture say something of all that stands in it, trees and houses too.
#include <doctest/doctest.h>

#include <algorithm>
#include <vector>

#include "tests/tools/program.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::scene;

namespace {

struct Texel {
    int red, green, blue;
    int sum() const { return red + green + blue; }
};

// Of the sample's picture of 320 by 180 pixels in a view.
class Shown {
  public:
    Shown(const Folder& folder, const std::string& view) {
        const Ran ran = run(program("espalier-capture") + " " + content("sample.json") + " --size 320x180 --view " +
                            view + " -o " + folder.file(view.c_str()));
        REQUIRE_MESSAGE(ran.code == 0, ran.output);
        std::string error;
        REQUIRE_MESSAGE(readColour(folder.file((view + "/frame_0000.png").c_str()), picture_, error), error);
    }
    std::vector<Texel> part(int left, int top, int right, int bottom) const {
        std::vector<Texel> texels;
        for (int y = top; y < bottom; ++y)
            for (int x = left; x < right; ++x) {
                const uint8_t* texel = &picture_.rgba[4 * size_t(y * 320 + x)];
                texels.push_back({texel[0], texel[1], texel[2]});
            }
        return texels;
    }
    // A tree's, with nothing but sky behind it.
    std::vector<Texel> crown() const { return part(45, 12, 75, 38); }

  private:
    ColourPicture picture_;
};

}  // namespace

TEST_CASE(
    "cards of a tree's crown lie over each other in the view of overdraw, and face every way in that of normals") {
    const Folder folder;
    const Shown overdraw(folder, "overdraw"), normals(folder, "normals");
    // Where ground alone is drawn, a pixel has one fragment.
    std::vector<Texel> ground = overdraw.part(120, 165, 300, 178);
    std::ranges::nth_element(ground, ground.begin() + long(ground.size() / 2), {}, &Texel::sum);
    const int once = ground[ground.size() / 2].sum();
    const auto over = std::ranges::count_if(overdraw.crown(), [&](const Texel& t) { return t.sum() > once + 12; });
    CHECK(over > 150);
    const auto reddish = std::ranges::count_if(normals.crown(), [](const Texel& t) { return t.red > t.green + 20; });
    const auto greenish = std::ranges::count_if(normals.crown(), [](const Texel& t) { return t.green > t.red + 20; });
    CHECK(reddish > 30);
    CHECK(greenish > 30);
}
