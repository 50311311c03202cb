// The picture of an atlas, pixel by pixel beside what the plugin says of its texels, links and layers.
#include "sample_game/atlas_picture.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sample_game/widgets.hpp"
#include "tests/editor/window.hpp"

using namespace espalier::document;
using sample::AtlasPicture, sample::AtlasShown;

namespace {

struct Atlas : Window {
    AtlasPicture picture;
    std::vector<uint32_t> pixels;
    uint32_t side = 0;

    explicit Atlas(const Folder& folder) : Window(folder, smallScene(folder)) {}
    void show(const AtlasShown& wanted) {
        REQUIRE_MESSAGE(picture.read(work, wanted), work.error);
        pixels = picture.pixels(side);
        REQUIRE(pixels.size() == size_t(side) * side);
    }
    std::vector<uint32_t> texels(uint32_t level) {
        uint32_t size = 0;
        const EspSurface surface = work.scene().surfaces[0].id;
        REQUIRE(espReadAtlas(work.context.get(), surface, level, nullptr, &size) == ESP_OK);
        std::vector<uint32_t> texels(size_t(size) * size);
        REQUIRE(espReadAtlas(work.context.get(), surface, level, texels.data(), &size) == ESP_OK);
        REQUIRE(size == picture.size());
        return texels;
    }
    // Of the middle of a texel: v runs upward, rows downward.
    uint32_t at(size_t x, size_t y) const {
        const size_t factor = side / picture.size();
        return pixels[(side - 1 - (y * factor + factor / 2)) * side + x * factor + factor / 2];
    }
    // check(x, y, its chart) for every texel that isn't beside a border, in one layer's words: inner, not buried.
    template <class Check>
    void overGround(uint32_t level, const Check& check) {
        const std::vector<uint32_t> all = texels(level);
        const size_t size = picture.size();
        size_t met = 0;
        for (size_t i = 0; i < all.size(); ++i)
            if ((all[i] >> 16 & 7u) == ESP_TEXEL_INNER) check(i % size, i / size, all[i] & 0xFFFFu), ++met;
        CHECK(met > size);
    }
};

AtlasShown charts(uint32_t level = 0) {
    AtlasShown shown;
    shown.surface = 0;
    shown.level = level;
    shown.links = false;
    return shown;
}

}  // namespace

TEST_CASE("an atlas shows each chart in its colour, at every level as many pixels a texel") {
    const Folder folder;
    Atlas atlas(folder);
    for (const uint32_t level : {0u, 3u}) {
        CAPTURE(level);
        atlas.show(charts(level));
        CHECK(atlas.side >= 512);
        CHECK(atlas.side % atlas.picture.size() == 0);
        size_t wrong = 0;
        std::set<uint32_t> colours, met;
        atlas.overGround(level, [&](size_t x, size_t y, uint32_t chart) {
            wrong += atlas.at(x, y) != sample::viewColour(ESP_VIEW_CHARTS, float(chart));
            colours.insert(atlas.at(x, y));
            met.insert(chart);
        });
        CHECK(wrong == 0);
        CHECK(met.size() > 1);
        CHECK(colours.size() > 1);
    }
    CHECK(atlas.picture.layerAt(.5f, .5f).empty());
}

TEST_CASE("an atlas shows what a layer holds, as it is painted") {
    const Folder folder;
    Atlas atlas(folder);
    AtlasShown shown = charts();
    shown.layer = "mask";
    shown.opacity = 1;
    for (const float value : {.25f, .75f}) {
        CAPTURE(value);
        atlas.fill(value);
        shown.revision = atlas.work.document->revision();
        atlas.show(shown);
        // Of 256 shades the nearest.
        const uint32_t wanted = sample::viewColour(ESP_VIEW_LAYER, std::round(value * 255) / 255);
        size_t wrong = 0;
        atlas.overGround(0, [&](size_t x, size_t y, uint32_t) { wrong += atlas.at(x, y) != wanted; });
        CHECK(wrong == 0);
    }
    // Half seen it lies between its own colour and the chart's.
    shown.opacity = 0;
    atlas.show(shown);
    size_t wrong = 0;
    atlas.overGround(0, [&](size_t x, size_t y, uint32_t chart) {
        wrong += atlas.at(x, y) != sample::viewColour(ESP_VIEW_CHARTS, float(chart));
    });
    CHECK(wrong == 0);
    CHECK(std::ranges::count(atlas.picture.layerAt(.5f, .5f), -1.f) == 0);
    CHECK(atlas.picture.layerAt(.5f, .5f).size() == 1);
}

TEST_CASE("an atlas shows a layer of colours in them") {
    const Folder folder;
    Atlas atlas(folder);
    AtlasShown shown = charts();
    shown.layer = "colour";
    shown.opacity = 1;
    const float tint[3] = {.8f, .1f, .05f};
    REQUIRE(std::ranges::count(atlas.work.scene().layers, shown.layer) == 1);
    FillLayer fill{"colour", 1};
    fill.colour = {tint[0], tint[1], tint[2]};
    REQUIRE_MESSAGE(atlas.work.perform(fill), atlas.work.error);
    shown.revision = atlas.work.document->revision();
    atlas.show(shown);
    size_t wrong = 0;
    atlas.overGround(0, [&](size_t x, size_t y, uint32_t) { wrong += atlas.at(x, y) != sample::shownColour(tint); });
    CHECK(wrong == 0);
    CHECK(atlas.picture.layerAt(.5f, .5f).size() == 3);
}

TEST_CASE("an atlas shows its links by their kind") {
    const Folder folder;
    Atlas atlas(folder);
    AtlasShown shown = charts();
    shown.links = true;
    atlas.show(shown);
    REQUIRE(atlas.picture.links().size() > 100);
    size_t bare = 0, own = 0;
    for (const EspLink& link : atlas.picture.links()) {
        const int last = int(atlas.side) - 1, x = int(float(atlas.side) * (link.a[0] + link.b[0]) / 2),
                  y = last - int(float(atlas.side) * (link.a[1] + link.b[1]) / 2);
        uint32_t near[9];
        for (int i = 0; i < 9; ++i)
            near[i] = atlas.pixels[size_t(std::clamp(y + i / 3 - 1, 0, last)) * atlas.side +
                                   size_t(std::clamp(x + i % 3 - 1, 0, last))];
        bare += std::ranges::none_of(
            near, [](uint32_t pixel) { return std::ranges::count(AtlasPicture::kLinkColours, pixel) > 0; });
        own += std::ranges::count(near, AtlasPicture::kLinkColours[link.kind]) > 0;
    }
    CHECK(bare == 0);
    CHECK(own > atlas.picture.links().size() * 9 / 10);  // others may lie over it
}

TEST_CASE("an atlas that can't be read stays what it was") {
    const Folder folder;
    Atlas atlas(folder);
    atlas.show(charts());
    const std::vector<uint32_t> before = atlas.pixels;
    CHECK(!atlas.picture.read(atlas.work, charts(99)));
    CHECK(atlas.picture.shown() == charts());
    atlas.pixels = atlas.picture.pixels(atlas.side);
    CHECK(atlas.pixels == before);
}
