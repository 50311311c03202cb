// Layers of colours when the plugin fails at one of their channels: what was done to the others is taken back.
#include <array>

#include "tests/editor/editing.hpp"
#include "tests/editor/faults.hpp"
#include "tools/document/layer_files.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::document;
using espalier::scene::GreyPicture;

namespace {

using Channels = std::array<std::vector<float>, 3>;

struct ColourEditing : Editing {
    using Editing::Editing;
    Channels colours() {
        Channels channels;
        for (size_t c = 0; c < 3; ++c) {
            GreyPicture picture;
            REQUIRE_MESSAGE(document->readLayer(0, std::array{"colour.r", "colour.g", "colour.b"}[c], picture, error),
                            error);
            channels[c] = picture.texels;
        }
        return channels;
    }
    // The call that fails, from 1.
    bool failingAt(int call, const Action& action) {
        callsUntilFailure = call;
        const bool good = perform(action);
        CHECK(callsUntilFailure == 0);
        callsUntilFailure = 0;
        return good;
    }
};

StrokeBegin redBrush() {
    StrokeBegin begin;
    begin.layer = "colour";
    begin.colour = {.75f, .125f, 0};
    begin.strength = begin.hardness = 1;
    begin.radius = .8f;
    return begin;
}
const StrokeDabs kDab{{{-1.35f, .7f, .36f, 0, 0, 1, 1}}};

}  // namespace

TEST_CASE("a fill or a picture of colours that fails at one channel leaves all of them, and undo, as they were") {
    const Folder folder;
    ColourEditing painter(smallScene(folder));
    const std::string file = folder.file("colour.exr");
    REQUIRE(painter.perform(FillLayer{"colour", 1, {.5f, .25f, .125f}}));
    REQUIRE_MESSAGE(exportLayer(*painter.document, "colour", file, painter.error), painter.error);
    REQUIRE(painter.perform(Undo{}));
    const Channels before = painter.colours();
    const uint64_t grown = painter.hash();
    for (const Action& action :
         {Action{FillLayer{"colour", 1, {.75f, .125f, 0}}}, Action{LoadLayer{"colour", file, 0}}})
        for (int channel = 1; channel <= 3; ++channel) {
            CAPTURE(action.index());
            CAPTURE(channel);
            CHECK(!painter.failingAt(channel, action));
            CHECK(painter.error != "");
            CHECK(painter.colours() == before);
            CHECK(painter.document->undoSteps() == 0);
            CHECK(painter.hash() == grown);
        }
    float filled = 0;
    CHECK(!espLayerFilled(painter.context.get(), "colour.r", &filled));
    REQUIRE_MESSAGE(painter.perform(FillLayer{"colour", 1, {.75f, .125f, 0}}), painter.error);
    CHECK(painter.colours() != before);
}

TEST_CASE("a stroke of colours that can't begin at one channel hasn't begun, and one that can't end is taken back") {
    const Folder folder;
    ColourEditing painter(smallScene(folder));
    const Channels before = painter.colours();
    const uint64_t grown = painter.hash();
    for (int channel = 1; channel <= 3; ++channel) {
        CAPTURE(channel);
        CHECK(!painter.failingAt(channel, redBrush()));
        CHECK(!painter.document->stroking());
        REQUIRE(painter.perform(redBrush()));  // nothing of it is left over
        REQUIRE(painter.perform(kDab));
        CHECK(painter.colours() != before);
        CHECK(!painter.failingAt(channel, StrokeEnd{}));
        CHECK(!painter.document->stroking());
        CHECK(painter.document->undoSteps() == 0);
        CHECK(painter.colours() == before);
        CHECK(painter.hash() == grown);
    }
}
