// Roofs as they get smaller in the picture: what of them is still seen, and how tiles are lit. They lean here, so that
// under an overhead sun a roof with its relief is darker than one that is lit as its face.
#include <algorithm>
#include <cmath>

#include "runtime/render/renderer.hpp"
#include "runtime/render/roof_profile.hpp"
#include "tests/emit/fixture.hpp"
#include "tests/roof_growth/grow_support.hpp"

using namespace roof_test;

namespace {

// A quad over its cell with normals that lean up the slope by `lean` radians, of a cell of kSlates.
TerminalData leaning(float lean) {
    TerminalData data;
    data.kinds = {"slate", "ridge", "panel"};
    data.materials.resize(1);
    const glm::vec3 normal = glm::normalize(glm::vec3(0, 0.25f * std::sin(lean), std::cos(lean)));
    for (uint32_t i = 0; i < 4; ++i)
        data.vertices.push_back({{float(i & 1), float(i >> 1), 0}, packOct(normal), {1, 1}});
    data.indices = {0, 1, 3, 0, 3, 2};
    for (uint32_t kind = 0; kind < 3; ++kind)
        data.variants.push_back({data.kinds[kind], kind, {TerminalLod{0, 4, 0, 6, 0, 0}}});
    return data;
}

// Ribs up the slope: either half of a cell leans away from its middle by `lean` radians.
TerminalData ribbed(float lean) {
    TerminalData data = leaning(0);
    data.vertices.clear();
    data.indices.clear();
    for (const float side : {-1.f, 1.f}) {
        const glm::vec3 normal = glm::normalize(glm::vec3(0.25f * side * std::sin(lean), 0, std::cos(lean)));
        const uint32_t first = uint32_t(data.vertices.size());
        for (uint32_t i = 0; i < 4; ++i)
            data.vertices.push_back(
                {{(side < 0 ? 0.f : 0.5f) + 0.5f * float(i & 1), float(i >> 1), 0}, packOct(normal), {1, 1}});
        for (uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) data.indices.push_back(first + i);
    }
    for (TerminalVariant& v : data.variants) v.lods = {TerminalLod{0, 8, 0, 12, 0, 0}};
    return data;
}

// Caps of black along the ridge of a white roof, 0.4 m long, 0.28 m wide and 0.3 m high.
const std::string kCapped =
    "House -> Extrude(wallHeight) {NULL, TopWall}\n"
    "TopWall -> Join(roofHeight, roofPos1, roofPos2) {Cover, Joints, NULL}\n"
    "Cover -> Colour(1, 1, 1) Shape(\"panel\")\n"
    "Joints -> Explode() {NULL, NULL, Line, Line, Line}\n"
    "Line : owner == 1 and joint == ridge -> Repeat(X, 0.4) {Cap}\n"
    "Cap -> S(sizeX, 0.28, 0.3) Colour(0, 0, 0) Shape(\"ridge\")\n";

// A panel, and a cap that is bent over its line.
TerminalData bent() {
    TerminalData data = leaning(0);
    for (float y : {-0.5f, 0.0f, 0.5f})
        for (float x : {0.0f, 1.0f})
            data.vertices.push_back({{x, y, y == 0 ? 1.0f : 0.0f}, packOct({0, 0, 1}), {1, 1}});
    for (uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u, 2u, 3u, 5u, 2u, 5u, 4u}) data.indices.push_back(i);
    data.variants[1].lods[0] = TerminalLod{4, 6, 6, 12, 0, 0};
    return data;
}

// White walls with black panes that stand apart in a row, 1 m wide, one each 2.5 m.
const std::string kPanes =
    "House -> Extrude(wallHeight) {Wall, NULL}\n"
    "Wall -> Plaster Panes\n"
    "Plaster -> Colour(1, 1, 1) Shape(\"panel\")\n"
    "Panes -> T(0, 0, 0.02) Repeat(X, 2.5) {Pane}\n"
    "Pane -> T(0.75, 1) S(1, 1.35) Colour(0, 0, 0) Shape(\"slate\")\n";

// A square picture.
std::vector<uint8_t> picture(Device& device, Renderer& renderer, const DrawInputs& inputs, uint32_t pixels) {
    DrawTarget target;
    target.width = target.height = pixels;
    Result<Commands> commands = Commands::begin(device, "roof");
    REQUIRE(commands);
    REQUIRE(renderer.draw(*commands, inputs, target));
    REQUIRE(commands->finish());
    device.collect();
    return std::move(*renderer.readPixels());
}

// What of a picture of a house with walls 20 m long is dark, seen from before its middle, at the height of its eaves
// and `above`.
struct Seen {
    std::vector<bool> dark;
    RoofDrawStats stats;
};
constexpr uint32_t kSide = 240;
Seen seen(Device& device, const std::string& grammar, const TerminalData& meshes, float above, float away) {
    std::unique_ptr<Renderer> renderer = std::move(*Renderer::create(device, test::simpleTerminals()));
    const std::vector<RoofMesh> bounds = std::move(*renderer->loadRoofMeshes(meshes));
    const Roofs house = roofs({footprint({{0, 0}, {20, 0}, {20, 12}, {0, 12}}, RoofShape::hip, 0.5)}, grammar);
    std::unique_ptr<RoofGrowth> growth = std::move(*RoofGrowth::create(device));
    RoofInputs inputs = house.inputs();
    inputs.meshes = bounds;
    REQUIRE(growth->grow(inputs));
    const RoofView view = growth->view();
    DrawInputs drawn;
    drawn.roofs = &view;
    drawn.camera.target = glm::vec3(10, float(house.structure.houses[0].eaveHeight) + above, -6);
    drawn.camera.eye = drawn.camera.target + glm::vec3(0, 0, away);
    drawn.look.shadows = false;
    const std::vector<uint8_t> rgba = picture(device, *renderer, drawn, kSide);
    Seen out{{}, renderer->stats().roofs};
    for (size_t i = 0; i < rgba.size(); i += 4) out.dark.push_back(rgba[i] + rgba[i + 1] + rgba[i + 2] < 150);
    return out;
}

// Of a row of pixels.
size_t darkRuns(const Seen& seen, uint32_t row) {
    size_t runs = 0;
    for (uint32_t x = 1; x < kSide; ++x) runs += seen.dark[row * kSide + x] && !seen.dark[row * kSide + x - 1];
    return runs;
}

// A slated roof seen from straight above: nothing else is in the picture.
struct Above {
    Device& device;
    std::unique_ptr<Renderer> renderer;
    std::vector<RoofMesh> bounds;
    Roofs slated = roofs({footprint({{0, 0}, {20, 0}, {20, 12}, {0, 12}}, RoofShape::hip, 0.1)}, kSlates);
    std::unique_ptr<RoofGrowth> growth;

    Above(Device& on, const TerminalData& meshes) : device(on) {
        renderer = std::move(*Renderer::create(device, test::simpleTerminals()));
        bounds = std::move(*renderer->loadRoofMeshes(meshes));
        growth = std::move(*RoofGrowth::create(device));
        RoofInputs inputs = slated.inputs();
        inputs.meshes = bounds;
        REQUIRE(growth->grow(inputs));
    }
    // How light a picture of the roof is, 0 to 255, from `metres` above its slope.
    double light(uint32_t pixels, float metres, bool quick) {
        const RoofHouse& house = slated.structure.houses[0];
        const RoofView view = growth->view();
        DrawInputs inputs;
        inputs.roofs = &view;
        inputs.camera.target = glm::vec3(10, float(house.eaveHeight) + 0.4f, -3.5f);
        inputs.camera.eye = inputs.camera.target + glm::vec3(0, metres, 0);
        inputs.camera.up = {0, 0, -1};
        inputs.look.shadows = false;
        inputs.look.sunDirection = {0, 1, 0};
        inputs.look.exposure = -3;
        inputs.look.quick = quick;
        const std::vector<uint8_t> rgba = picture(device, *renderer, inputs, pixels);
        const RoofDrawStats drawn = renderer->stats().roofs;
        CHECK((drawn.tiles > 50 || drawn.rectangles > 0));
        double sum = 0;
        for (size_t i = 0; i < rgba.size(); i += 4) sum += double(rgba[i]) + rgba[i + 1] + rgba[i + 2];
        return sum / (3.0 * pixels * pixels);
    }
};

}  // namespace

TEST_CASE("panes that stand apart in a row are each seen from afar, as long as they are some pixels wide") {
    DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    for (const float away : {40.f, 70.f, 100.f, 140.f}) {
        CAPTURE(away);
        const Seen panes = seen(**device, kPanes, leaning(0), -1, away);
        size_t most = 0;
        for (uint32_t row = 0; row < kSide; ++row) most = std::max(most, darkRuns(panes, row));
        CHECK(most == 8);
    }
    CHECK((*device)->validationMessages() == 0);
}

TEST_CASE("near roofs keep their tiles' relief in the smaller pictures of what moves") {
    DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    {
        Above relief(**device, leaning(1)), flat(**device, leaning(0));
        // A slate is 17 pixels high in the settled picture, and half of that in the moving one.
        const double settled = relief.light(240, 3.9f, false), unlit = flat.light(240, 3.9f, false);
        REQUIRE(settled < 0.9 * unlit);
        const double far = relief.light(240, 9, false);
        CHECK(far > settled + 0.5 * (unlit - settled));  // settled pictures take it away earlier
        if ((*device)->info().cpu) {
            const double moving = relief.light(120, 3.9f, true);
            MESSAGE("settled " << settled << ", moving " << moving << ", far " << far << ", without relief " << unlit);
            CHECK(std::abs(moving - settled) < 0.2 * (unlit - settled));
        }
    }
    CHECK((*device)->validationMessages() == 0);
}

// Two planes, the right one steeper and darker, with a batten across that lies above both.
TEST_CASE("a covering's profile has the slopes and shades of what lies on top, and their means") {
    TerminalData data = leaning(0);
    data.vertices.clear();
    data.indices.clear();
    const auto quad = [&](glm::vec2 low, glm::vec2 high, float z, float slope, float shade) {
        const uint32_t first = uint32_t(data.vertices.size());
        for (uint32_t i = 0; i < 4; ++i) {
            const glm::vec2 at(i & 1 ? high.x : low.x, i >> 1 ? high.y : low.y);
            data.vertices.push_back({{at.x, at.y, z + slope * (at.x - low.x)},
                                     packOct(glm::normalize(glm::vec3(-slope, 0, 1))),
                                     {shade, 0}});
        }
        for (uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) data.indices.push_back(first + i);
    };
    quad({0, 0}, {.5f, 1}, 0, .2f, .8f);
    quad({.5f, 0}, {1, 1}, .1f, -.6f, .4f);
    quad({0, .1f}, {1, .3f}, .5f, 0, 1);
    data.variants = {{data.kinds[0], 0, {TerminalLod{0, 12, 0, 18, 0, 0}}}};
    const std::vector<RoofProfile> profiles = roofProfiles(data);
    REQUIRE(profiles.size() == 3 * kProfileSteps);
    const float open = .8f;  // of each column, beside the batten
    for (uint32_t i = 0; i < kProfileSteps; ++i) {
        CAPTURE(i);
        const bool left = i < kProfileSteps / 2;
        CHECK(profiles[i].slope == doctest::Approx(open * (left ? .2f : -.6f)).epsilon(.01));
        CHECK(profiles[i].shade == doctest::Approx(open * (left ? .8f : .4f) + .2f).epsilon(.01));
        CHECK(profiles[i].steepness == doctest::Approx(open * .4f).epsilon(.01));
        CHECK(profiles[i].meanShade == doctest::Approx(open * .6f + .2f).epsilon(.01));
        CHECK(profiles[kProfileSteps + i].shade == 1);  // a kind without a mesh
    }
}

TEST_CASE("far roofs are as dark as the ribs of their tiles are near by") {
    DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    {
        Above ribs(**device, ribbed(1.2f)), flat(**device, leaning(0));
        const double near = ribs.light(240, 2, false), unlit = flat.light(240, 2, false);
        REQUIRE(near < 0.8 * unlit);
        CHECK(ribs.light(240, 5, false) == doctest::Approx(near).epsilon(0.06));
        for (const uint32_t pixels : {240u, 160u, 110u, 70u}) {
            CAPTURE(pixels);
            CHECK(ribs.light(pixels, 9, false) == doctest::Approx(near).epsilon(0.06));
        }
        CHECK(ribs.renderer->stats().roofs.tiles == 0);
    }
    CHECK((*device)->validationMessages() == 0);
}

TEST_CASE("a far ridge's caps are seen from the side") {
    DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    const Seen ridge = seen(**device, kCapped, bent(), 3, 40);
    CHECK(ridge.stats.rectangles > 0);
    CHECK(std::count(ridge.dark.begin(), ridge.dark.end(), true) > 60);  // 8 m of it, 8 pixels a metre, 2 pixels high
    CHECK((*device)->validationMessages() == 0);
}
