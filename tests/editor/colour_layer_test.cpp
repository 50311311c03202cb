// Layers of colours: three layers to the plugin, one to whoever paints; and what erasing leads back to.
#include <algorithm>
#include <array>

#include "plugin_api/espalier.hpp"
#include "tests/editor/editing.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::document;
using espalier::scene::GreyPicture;

namespace {

using Channels = std::array<std::vector<float>, 3>;

std::vector<float> texelsOf(Editing& editing, const std::string& layer) {
    GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(0, layer, picture, editing.error), editing.error);
    return picture.texels;
}

Channels coloursOf(Editing& editing) {
    return {texelsOf(editing, "colour.r"), texelsOf(editing, "colour.g"), texelsOf(editing, "colour.b")};
}

void stroke(Editing& editing, StrokeBegin begin) {
    begin.strength = begin.hardness = 1;
    begin.radius = .8f;
    REQUIRE_MESSAGE(editing.perform(begin), editing.error);
    REQUIRE_MESSAGE(editing.perform(StrokeDabs{{{-1.35f, .7f, .36f, 0, 0, 1, 1}}}), editing.error);
    REQUIRE_MESSAGE(editing.perform(StrokeEnd{}), editing.error);
}

void paint(Editing& editing, const char* layer, std::vector<float> colour, const char* mode = "paint") {
    StrokeBegin begin;
    begin.layer = layer;
    begin.mode = mode;
    begin.colour = std::move(colour);
    stroke(editing, begin);
}

// How many texels have just this colour.
size_t count(const Channels& channels, std::array<float, 3> colour) {
    size_t found = 0;
    for (size_t i = 0; i < channels[0].size(); ++i)
        found += channels[0][i] == colour[0] && channels[1][i] == colour[1] && channels[2][i] == colour[2];
    return found;
}

constexpr std::array<float, 3> kRed{.75f, .125f, 0}, kWhite{1, 1, 1};

}  // namespace

TEST_CASE("a layer of colours is painted in one stroke, shown, undone in one step, and leaves' colours follow it") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const auto& scene = editing.document->scene();
    CHECK(std::ranges::count(scene.layers, "colour") == 1);
    CHECK(std::ranges::count(scene.layers, "colour.r") == 0);
    CHECK(isColour(scene, "colour"));
    CHECK(!isColour(scene, "mask"));

    const uint64_t before = editing.hash();
    paint(editing, "colour", {kRed.begin(), kRed.end()});
    const Channels painted = coloursOf(editing);
    CHECK(count(painted, kRed) > 100);
    CHECK(count(painted, kRed) + count(painted, kWhite) > painted[0].size() * 9 / 10);
    const uint64_t after = editing.hash();
    CHECK(after != before);

    esp::DrawDef draw;
    draw.width = 160;
    draw.height = 90;
    draw.camera = scene.camera;
    draw.look = scene.look;
    draw.look.view = ESP_VIEW_LAYER;
    draw.look.viewLayer = "colour";
    REQUIRE_MESSAGE(espDraw(editing.context.get(), &draw) == ESP_OK, espLastError(editing.context.get()));
    std::vector<uint8_t> rgba(size_t(draw.width) * draw.height * 4);
    REQUIRE(espReadPixels(editing.context.get(), rgba.data(), rgba.size()) == ESP_OK);
    size_t red = 0, white = 0;
    for (size_t i = 0; i < rgba.size(); i += 4) {
        red += rgba[i] > 2 * rgba[i + 1] && rgba[i + 1] > rgba[i + 2];
        white += rgba[i] > 90 && rgba[i] == rgba[i + 1] && rgba[i] == rgba[i + 2];
    }
    CHECK(red > 100);
    CHECK(white > 300);

    REQUIRE(editing.perform(Undo{}));
    CHECK(editing.document->undoSteps() == 0);
    const Channels undone = coloursOf(editing);
    CHECK(count(undone, kWhite) == undone[0].size());
    CHECK(editing.hash() == before);
    REQUIRE(editing.perform(Redo{}));
    CHECK(coloursOf(editing) == painted);
    CHECK(editing.hash() == after);
}

TEST_CASE("colours survive a project, and pictures that a painting program could have made") {
    const Folder folder;
    Editing editing(smallScene(folder));
    paint(editing, "colour", {kRed.begin(), kRed.end()});
    const Channels painted = coloursOf(editing);
    const uint64_t grown = editing.hash();
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(coloursOf(again) == painted);
    CHECK(again.hash() == grown);

    for (const char* name : {"colour.png", "colour.exr"}) {
        const std::string file = folder.file(name);
        REQUIRE_MESSAGE(exportLayer(*editing.document, "colour", file, editing.error), editing.error);
        espalier::scene::PictureShape shape;
        REQUIRE(readShape(file, shape, editing.error));
        CHECK(shape.channels == 3);
        espalier::scene::FloatPicture stored;  // as other programs see it
        REQUIRE(readFloats(file, stored, editing.error));
        float most = 0;
        for (size_t i = 0; i < stored.rgba.size(); i += 4)
            if (stored.rgba[i + 2] == 0) most = std::max(most, stored.rgba[i]);
        const bool floats = std::string(name).ends_with("exr");
        CHECK(most == doctest::Approx(floats ? .75f : .8808f).epsilon(.001));  // sRGB of .75

        REQUIRE(editing.perform(FillLayer{"colour", 0, {0, 0, 0}}));
        Work work(importing(*editing.document, "colour", file, 7));
        REQUIRE_MESSAGE(work.finish(editing.error), editing.error);
        CHECK(work.note().empty());
        const Channels back = coloursOf(editing);
        float worst = 0;
        for (size_t c = 0; c < 3; ++c)
            for (size_t i = 0; i < back[c].size(); ++i) worst = std::max(worst, std::abs(back[c][i] - painted[c][i]));
        CHECK(worst <= (floats ? 0 : 3e-5f));
        REQUIRE(editing.perform(Undo{}));
        CHECK(count(coloursOf(editing), kRed) == 0);
        REQUIRE(editing.perform(Undo{}));
        CHECK(coloursOf(editing) == painted);
    }
}

TEST_CASE("erasing leads back to what the layer was cleared to, else to what the grammar says") {
    const Folder folder;
    Editing editing(smallScene(folder));
    // What all texels under the brush have; -1: not the same.
    std::vector<size_t> under;
    const auto middle = [&](Editing& of) {
        const std::vector<float> mask = texelsOf(of, "mask");
        const bool same = std::ranges::all_of(under, [&](size_t i) { return mask[i] == mask[under[0]]; });
        return same ? mask[under[0]] : -1;
    };
    const auto erase = [](Editing& of) { paint(of, "mask", {}, "erase"); };
    StrokeBegin black;
    black.layer = "mask";
    black.value = 0;
    stroke(editing, black);
    const std::vector<float> painted = texelsOf(editing, "mask");
    for (size_t i = 0; i < painted.size(); ++i)
        if (painted[i] == 0) under.push_back(i);
    REQUIRE(under.size() > 100);
    erase(editing);
    CHECK(middle(editing) == 1);  // the grammar's

    REQUIRE(editing.perform(FillLayer{"mask", 0}));
    paint(editing, "mask", {});
    CHECK(middle(editing) == 1);
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    erase(editing);
    CHECK(middle(editing) == 0);
    Editing again(folder.file("saved"));
    CHECK(middle(again) == 1);
    erase(again);
    CHECK(middle(again) == 0);

    for (int i = 0; i < 3; ++i) REQUIRE(editing.perform(Undo{}));  // over the fill
    stroke(editing, black);
    erase(editing);
    CHECK(middle(editing) == 1);
}

TEST_CASE("of a name that is a colour here and a number there, each channel stands for itself") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string text = editing.document->scene().grammars[0].text;
    REQUIRE(editing.perform(FillLayer{"colour", 0, {.5f, .2f, 0}}));
    std::string number = text;
    const std::string declared = "context colour = #ffffff", used = "Colour(colour(texCoord)) ";
    number.replace(number.find(declared), declared.size(), "context colour = 1");
    number.replace(number.find(used), used.size(), "Tint(colour(texCoord)) ");
    REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, number)), editing.error);
    REQUIRE(editing.document->scene().grammars[0].error.empty());
    const auto& scene = editing.document->scene();
    CHECK(!isColour(scene, "colour"));
    for (const char* layer : {"colour", "colour.r", "colour.g", "colour.b"}) {
        CAPTURE(layer);
        CHECK(std::ranges::count(scene.layers, layer) == 1);  // what is painted stays
        CHECK(channelsOf(scene, layer).size() == 1);
    }
    REQUIRE(editing.perform(Undo{}));
    CHECK(isColour(scene, "colour"));
    CHECK(std::ranges::count(scene.layers, "colour.r") == 0);
}

TEST_CASE(
    "numbers that were painted by a name that has become a colour's wait, in projects too, for a text that reads "
    "them") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string text = editing.document->scene().grammars[0].text;
    const std::string declared = "context colour = #ffffff", used = "Colour(colour(texCoord)) ";
    std::string number = text;
    number.replace(number.find(declared), declared.size(), "context colour = 1");
    number.replace(number.find(used), used.size(), "Tint(colour(texCoord)) ");
    REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, number)), editing.error);
    StrokeBegin begin;
    begin.layer = "colour";
    begin.value = .25f;
    stroke(editing, begin);
    const std::vector<float> numbers = texelsOf(editing, "colour");
    REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, text)), editing.error);
    CHECK(isColour(editing.document->scene(), "colour"));
    CHECK(std::ranges::count(editing.document->scene().layers, "colour") == 1);
    const Channels untouched = coloursOf(editing);
    CHECK(count(untouched, kWhite) == untouched[0].size());
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(isColour(again.document->scene(), "colour"));
    CHECK(coloursOf(again) == untouched);
    CHECK(texelsOf(again, "colour") == numbers);
}
