// The picture of an atlas, pixel by pixel beside what the plugin says of its texels, links and layers.
#include "sample_game/atlas_picture.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sample_game/widgets.hpp"
#include "tests/editor/faults.hpp"
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
    // With all of the brush's strength, in the middle of the wall.
    void dab(const char* layer, std::vector<float> colour = {}) {
        StrokeBegin stroke;
        stroke.layer = layer;
        stroke.colour = std::move(colour);
        stroke.value = stroke.strength = stroke.hardness = 1;
        stroke.radius = .8f;
        for (const Action& action :
             {Action{stroke}, Action{StrokeDabs{{{-1.35f, .7f, .36f, 0, 0, 1, 1}}}}, Action{StrokeEnd{}}})
            REQUIRE_MESSAGE(work.perform(action), work.error);
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
    // Of the middle of a texel: the first row is at v = 0, as in pictures that are exported.
    uint32_t at(size_t x, size_t y) const {
        const size_t factor = side / picture.size();
        return pixels[(y * factor + factor / 2) * side + x * factor + factor / 2];
    }
    // check(x, y, its chart) for every inner texel of a chart that can be walked on at this level.
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

// Nothing but the layer, as the document has it.
AtlasShown layer(const Atlas& atlas, const char* name, uint32_t level = 0) {
    AtlasShown shown = charts(level);
    shown.layer = name;
    shown.opacity = 1;
    shown.revision = atlas.work.document->revision();
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

TEST_CASE("an atlas shows what a layer holds, where it was painted") {
    const Folder folder;
    Atlas atlas(folder);
    atlas.fill(.25f);
    atlas.dab("mask");
    AtlasShown shown = layer(atlas, "mask");
    atlas.show(shown);
    espalier::scene::GreyPicture mask;
    REQUIRE(atlas.work.document->readLayer(0, "mask", mask, atlas.work.error));
    REQUIRE(mask.width == int(atlas.picture.size()));
    const auto value = [&](size_t x, size_t y) { return mask.texels[y * size_t(mask.width) + x]; };
    size_t wrong = 0, painted = 0;
    atlas.overGround(0, [&](size_t x, size_t y, uint32_t) {
        // Of 256 shades the nearest.
        wrong += atlas.at(x, y) != sample::viewColour(ESP_VIEW_LAYER, std::round(value(x, y) * 255) / 255);
        painted += value(x, y) == 1;
        const float u = (float(x) + .5f) / float(mask.width), v = (float(y) + .5f) / float(mask.width);
        wrong += atlas.picture.layerAt(u, v) != std::vector<float>{value(x, y)};
    });
    CHECK(wrong == 0);
    CHECK(painted > 100);

    // Half seen, each channel lies in the middle between the layer's and the chart's.
    const std::vector<uint32_t> whole = atlas.pixels;
    shown.opacity = 0;
    atlas.show(shown);
    const std::vector<uint32_t> none = atlas.pixels;
    shown.opacity = .5f;
    atlas.show(shown);
    size_t off = 0, differ = 0;
    for (size_t i = 0; i < whole.size(); ++i) {
        for (const int shift : {0, 8, 16}) {
            const auto channel = [&](uint32_t pixel) { return int(pixel >> shift & 255u); };
            off += std::abs(2 * channel(atlas.pixels[i]) - channel(whole[i]) - channel(none[i])) > 1;
        }
        differ += whole[i] != none[i];
    }
    CHECK(off == 0);
    CHECK(differ > whole.size() / 10);
}

TEST_CASE("an atlas shows a layer of colours in them") {
    const Folder folder;
    Atlas atlas(folder);
    REQUIRE(std::ranges::count(atlas.work.scene().layers, "colour") == 1);
    atlas.dab("colour", {.75f, .125f, 0});
    atlas.show(layer(atlas, "colour"));
    size_t wrong = 0, painted = 0;
    atlas.overGround(0, [&](size_t x, size_t y, uint32_t) {
        const auto size = float(atlas.picture.size());
        const std::vector<float> rgb = atlas.picture.layerAt((float(x) + .5f) / size, (float(y) + .5f) / size);
        REQUIRE(rgb.size() == 3);
        wrong += atlas.at(x, y) != sample::shownColour({rgb[0], rgb[1], rgb[2]});
        painted += rgb == std::vector<float>{.75f, .125f, 0};
    });
    CHECK(wrong == 0);
    CHECK(painted > 100);
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
                  y = int(float(atlas.side) * (link.a[1] + link.b[1]) / 2);
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
    const AtlasShown shown = layer(atlas, "mask");
    atlas.show(shown);
    const std::vector<uint32_t> before = atlas.pixels;
    const auto stands = [&] {
        CHECK(atlas.picture.shown() == shown);
        atlas.pixels = atlas.picture.pixels(atlas.side);
        CHECK(atlas.pixels == before);
    };
    CHECK(!atlas.picture.read(atlas.work, charts(99)));
    stands();
    // Another layer, on another level, of which one of three channels can't be read.
    const AtlasShown other = layer(atlas, "colour", 2);
    for (const int call : {1, 3, 5}) {  // each is read in two calls, the first of which asks for its size
        callsUntilFailure = call;
        CHECK(!atlas.picture.read(atlas.work, other));
        CHECK(callsUntilFailure == 0);
        stands();
    }
    atlas.show(other);
    CHECK(atlas.picture.shown() == other);
    CHECK(atlas.pixels != before);
}

TEST_CASE("where a link leads is told, and on which surface if that is another") {
    const Folder folder;
    const std::string ruin = smallSurface();
    const Window window(folder,
                        folder.write("two.json", R"({"surfaces": [{"file": ")" + ruin + R"("}, {"file": ")" + ruin +
                                                     R"(", "position": [0.4, 0, 0]}], "grammars": [{"file": ")" +
                                                     content("grammars/ivy_guided.grammar") + R"("}]})"));
    const auto& scene = window.work.scene();
    REQUIRE(scene.surfaces.size() == 2);
    REQUIRE(espUpdate(window.work.context.get()) == ESP_OK);  // which finds where they touch
    uint32_t count = 0;
    REQUIRE(espReadLinks(window.work.context.get(), scene.surfaces[0].id, nullptr, &count) == ESP_OK);
    std::vector<EspLink> links(count);
    REQUIRE(espReadLinks(window.work.context.get(), scene.surfaces[0].id, links.data(), &count) == ESP_OK);
    size_t here = 0, there = 0, wrong = 0;
    for (const EspLink& link : links) {
        const std::string from = "leads from chart " + std::to_string(link.chart), to = std::to_string(link.toChart);
        const bool open = link.kind == ESP_LINK_OPEN, own = link.toSurface.id == scene.surfaces[0].id.id;
        here += !open && own;
        there += !open && !own;
        wrong += sample::leadsTo(scene, 0, link) != (open  ? "a border of the model"
                                                     : own ? from + " to " + to
                                                           : from + " to chart " + to + " of 2  ruin");
    }
    CHECK(here > 0);
    CHECK(there > 0);
    CHECK(wrong == 0);
}

TEST_CASE("an atlas leaves the surface and the layer that are there no more") {
    const Folder folder;
    const Atlas atlas(folder);
    AtlasShown shown = charts();
    shown.layer = "mask";
    shown.keepTo(atlas.work.scene());
    CHECK(shown.layer == "mask");
    shown.layer = "gone";
    shown.surface = 7;
    shown.keepTo(atlas.work.scene());
    CHECK(shown.layer.empty());
    CHECK(shown.surface == 0);
}
