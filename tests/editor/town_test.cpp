// Houses that a designer changes: judged by what the plugin says of them, and by the roofs of the whole town.
#include <algorithm>
#include <glm/glm.hpp>

#include "plugin_api/espalier.hpp"
#include "tests/editor/editing.hpp"
#include "tools/document/project.hpp"
#include "tools/scene/text_file.hpp"

using namespace espalier::document;
using espalier::scene::House;

namespace {

// The fingerprint of the whole town, grown as if it had just been loaded.
uint64_t roofs(Editing& editing) {
    EspContext* context = editing.context.get();
    EspGrammar grammar{};
    REQUIRE(espTownGrammar(context, &grammar) == ESP_OK);
    REQUIRE(espSetTownGrammar(context, grammar) == ESP_OK);
    REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    EspRoofStats stats;
    REQUIRE(espReadRoofStats(context, &stats) == ESP_OK);
    return stats.hash;
}

House houseOf(const Editing& editing, uint32_t index) {
    return espalier::scene::houseNow(editing.context.get(), index);
}

}  // namespace

TEST_CASE("a house is changed, undone to what its town says, done again and saved") {
    Editing editing(content("town.json"));
    const uint64_t planned = roofs(editing);
    const House before = houseOf(editing, 0);
    REQUIRE(before.corners.size() == 6);

    House wanted = before;
    wanted.shape = "gable";
    wanted.slope = .8f;
    wanted.eaveHeight = 4;
    wanted.edges = {{1, "eave", .6f}, {3, "gable", 0}};
    REQUIRE_MESSAGE(editing.perform(SetHouse{wanted}), editing.error);
    // A drag of a corner: many actions, one step.
    for (int i = 1; i <= 5; ++i) {
        wanted.corners[1][0] = before.corners[1][0] + .3f * float(i);
        REQUIRE_MESSAGE(editing.perform(SetHouse{wanted}, 7), editing.error);
    }
    CHECK(editing.document->undoSteps() == 2);
    House now = houseOf(editing, 0);
    CHECK(now.eaveHeight == doctest::Approx(4));
    CHECK(now.corners[1][0] == doctest::Approx(wanted.corners[1][0]));
    now.eaveHeight = wanted.eaveHeight;
    now.corners = wanted.corners;
    CHECK(now == wanted);
    const uint64_t changed = roofs(editing);
    CHECK(changed != planned);

    // An outline that crosses itself is refused, and the house stands.
    House crossed = wanted;
    std::swap(crossed.corners[0], crossed.corners[1]);
    CHECK(!editing.perform(SetHouse{crossed}));
    CHECK_MESSAGE(contains(editing.error, "stands as it did"), editing.error);
    CHECK(roofs(editing) == changed);
    CHECK(!editing.perform(SetHouse{{1000}}));

    REQUIRE(editing.perform(Undo{}));
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == planned);
    CHECK(houseOf(editing, 0) == before);
    REQUIRE(editing.perform(Redo{}));
    REQUIRE(editing.perform(Redo{}));
    CHECK(roofs(editing) == changed);
    REQUIRE(editing.perform(ResetHouse{0}));
    CHECK(roofs(editing) == planned);
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == changed);

    const Folder folder;
    std::string error;
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), error), error);
    Editing opened(folder.file("project"));
    CHECK(roofs(opened) == changed);
    REQUIRE(opened.perform(ResetHouse{0}));
    CHECK(roofs(opened) == planned);
}

namespace {

std::vector<float> texels(Editing& editing, const char* layer) {
    espalier::scene::GreyPicture picture;
    REQUIRE_MESSAGE(editing.document->readTownLayer(layer, picture, editing.error), editing.error);
    return picture.texels;
}

// Over the house, as a designer's brush goes: straight down.
void paint(Editing& editing, const char* layer, uint32_t house, float value) {
    StrokeBegin begin;
    begin.layer = layer;
    begin.radius = 3;
    begin.value = value;
    begin.strength = .7f;
    EspHouseInfo info;
    REQUIRE(espHouseInfo(editing.context.get(), house, &info) == ESP_OK);
    const float x = (info.boundsMin[0] + info.boundsMax[0]) / 2, z = (info.boundsMin[2] + info.boundsMax[2]) / 2;
    REQUIRE_MESSAGE(editing.perform(begin), editing.error);
    REQUIRE_MESSAGE(editing.perform(StrokeDabs{{{x, info.ridgeHeight, z, 0, 1, 0, 1}, {x + 1, 0, z, 0, 1, 0, .3f}}}),
                    editing.error);
    REQUIRE_MESSAGE(editing.perform(StrokeEnd{}), editing.error);
}

}  // namespace

TEST_CASE("a corner may go through its house, out on the other side: the outline is then read the other way round") {
    Editing editing(content("town.json"));
    uint32_t index = 0;
    EspHouseInfo info;  // of a house with four corners and no yard
    while (espHouseInfo(editing.context.get(), index, &info) == ESP_OK && info.cornerCount != 4) ++index;
    REQUIRE(index < espHouseCount(editing.context.get()));
    const House before = houseOf(editing, index);
    const auto area = [](const House& house) {
        float twice = 0;
        for (size_t i = 0; i < house.corners.size(); ++i) {
            const auto &a = house.corners[i], &b = house.corners[(i + 1) % house.corners.size()];
            twice += a[0] * b[1] - a[1] * b[0];
        }
        return twice / 2;
    };
    House through = before;
    for (int axis = 0; axis < 2; ++axis)
        through.corners[0][axis] = before.corners[2][axis] + .5f * (before.corners[2][axis] - before.corners[0][axis]);
    REQUIRE(area(through) * area(before) < 0);
    REQUIRE_MESSAGE(editing.perform(SetHouse{through}, 7), editing.error);
    const House now = houseOf(editing, index);
    CHECK(now.corners.size() == 4);
    CHECK(now.corners.size() == 4);
    CHECK(area(now) == doctest::Approx(-area(through)).epsilon(1e-3));
    // The drag goes on from what was asked for: back where it began, the house is as it was.
    through.corners[0] = before.corners[0];
    REQUIRE_MESSAGE(editing.perform(SetHouse{through}, 7), editing.error);
    CHECK(area(houseOf(editing, index)) == doctest::Approx(area(before)).epsilon(1e-3));
    CHECK(editing.document->undoSteps() == 1);
}

namespace {

// A town of one plan, grown by the library's grammar.
std::string plan(const Folder& folder, const std::string& buildings) {
    return folder.write("plan.json", "{\"buildings\": [" + buildings + "]}");
}

// Where the only gable stands: the middle of its edge.
glm::vec2 gableOf(const House& house) {
    REQUIRE(house.edges.size() == 1);
    REQUIRE(house.edges[0].end == "gable");
    const size_t edge = house.edges[0].edge;
    REQUIRE(edge < house.corners.size());
    const auto &a = house.corners[edge], &b = house.corners[(edge + 1) % house.corners.size()];
    return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2};
}

}  // namespace

TEST_CASE("an edge keeps what it has of its own when corners are needless, merge, or run the other way round") {
    const Folder folder;
    // Clockwise, with a corner that doesn't turn: the west side is its last edge.
    Editing editing(plan(folder, R"({"id": "a", "outer": [[0,8],[6,8],[12,8],[12,0],[0,0]],
                                     "edges": [{"edge": 4, "gable": true}]})"));
    House house = houseOf(editing, 0);
    CHECK(house.corners.size() == 4);
    const glm::vec2 west(0, -4);
    CHECK(glm::distance(gableOf(house), west) < .01f);
    const uint64_t planned = roofs(editing);
    house.shape = "hip";
    REQUIRE_MESSAGE(editing.perform(SetHouse{house}), editing.error);
    CHECK(roofs(editing) == planned);  // nothing was asked for

    // A corner is dragged onto the one before it: the edge between them is gone, the others have other numbers.
    House merged = house;
    const uint32_t far = (house.edges[0].edge + 2) % 4;
    merged.corners[(far + 1) % 4] = merged.corners[far];
    REQUIRE_MESSAGE(editing.perform(SetHouse{merged}), editing.error);
    CHECK(houseOf(editing, 0).corners.size() == 3);
    CHECK(glm::distance(gableOf(houseOf(editing, 0)), west) < .01f);
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == planned);

    // Given the other way round, and with a new corner in the first edge.
    House turned = houseOf(editing, 0);
    std::ranges::reverse(turned.corners);
    turned.edges[0].edge = uint32_t(turned.corners.size() - 2 - turned.edges[0].edge) % 4;
    REQUIRE_MESSAGE(editing.perform(SetHouse{turned}), editing.error);
    CHECK(glm::distance(gableOf(houseOf(editing, 0)), west) < .01f);
    CHECK(roofs(editing) == planned);
    REQUIRE(editing.perform(ResetHouse{0}));
    CHECK(roofs(editing) == planned);
}

TEST_CASE("houses that one outline falls into are changed one by one") {
    const Folder folder;
    Editing editing(plan(folder, R"({"id": "bow", "outer": [[0,0],[12,12],[12,0],[0,12]]},
                                    {"id": "b", "outer": [[20,0],[30,0],[30,8],[20,8]]})"));
    REQUIRE(espHouseCount(editing.context.get()) == 3);
    const uint64_t planned = roofs(editing);
    const House first = houseOf(editing, 0), second = houseOf(editing, 1);
    House wider = second;
    wider.slope = 1.2f;
    wider.corners[0][0] += wider.corners[0][0] > 6 ? 1 : -1;
    REQUIRE_MESSAGE(editing.perform(SetHouse{wider}), editing.error);
    CHECK(houseOf(editing, 1).slope == doctest::Approx(1.2));
    CHECK(houseOf(editing, 0) == first);
    const uint64_t changed = roofs(editing);
    CHECK(changed != planned);
    REQUIRE(editing.perform(ResetHouse{1}));
    CHECK(houseOf(editing, 1) == second);
    CHECK(roofs(editing) == planned);
    REQUIRE(editing.perform(Undo{}));
    CHECK(roofs(editing) == changed);
    REQUIRE(editing.perform(ResetHouse{1}));
    House flat = second;
    flat.look->overhang = flat.look->overhang > .5f ? 0.f : 1.f;
    REQUIRE_MESSAGE(editing.perform(SetHouse{flat}), editing.error);
    CHECK(houseOf(editing, 1).look->overhang == flat.look->overhang);
    CHECK(houseOf(editing, 0) == first);
    CHECK(houseOf(editing, 1).corners == second.corners);
}

TEST_CASE("outlines without area are refused, and roofs that can't be as asked say so and remember what was asked") {
    const Folder folder;
    Editing editing(plan(folder, R"({"id": "l", "outer": [[0,0],[20,0],[20,4],[4,4],[4,20],[0,20]]})"));
    const auto note = [&] {
        EspHouseInfo info;
        REQUIRE(espHouseInfo(editing.context.get(), 0, &info) == ESP_OK);
        return std::string(info.note);
    };
    const uint64_t planned = roofs(editing);
    const House before = houseOf(editing, 0);
    CHECK(note().empty());
    for (const int axis : {0, 1}) {
        House flat = before;
        for (auto& corner : flat.corners) corner[size_t(axis)] = 3;
        CHECK(!editing.perform(SetHouse{flat}));
        CHECK_MESSAGE(editing.error == "l: the outline has no area that could carry a roof; it stands as it did",
                      editing.error);
    }
    CHECK(roofs(editing) == planned);
    CHECK(editing.document->undoSteps() == 0);

    House pyramid = before;
    pyramid.shape = "pyramid";
    REQUIRE_MESSAGE(editing.perform(SetHouse{pyramid}), editing.error);
    CHECK_MESSAGE(contains(note(), "hip roof instead"), note());
    House now = houseOf(editing, 0);
    CHECK(now.shape == "pyramid");
    now.corners = {{0, 0}, {10, 0}, {10, -10}, {0, -10}};
    now.rings = {4};
    REQUIRE_MESSAGE(editing.perform(SetHouse{now}), editing.error);
    CHECK_MESSAGE(note().empty(), note());
    CHECK(houseOf(editing, 0).shape == "pyramid");
}

TEST_CASE("layers painted over a town are saved to the bit, reopened, undone") {
    const Folder folder;
    Editing editing(content("town.json"));
    const uint64_t planned = roofs(editing);
    const std::vector<float> clean = texels(editing, "moss");

    paint(editing, "moss", 0, .8f);
    paint(editing, "rise", 1, 1);
    REQUIRE_MESSAGE(editing.perform(FillLayer{"soot", .25f}), editing.error);
    espalier::scene::GreyPicture picture{5, 3, std::vector<float>(15)};
    for (size_t i = 0; i < 15; ++i) picture.texels[i] = float(i) / 17;
    REQUIRE(writeGrey(folder.file("decay.exr"), picture, editing.error));
    REQUIRE_MESSAGE(editing.perform(LoadTownLayer{"decay", folder.file("decay.exr")}), editing.error);
    CHECK(editing.document->undoSteps() == 4);
    const uint64_t painted = roofs(editing);
    CHECK(painted != planned);  // `rise` lifts a roof
    // A house that changes leaves the layers where they are.
    House house = houseOf(editing, 2);
    house.corners[0][0] -= 5;
    REQUIRE_MESSAGE(editing.perform(SetHouse{house}), editing.error);

    std::string error;
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("project"), error), error);
    {
        Editing opened(folder.file("project"));
        for (const char* name : {"moss", "rise", "soot", "decay"}) {
            CAPTURE(name);
            CHECK(texels(opened, name) == texels(editing, name));
        }
        CHECK(roofs(opened) == roofs(editing));
        uint32_t count = 0;
        for (const auto& layer : espalier::scene::townLayers(opened.context.get())) {
            count += layer.painted;
            if (layer.name == "rise" || layer.name == "steep") CHECK(layer.fill == .5f);
        }
        CHECK(count == 4);
        // Saved again it is the same project.
        REQUIRE_MESSAGE(saveProject(*opened.document, folder.file("again"), error), error);
        std::string once, twice;
        REQUIRE(espalier::scene::readText(folder.file("project/project.json"), once, error));
        REQUIRE(espalier::scene::readText(folder.file("again/project.json"), twice, error));
        CHECK(once == twice);
    }

    REQUIRE(editing.perform(Undo{}));  // the house
    const std::vector<float> decayed = texels(editing, "decay");
    REQUIRE(editing.perform(Undo{}));
    CHECK(texels(editing, "decay") != decayed);
    REQUIRE(editing.perform(Redo{}));
    CHECK(texels(editing, "decay") == decayed);
    for (int i = 0; i < 4; ++i) REQUIRE(editing.perform(Undo{}));
    CHECK(texels(editing, "moss") == clean);
    CHECK(roofs(editing) == planned);

    CHECK(!editing.perform(LoadTownLayer{"moss", folder.file("missing.png")}));
}

TEST_CASE("what is painted over a town stays when its grammar loses the layer, in projects too, and is read again") {
    const Folder folder;
    Editing editing(content("town.json"));
    const auto town = [](const Editing& of) {
        EspGrammar grammar{};
        REQUIRE(espTownGrammar(of.context.get(), &grammar) == ESP_OK);
        const auto& grammars = of.document->scene().grammars;
        const auto found = std::ranges::find(grammars, grammar.id, [](const auto& g) { return g.id.id; });
        REQUIRE(found != grammars.end());
        return uint32_t(found - grammars.begin());
    };
    const auto setText = [&](Editing& of, const std::string& text) {
        REQUIRE_MESSAGE(of.perform(of.document->withText(town(of), text)), of.error);
        const std::string& mistake = of.document->scene().grammars[town(of)].error;
        REQUIRE_MESSAGE(mistake.empty(), mistake);
    };
    const auto lists = [](const Editing& of, const char* name) {
        return std::ranges::count(of.document->scene().layers, name) == 1;
    };
    const std::string without = editing.document->scene().grammars[town(editing)].text;
    const std::string with = "context lichen = 0\n" + without;
    setText(editing, with);
    paint(editing, "lichen", 0, .8f);
    const std::vector<float> painted = texels(editing, "lichen");
    CHECK(*std::ranges::max_element(painted) > .5f);
    setText(editing, without);
    CHECK(lists(editing, "lichen"));
    CHECK(texels(editing, "lichen") == painted);
    paint(editing, "lichen", 1, .5f);  // the brush still reaches it
    const std::vector<float> more = texels(editing, "lichen");
    CHECK(more != painted);

    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(again.document->scene().notes.empty());
    CHECK(lists(again, "lichen"));
    CHECK(texels(again, "lichen") == more);
    setText(again, with);
    CHECK(lists(again, "lichen"));
    CHECK(texels(again, "lichen") == more);
    REQUIRE(editing.perform(Undo{}));
    CHECK(texels(editing, "lichen") == painted);
}

TEST_CASE("a scene whose rings aren't made of its corners is refused where it says so") {
    const Folder folder;
    folder.write("plan.json", R"({"buildings": [{"id": "h", "outer": [[0, 0], [10, 0], [10, 8], [0, 8]]}]})");
    const auto refused = [&](const std::string& rings) {
        const std::string scene = folder.write(
            "scene.json",
            "{\"town\": {\"file\": \"plan.json\", \"houses\": [{\"house\": 0, \"shape\": \"hip\", \"slope\": 1,"
            "\"eave_height\": 3, \"corners\": [[0,0],[10,0],[10,-8],[0,-8],[3,-3],[3,-5],[6,-5]],\n\"rings\": " +
                rings + "}]}}");
        const Ran ran = run(program("espalier-capture") + " " + scene + " --size 64x36 -o " + folder.file("out"));
        CHECK_MESSAGE(ran.code == 1, ran.output);
        CHECK_MESSAGE(contains(ran.output, "scene.json:2:"), ran.output);
        return ran.output;
    };
    CHECK(contains(refused("[4, 2]"), "three or more of the corners"));
    CHECK(contains(refused("[4, 4]"), "three or more of the corners"));
    CHECK(contains(refused("[4]"), "3 corners are of no ring"));
    CHECK(contains(refused("[4, 2.5]"), "three or more of the corners"));
}

TEST_CASE("a town's layer of colours is painted, shown in its colours, and told of when no text reads it any more") {
    const Folder folder;
    Editing editing(folder.write("slates.json", R"({"town": {"file": ")" + content("town.json") +
                                                    R"("}, "grammars": [{"file": ")" +
                                                    content("grammars/roof_hip_slate.grammar") + R"("}]})"));
    const std::string text = editing.document->scene().grammars[0].text;
    std::string tinted = "context shade = #ffffff\n" + text;
    tinted.insert(tinted.find("Covering -> Slates"), "Covering : shade.r(house) < 0.2 -> NULL\n");
    REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, tinted)), editing.error);
    REQUIRE_MESSAGE(editing.document->scene().grammars[0].error.empty(), editing.document->scene().grammars[0].error);
    REQUIRE_MESSAGE(editing.perform(FillLayer{"shade", 0, {.8f, .1f, 0}}), editing.error);
    esp::DrawDef draw;
    draw.width = 160;
    draw.height = 90;
    draw.camera = editing.document->scene().camera;
    draw.look = editing.document->scene().look;
    draw.look.view = ESP_VIEW_LAYER;
    draw.look.viewLayer = "shade";
    const auto reds = [&](Editing& of) {
        REQUIRE_MESSAGE(espUpdate(of.context.get()) == ESP_OK, espLastError(of.context.get()));
        REQUIRE_MESSAGE(espDraw(of.context.get(), &draw) == ESP_OK, espLastError(of.context.get()));
        std::vector<uint8_t> rgba(size_t(draw.width) * draw.height * 4);
        REQUIRE(espReadPixels(of.context.get(), rgba.data(), rgba.size()) == ESP_OK);
        size_t red = 0;
        for (size_t i = 0; i < rgba.size(); i += 4) red += rgba[i] > 2 * rgba[i + 1] && rgba[i] > 100;
        return red;
    };
    CHECK(reds(editing) > 500);
    REQUIRE_MESSAGE(editing.perform(editing.document->withText(0, text)), editing.error);
    REQUIRE_MESSAGE(saveProject(*editing.document, folder.file("saved"), editing.error), editing.error);
    Editing again(folder.file("saved"));
    CHECK(std::ranges::count(again.document->scene().layers, "shade") == 1);
    CHECK(reds(again) == 0);  // grey, and no failure
}
