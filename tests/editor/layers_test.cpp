// Layers that come and go with a grammar's text, and where a brush's limits are seen.
#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plugin_api/espalier.hpp"
#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/layers.hpp"
#include "tools/scene/picture.hpp"

using namespace espalier::document;
using espalier::scene::GreyPicture;

namespace {

constexpr const char* kRust = "context rust = 0 \"Turned leaves\"\n";

bool lists(const Editing& editing, const char* name) {
    const auto& layers = editing.document->scene().layers;
    return std::ranges::find(layers, name) != layers.end();
}

std::vector<float> texelsOf(Editing& editing, const char* layer) {
    GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readLayer(0, layer, picture, editing.error), editing.error);
    return picture.texels;
}

void setText(Editing& editing, const std::string& text) {
    REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, text)), editing.error);
    REQUIRE_MESSAGE(editing.document->scene().grammars[0].error.empty(), editing.document->scene().grammars[0].error);
}

void paint(Editing& editing, const char* layer) {
    StrokeBegin stroke;
    stroke.layer = layer;
    stroke.strength = stroke.hardness = 1;
    stroke.radius = .8f;
    REQUIRE_MESSAGE(editing.perform(stroke), editing.error);
    REQUIRE(editing.perform(StrokeDabs{{{.1f, 1, .36f, 0, 0, 1, 1}}}));
    REQUIRE(editing.perform(StrokeEnd{}));
}

constexpr uint32_t kWidth = 160, kHeight = 90;

// The scene's picture with its mask shown, hatched by the brush's limits if there is one.
std::vector<uint8_t> masked(Editing& editing, const EspBrush* brush, float opacity) {
    esp::DrawDef draw;
    draw.width = kWidth;
    draw.height = kHeight;
    draw.camera = editing.document->scene().camera;
    draw.look = editing.document->scene().look;
    draw.look.view = ESP_VIEW_LAYER;
    draw.look.viewLayer = "mask";
    draw.look.viewOpacity = opacity;
    draw.look.viewBrush = brush;
    REQUIRE_MESSAGE(espDraw(editing.context.get(), &draw) == ESP_OK, espLastError(editing.context.get()));
    std::vector<uint8_t> rgba(size_t(kWidth) * kHeight * 4);
    REQUIRE(espReadPixels(editing.context.get(), rgba.data(), rgba.size()) == ESP_OK);
    return rgba;
}

// What of the picture is darker than before: where the surface is beyond the limits, and where it is within them.
struct Hatched {
    float beyond = 0, within = 0;
};
template <class Within>
Hatched hatched(Editing& editing, const EspBrush& brush, float opacity, Within&& within) {
    const std::vector<uint8_t> plain = masked(editing, nullptr, opacity), limited = masked(editing, &brush, opacity);
    const EspCamera& camera = editing.document->scene().camera;
    const auto vec = [](const float* v) { return glm::vec3(v[0], v[1], v[2]); };
    const glm::vec3 eye = vec(camera.eye), forward = glm::normalize(vec(camera.target) - eye);
    const glm::vec3 right = glm::normalize(glm::cross(forward, vec(camera.up))), up = glm::cross(right, forward);
    const float tangent = std::tan(camera.fovY / 2);
    float darker[2] = {0, 0}, count[2] = {0, 0};
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const glm::vec2 at((2 * x + 1.f) / kWidth - 1, 1 - (2 * y + 1.f) / kHeight);
            const glm::vec3 ray = forward + tangent * (at.x * float(kWidth) / float(kHeight) * right + at.y * up);
            EspHit hit;
            if (espPick(editing.context.get(), &eye.x, &ray.x, &hit) != ESP_OK) continue;
            const int side = within(hit);  // 0 beyond, 1 within, else too near to say
            if (side != 0 && side != 1) continue;
            const size_t i = 4 * (size_t(y) * kWidth + x) + 1;
            darker[side] += limited[i] + 4 < plain[i];
            ++count[side];
        }
    REQUIRE(count[0] > 500);
    REQUIRE(count[1] > 500);
    return {darker[0] / count[0], darker[1] / count[1]};
}

}  // namespace

TEST_CASE("what is painted on a layer that a grammar's text has lost stays, is listed and saved, and is read again") {
    const Folder folder;
    Editing editing(smallScene(folder));
    const std::string text = editing.document->scene().grammars[0].text;
    CHECK(!lists(editing, "rust"));
    setText(editing, kRust + text);
    CHECK(lists(editing, "rust"));
    setText(editing, text);
    CHECK(!lists(editing, "rust"));  // nothing was painted on it
    setText(editing, kRust + text);
    paint(editing, "rust");
    const std::vector<float> painted = texelsOf(editing, "rust");
    CHECK(*std::ranges::max_element(painted) == 1);

    setText(editing, text);
    CHECK(lists(editing, "rust"));
    CHECK(texelsOf(editing, "rust") == painted);
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(lists(again, "rust"));
    CHECK(texelsOf(again, "rust") == painted);
    setText(again, kRust + text);
    CHECK(texelsOf(again, "rust") == painted);

    // Back over the text to the stroke, and over it.
    REQUIRE(editing.perform(Undo{}));
    CHECK(texelsOf(editing, "rust") == painted);
    REQUIRE(editing.perform(Undo{}));
    const std::vector<float> cleared = texelsOf(editing, "rust");
    CHECK(*std::ranges::max_element(cleared) == 0);
}

TEST_CASE("a stroke that changes nothing is no step of undo, keeps what can be done again, and makes no layer") {
    const Folder folder;
    Editing editing(smallScene(folder));
    Document& document = *editing.document;
    paint(editing, "size");
    const uint64_t state = document.state();
    REQUIRE(editing.perform(FillLayer{"mask", .5f}));
    REQUIRE(editing.perform(Undo{}));
    const auto stroke = [&](const char* mode, float x) {
        StrokeBegin begin;
        begin.layer = "mask";
        begin.mode = mode;
        begin.value = 1;  // which it has
        for (const Action& action :
             {Action(begin), Action(StrokeDabs{{{x, 1, .36f, 0, 0, 1, 1}}}), Action(StrokeEnd{})})
            REQUIRE_MESSAGE(editing.perform(action), editing.error);
    };
    for (const char* mode : {"paint", "erase", "smooth"}) {
        CAPTURE(mode);
        stroke(mode, .1f);
        stroke(mode, 100);  // beside all ground
        CHECK(document.state() == state);
        CHECK(document.undoSteps() == 1);
        REQUIRE(document.redoName());
        CHECK(document.redoName() == std::string("Fill mask"));
        CHECK(espPaintedLayerCount(editing.context.get()) == 1);
    }
    REQUIRE(editing.perform(Redo{}));
    CHECK(texelsOf(editing, "mask")[0] == .5f);
    REQUIRE(editing.perform(FillLayer{"mask", 0}));
    CHECK(document.undoName() == std::string("Clear mask"));
}

TEST_CASE("erasing in the scene for painted paths takes ivy away") {
    Editing editing(content("guided.json"));
    StrokeBegin begin;
    begin.layer = "mask";
    begin.mode = "erase";
    begin.radius = 1;
    begin.strength = begin.hardness = 1;
    const auto most = [&] {
        const std::vector<float> texels = texelsOf(editing, "mask");
        return std::accumulate(texels.begin(), texels.end(), 0.0);
    };
    const double before = most();
    // Where its mask is black, and along the wall, where it is white.
    StrokeDabs dabs;
    for (float x = -2.5f; x < 2.5f; x += .5f)
        for (float y = .2f; y < 3; y += .5f) dabs.dabs.push_back({x, y, .36f, 0, 0, 1, 1});
    for (const Action& action : {Action(begin), Action(dabs), Action(StrokeEnd{})})
        REQUIRE_MESSAGE(editing.perform(action), editing.error);
    CHECK(before > 0);
    CHECK(most() < before / 2);
}

TEST_CASE("a layer is hatched where the brush's limits let no paint pass, and nowhere else") {
    const Folder folder;
    Editing editing(smallScene(folder));
    StrokeBegin stroke;
    stroke.layer = "mask";
    EspBrush brush;
    const auto ready = [&] { REQUIRE_MESSAGE(brushOf(stroke, brush, editing.error), editing.error); };
    ready();
    CHECK(masked(editing, &brush, .75f) == masked(editing, nullptr, .75f));
    for (const float opacity : {.05f, 1.f}) {
        stroke.height = {1, 1e6f};
        stroke.slope = StrokeBegin{}.slope;
        ready();
        const Hatched high = hatched(editing, brush, opacity, [](const EspHit& hit) {
            return hit.position[1] > 1.05f ? 1 : hit.position[1] < .95f ? 0 : -1;
        });
        CHECK(high.beyond > .2f);
        CHECK(high.within < .01f);  // silhouettes
        stroke.height = StrokeBegin{}.height;
        stroke.slope = {0, .785f};
        ready();
        const Hatched flat = hatched(editing, brush, opacity, [](const EspHit& hit) {
            return hit.normal[1] > .95f ? 1 : hit.normal[1] < .3f ? 0 : -1;
        });
        CHECK(flat.beyond > .2f);
        CHECK(flat.within < .1f);  // normals of edges lean
    }
    stroke.mode = "scrub";
    CHECK(!brushOf(stroke, brush, editing.error));
}

TEST_CASE("a label's names for values are read out of it, and what else it says is a note") {
    using espalier::scene::labelWords;
    const auto words =
        labelWords("Wall height: 0 half, 0.5 as it is, 1 half as high again, of the whole house, all of it");
    const auto& names = words.values;
    REQUIRE(names.size() == 3);
    CHECK(names[0].value == 0);
    CHECK(names[0].name == "half");
    CHECK(names[1].value == .5f);
    CHECK(names[1].name == "as it is");
    CHECK(names[2].name == "half as high again");
    CHECK(words.note == "of the whole house, all of it");
    for (const char* none : {"", "Moss", "Moss, 0 none", "Odd:", "Odd: ", "Ratio 1:1"}) {
        CHECK_MESSAGE(labelWords(none).values.empty(), none);
        CHECK_MESSAGE(labelWords(none).note.empty(), none);
    }
    CHECK(labelWords("Odd: 2 much, -1 little, 0").values.empty());
    CHECK(labelWords("Tint: white as they come").note == "white as they come");
}
