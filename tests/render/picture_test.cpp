// Pictures of ivy made on the CPU, judged by their statistics. With ESPALIER_PICTURES=DIR they are written there.
#include <doctest/doctest.h>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <iostream>

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "runtime/render/renderer.hpp"
#include "tests/emit/fixture.hpp"
#include "tests/render/wall.hpp"
#include "tests/support/heap.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

using namespace espalier;
using espalier::test::wall;

namespace {

void save(const std::string& name, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    if (const char* folder = std::getenv("ESPALIER_PICTURES"))
        stbi_write_png((std::string(folder) + "/" + name + ".png").c_str(), int(width), int(height), 4, rgba.data(),
                       int(width * 4));
}

TerminalData terminals() {
    if (const char* file = std::getenv("ESPALIER_TERMINALS")) {
        Result<TerminalData> data = readTerminals(file);
        REQUIRE_MESSAGE(data, (data ? "" : data.failure().text()));
        return std::move(*data);
    }
    return test::simpleTerminals();
}

}  // namespace

TEST_CASE("ivy on a wall") {
    DeviceOptions options;
    options.validation = std::getenv("ESPALIER_NO_VALIDATION") == nullptr;
    Result<std::unique_ptr<Device>> device = Device::create(options);
    REQUIRE(device);
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(**device, terminals());
    REQUIRE_MESSAGE(renderer, (renderer ? "" : renderer.failure().text()));
    REQUIRE((*renderer)->setSurface(0, wall(4, 2.6f), glm::mat4(1)));
    const test::PlantData data = test::wallIvy(14, 3.2f, 2.6f);
    const test::Plant plant = test::upload(**device, data);

    DrawInputs inputs;
    inputs.growth = plant.view;
    inputs.surfaces = plant.surfaceBuf;
    const struct {
        const char* name;
        glm::vec3 eye, target;
        ViewMode mode;
    } shots[] = {{"wall_far", {1.6f, 1.5f, 4.2f}, {0, 1.1f, 0}, ViewMode::shaded},
                 {"wall_near", {0.5f, 1.2f, 0.95f}, {0.1f, 1.1f, 0}, ViewMode::shaded},
                 {"wall_foot", {0.6f, 0.35f, 0.9f}, {0.2f, 0.25f, 0}, ViewMode::shaded},
                 {"wall_lod", {1.6f, 1.5f, 4.2f}, {0, 1.1f, 0}, ViewMode::lod}};
    for (const auto& shot : shots) {
        if (const char* only = std::getenv("ESPALIER_SHOT"); only && only != std::string(shot.name)) continue;
        inputs.camera.eye = shot.eye;
        inputs.camera.target = shot.target;
        inputs.look.view = shot.mode;
        DrawTarget target;
        double cpuMs = 0;  // of all threads, which a busy machine distorts less than the wall clock
        for (int round = 0; round < 2; ++round) {
            const std::clock_t start = std::clock();
            Result<Commands> commands = Commands::begin(**device, "frame");
            REQUIRE(commands);
            REQUIRE((*renderer)->draw(*commands, inputs, target));
            REQUIRE(commands->finish());
            cpuMs = 1000.0 * double(std::clock() - start) / CLOCKS_PER_SEC;
        }
        (*device)->collect();
        const RenderStats stats = (*renderer)->stats();
        std::cout << shot.name << ": " << data.nodes.size() << " nodes, " << data.leaves.size() << " leaves, "
                  << stats.emit.spans << " spans and " << stats.emit.leaves << " leaves seen, "
                  << stats.emit.drawnTriangles << " of " << stats.emit.fullTriangles << " triangles; CPU " << cpuMs
                  << " ms;";
        for (const PassTime& t : (*device)->timings()) std::cout << " " << t.name << " " << t.milliseconds << " ms";
        std::cout << std::endl;
        Result<std::vector<uint8_t>> pixels = (*renderer)->readPixels();
        REQUIRE(pixels);
        CHECK(stats.drawMs > 0);
        CHECK(stats.emit.drawnTriangles < stats.emit.fullTriangles);
        save(shot.name, *pixels, target.width, target.height);
    }
    for (const std::string& text : (*device)->validationTexts()) MESSAGE(text);
    CHECK((*device)->validationMessages() == 0);
}

namespace {

struct Studio {
    std::unique_ptr<Device> device;
    std::unique_ptr<Renderer> renderer;
    test::PlantData data = test::wallIvy(10, 3, 2);
    test::Plant plant;
    DrawInputs inputs;

    Studio() {
        DeviceOptions options;
        options.validation = true;
        device = std::move(*Device::create(options));
        renderer = std::move(*Renderer::create(*device, test::simpleTerminals()));
        REQUIRE(renderer->setSurface(0, wall(4, 2.6f), glm::mat4(1)));
        plant = test::upload(*device, data);
        inputs.growth = plant.view;
        inputs.surfaces = plant.surfaceBuf;
        inputs.camera.eye = {0.8f, 1.2f, 3.6f};
        inputs.camera.target = {0, 0.9f, 0};
    }
    ~Studio() {
        for (const std::string& text : device->validationTexts()) MESSAGE(text);
        CHECK(device->validationMessages() == 0);
    }
    std::vector<uint8_t> draw(uint32_t width, uint32_t height) {
        Result<Commands> commands = Commands::begin(*device, "frame");
        REQUIRE(commands);
        DrawTarget target;
        target.width = width;
        target.height = height;
        REQUIRE(renderer->draw(*commands, inputs, target));
        REQUIRE(commands->finish());
        return *renderer->readPixels();
    }
};

// Share of pixels for which `test` holds.
double share(const std::vector<uint8_t>& rgba, const std::function<bool(int r, int g, int b)>& test) {
    size_t hits = 0;
    for (size_t i = 0; i < rgba.size(); i += 4) hits += test(rgba[i], rgba[i + 1], rgba[i + 2]);
    return double(hits) / (double(rgba.size()) / 4);
}
bool green(int r, int g, int b) {
    return g > r + 8 && g > b + 8;
}

}  // namespace

TEST_CASE("a picture is the same on every run, whatever the order of instances") {
    std::vector<uint8_t> first;
    for (int round = 0; round < 3; ++round) {
        Studio studio;
        std::vector<uint8_t> picture = studio.draw(320, 180);
        if (round == 0) first = picture;
        CHECK(picture == first);
        CHECK(studio.draw(320, 180) == first);  // with the kept shadow map
    }
}

TEST_CASE(
    "shadows follow growth at once; if they may lag, they stay behind in a long stroke, and catch up when it rests") {
    Studio fresh, studio, prompt;
    studio.inputs.look.shadowsLag = true;
    auto grown = [](Studio& in, uint32_t leaves) {
        in.inputs.growth.leafCount = leaves;
        ++in.inputs.growth.revision;
        return in.draw(160, 90);
    };
    const uint32_t all = studio.inputs.growth.leafCount;
    const std::vector<uint8_t> wanted = grown(fresh, all / 8);
    studio.draw(160, 90);
    CHECK(grown(studio, all / 8) == wanted);
    studio.draw(160, 90);
    for (Studio* in : {&studio, &prompt})
        for (uint32_t frame = 0; frame < 4; ++frame) grown(*in, all - frame);
    CHECK(grown(studio, all / 8) != wanted);
    CHECK(grown(prompt, all / 8) == wanted);
    CHECK(studio.draw(160, 90) == wanted);
}

TEST_CASE("leaves are green, the wall casts shadows, the sky is above") {
    Studio studio;
    const std::vector<uint8_t> grown = studio.draw(320, 180);
    CHECK(share(grown, green) > 0.08);
    CHECK(int(grown[2]) > int(grown[0]));  // the first pixel is sky: bluish
    studio.inputs.look.shadows = false;
    const std::vector<uint8_t> flat = studio.draw(320, 180);
    size_t shaded = 0;  // pixels that lose three tenths of their brightness
    for (size_t i = 0; i < flat.size(); i += 4)
        shaded += 10 * (grown[i] + grown[i + 1] + grown[i + 2]) < 7 * (flat[i] + flat[i + 1] + flat[i + 2]);
    CHECK(double(shaded) > 0.03 * double(flat.size() / 4));
    studio.inputs.look.shadows = true;
    studio.inputs.growth = {};
    const std::vector<uint8_t> bare = studio.draw(320, 180);
    CHECK(share(bare, green) < 0.001);
    CHECK(bare != grown);
}

TEST_CASE("a material whose colour was lost shows light and shadow, in any unit of length") {
    Studio studio;
    studio.inputs.growth = {};
    auto lightness = [&](float scale, glm::vec4 color) {
        SurfaceData data = wall(4 * scale, 2.6f * scale);
        data.boundsMax.z = 2 * scale;
        for (DrawVertex& v : data.vertices) v.position.z *= scale;
        data.materials[0].baseColor = color;
        REQUIRE(studio.renderer->setSurface(0, data, glm::mat4(1)));
        studio.inputs.camera.eye = glm::vec3(0.8f, 1.2f, 3.6f) * scale;
        studio.inputs.camera.target = glm::vec3(0, 0.9f, 0) * scale;
        studio.inputs.camera.nearPlane = 0.05f * scale;
        const std::vector<uint8_t> picture = studio.draw(160, 90);
        const size_t middle = (size_t(45) * 160 + 80) * 4;
        return int(picture[middle]) + int(picture[middle + 1]) + int(picture[middle + 2]);
    };
    const int grey = lightness(1, {0.3f, 0.3f, 0.3f, 1});
    CHECK(lightness(1, {0, 0, 0, 1}) == doctest::Approx(grey).epsilon(0.2));
    CHECK(lightness(1, {1, 1, 1, 1}) == doctest::Approx(grey).epsilon(0.2));
    CHECK(lightness(1, {0.02f, 0.02f, 0.02f, 1}) < grey / 2);  // dark paint stays dark
    CHECK(lightness(0.004f, {0.3f, 0.3f, 0.3f, 1}) == doctest::Approx(grey).epsilon(0.05));
}

TEST_CASE("colours of vertices multiply the material's, and their alpha cuts holes and shadows") {
    Studio studio;
    studio.inputs.growth = {};
    SurfaceData data = wall(4, 2.6f);
    data.materials[0] = {};  // white, which alone would count as lost
    data.materials[0].coloured = true;
    for (DrawVertex& v : data.vertices)
        if (v.position.z == 0)
            v.colour = packColour(v.position.y > 1 ? glm::vec4(0.8f, 0, 0, 1) : glm::vec4(0, 0.8f, 0, 1));
    const auto picture = [&] {
        REQUIRE(studio.renderer->setSurface(0, data, glm::mat4(1)));
        return studio.draw(160, 90);
    };
    const auto at = [](const std::vector<uint8_t>& rgba, size_t x, size_t y) {
        return glm::ivec3(rgba[(y * 160 + x) * 4], rgba[(y * 160 + x) * 4 + 1], rgba[(y * 160 + x) * 4 + 2]);
    };
    const auto coloured = picture();
    const glm::ivec3 above = at(coloured, 80, 12), below = at(coloured, 80, 50);
    CHECK(above.r > above.g + 20);
    CHECK(below.g > below.r + 20);
    // From half its height on the wall is cut away: the sky is seen there, and light falls through.
    data.materials[0].alphaCutoff = 0.5f;
    for (DrawVertex& v : data.vertices) v.colour = packColour({0.5f, 0.5f, 0.5f, v.position.y > 1 ? 0.0f : 1.0f});
    const auto cut = picture();
    CHECK(at(cut, 80, 12).b > at(cut, 80, 12).r);
    CHECK(at(cut, 80, 12) != at(cut, 80, 50));
}

TEST_CASE("views without walk data fall back, and each differs from the shaded one") {
    Studio studio;
    const std::vector<uint8_t> shaded = studio.draw(160, 90);
    studio.inputs.look.view = ViewMode::lod;
    const std::vector<uint8_t> lod = studio.draw(160, 90);
    studio.inputs.look.view = ViewMode::normals;
    const std::vector<uint8_t> normals = studio.draw(160, 90);
    CHECK(lod != shaded);
    CHECK(normals != shaded);
    CHECK(normals != lod);
    studio.inputs.look.view = ViewMode::layer;  // no layers were given
    CHECK(studio.draw(160, 90) == normals);
}

// Drivers keep memory too: lavapipe compiled a kernel of ours for every view, and kept each.
TEST_CASE("frames of a moving camera leave no memory behind") {
    Studio studio;
    auto move = [&](int frames) {
        for (int i = 0; i < frames; ++i) {
            studio.inputs.camera.eye.x += 0.01f;
            studio.draw(160, 90);
        }
    };
    // As settled frames are, and as a window draws while something moves.
    for (bool quick : {false, true}) {
        CAPTURE(quick);
        studio.inputs.look.quick = quick;
        if (quick) studio.inputs.look.leafPixels *= 2, studio.inputs.look.lodPixels *= 4;
        move(8);
        // What is made once, when a frame first finds another's depths ready, may come late; a leak comes every time.
        double least = 1e30;
        for (int round = 0; round < 2 && least >= 1e6; ++round) {
            const size_t before = test::heapInUse();
            move(24);
            least = std::min(least, double(test::heapInUse()) - double(before));
        }
        CHECK(least < 1e6);
    }
}

TEST_CASE("what a moving picture hides by the depths of the one before, it doesn't show") {
    Studio moving, fresh;  // the latter knows no picture before
    const bool looksBack = moving.device->info().cpu;
    const glm::mat4 before = glm::translate(glm::mat4(1), glm::vec3(0, 0, 1));
    for (Studio* in : {&moving, &fresh}) {
        REQUIRE(in->renderer->setSurface(1, wall(1.2f, 1.6f), before));  // hides much of the ivy
        in->inputs.look.quick = true;
        in->inputs.camera = {.eye = {-0.8f, 1, 4}, .target = {0, 0.8f, 0}};
    }
    size_t different = 0, fewer = 0, pixels = 0;
    for (int frame = 0; frame < 12; ++frame) {
        CAPTURE(frame);
        for (Studio* in : {&moving, &fresh})
            if (frame > 1) in->inputs.camera.eye += glm::vec3(0.15f, 0.02f, frame < 6 ? -0.05f : 0.05f);
        fresh.renderer->forget();
        const std::vector<uint8_t> a = moving.draw(320, 180), b = fresh.draw(320, 180);
        for (size_t i = 0; i < a.size(); i += 4) different += std::abs(int(a[i + 1]) - int(b[i + 1])) > 8;
        pixels += a.size() / 4;
        if (frame > 0) fewer += moving.renderer->stats().emit.leaves * 10 < fresh.renderer->stats().emit.leaves * 9;
        if (frame == 1 && looksBack) CHECK(a == b);
    }
    CHECK(double(different) < 2e-4 * double(pixels));
    CHECK(fewer == (looksBack ? 11 : 0));
    // Leaves of few vertices and ribbons were lit before they were drawn.
    CHECK((moving.device->milliseconds("light") > 0) == looksBack);
}

TEST_CASE("a frame that was recorded and never submitted leaves no trace, once it is forgotten") {
    Studio fresh, studio;
    for (int round = 0; round < 2; ++round) {  // the first of all; another view of other growth
        CAPTURE(round);
        for (Studio* in : {&fresh, &studio}) {
            in->inputs.camera.eye.x += 0.1f;
            in->inputs.growth.leafCount -= 100;
            ++in->inputs.growth.revision;
        }
        {
            Result<Commands> dropped = Commands::begin(*studio.device, "dropped");
            REQUIRE(dropped);
            REQUIRE(studio.renderer->draw(*dropped, studio.inputs, {.width = 160, .height = 90}));
        }
        studio.renderer->forget();
        CHECK(studio.draw(160, 90) == fresh.draw(160, 90));
    }
}

TEST_CASE("awkward sizes") {
    Studio studio;
    for (glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(63, 65), glm::uvec2(2, 300), glm::uvec2(641, 3)})
        CHECK(studio.draw(size.x, size.y).size() == size_t(size.x) * size.y * 4);
}

TEST_CASE("into a host's image") {
    Studio studio;
    const std::vector<uint8_t> own = studio.draw(200, 120);
    ImageDesc desc;
    desc.name = "host";
    desc.width = 200;
    desc.height = 120;
    desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    Result<Image> image = Image::create(*studio.device, desc);
    REQUIRE(image);
    Result<Commands> commands = Commands::begin(*studio.device, "host frame");
    REQUIRE(commands);
    DrawTarget target{200, 120, image->handle(), image->view(), VK_FORMAT_R8G8B8A8_UNORM, {}};
    REQUIRE(studio.renderer->draw(*commands, studio.inputs, target));
    REQUIRE(commands->finish());
    image->state = ImageState::colorTarget;
    Result<std::vector<std::byte>> bytes = readImage(*studio.device, *image);
    REQUIRE(bytes);
    CHECK(std::equal(own.begin(), own.end(), reinterpret_cast<const uint8_t*>(bytes->data())));
}

TEST_CASE("thin twigs fade instead of breaking up") {
    Studio studio;
    studio.inputs.growth.leafCount = 0;
    studio.inputs.camera.eye = {0, 1, 14};
    studio.inputs.look.shadows = false;
    auto darkness = [&](float distance) {
        studio.inputs.camera.eye = {0, 1, distance};
        const std::vector<uint8_t> with = studio.draw(320, 180);
        const GrowthView growth = studio.inputs.growth;
        studio.inputs.growth = {};
        const std::vector<uint8_t> without = studio.draw(320, 180);
        studio.inputs.growth = growth;
        double sum = 0;
        for (size_t i = 0; i < with.size(); i += 4) sum += std::abs(int(with[i]) - int(without[i]));
        return sum * double(distance) * double(distance);  // per area of wall
    };
    const double near = darkness(7), far = darkness(14);
    CHECK(far == doctest::Approx(near).epsilon(0.35));
}

TEST_CASE("leaves that stand for others are as bright as all of them") {
    Studio studio;
    studio.inputs.look.shadows = false;
    const auto brightness = [&](uint32_t width, uint32_t height) {
        const std::vector<uint8_t> rgba = studio.draw(width, height);
        double sum = 0, count = 0;
        for (size_t i = 0; i < rgba.size(); i += 4)
            if (green(rgba[i], rgba[i + 1], rgba[i + 2])) sum += std::pow(rgba[i + 1] / 255.0, 2.2), ++count;
        REQUIRE(count > 100);
        return sum / count;
    };
    const double all = brightness(1280, 720), few = brightness(112, 63);
    CHECK(few > 0.95 * all);
    CHECK(few < 1.07 * all);
}

TEST_CASE("the ground reaches the horizon, lies behind what stands on it and takes its shadow") {
    Studio studio;
    studio.inputs.growth = {};
    studio.inputs.camera = {.eye = {0.8f, 0.9f, 3.6f}, .target = {0, 0.9f, 0}};
    const std::vector<uint8_t> bare = studio.draw(160, 90);
    studio.inputs.ground.kind = GroundKind::meadow;
    studio.inputs.ground.height = -0.3f;
    const std::vector<uint8_t> on = studio.draw(160, 90);
    auto same = [&](size_t x, size_t y) {
        const size_t at = (y * 160 + x) * 4;
        return std::equal(&bare[at], &bare[at] + 3, &on[at]);
    };
    CHECK(same(80, 45));  // the wall
    CHECK(same(3, 3));    // the sky
    CHECK(!same(3, 48));  // far below the level horizon's line
    CHECK(!same(3, 52));
    CHECK(!same(156, 52));
    // From behind, where the wall's shadow falls.
    studio.inputs.camera = {.eye = {0, 2.5f, -6}, .target = {0, 0, -1}};
    const std::vector<uint8_t> shaded = studio.draw(160, 90);
    studio.inputs.look.shadows = false;
    const std::vector<uint8_t> lit = studio.draw(160, 90);
    auto dark = [](int r, int g, int b) { return r + g + b < 200; };
    CHECK(share(shaded, dark) > share(lit, dark) + 0.03);
}

TEST_CASE("a studio's floor takes shadows and goes over into the horizon without an edge") {
    Studio studio;
    studio.inputs.growth = {};
    studio.inputs.ground.kind = GroundKind::studio;
    studio.inputs.camera = {.eye = {0, 2.5f, -6}, .target = {0, 1.5f, -1}};
    const std::vector<uint8_t> shaded = studio.draw(160, 90);
    const auto at = [&](size_t x, size_t y) { return &shaded[(y * 160 + x) * 4]; };
    for (size_t y = 1; y < 90; ++y)
        for (size_t c = 0; c < 3; ++c) CHECK(std::abs(int(at(2, y)[c]) - int(at(2, y - 1)[c])) < 8);
    // Its colours are those of the light.
    CHECK(std::abs(int(at(2, 85)[0]) - int(at(2, 85)[1])) < 24);
    studio.inputs.look.shadows = false;
    const std::vector<uint8_t> lit = studio.draw(160, 90);
    const auto sum = [](const std::vector<uint8_t>& picture) {
        return std::accumulate(picture.begin(), picture.end(), 0.0);
    };
    CHECK(sum(shaded) < 0.995 * sum(lit));
}

TEST_CASE("by night what is dark is grey, and what is lit keeps its colours") {
    Studio studio;
    const auto colourful = [&] {
        const std::vector<uint8_t> rgba = studio.draw(160, 90);
        return share(rgba, [](int r, int g, int b) { return g > 1.6 * r && g > 1.6 * b; });
    };
    const double day = colourful();
    studio.inputs.look.sunColor *= 0.12f;
    studio.inputs.look.skyColor *= 0.2f;
    studio.inputs.look.groundColor *= 0.2f;
    CHECK(day > 0.01);
    CHECK(colourful() < 0.25 * day);
}

TEST_CASE("a quick picture looks like the settled one, which comes back to the bit") {
    Studio studio;
    studio.inputs.ground.kind = GroundKind::meadow;
    const std::vector<uint8_t> settled = studio.draw(160, 90);
    studio.inputs.look.quick = true;
    const std::vector<uint8_t> quick = studio.draw(160, 90);
    double differ = 0;
    for (size_t i = 0; i < settled.size(); ++i) differ += std::abs(int(settled[i]) - int(quick[i]));
    CHECK(differ / double(settled.size()) < 3);
    CHECK((studio.device->info().cpu ? differ > 0 : differ == 0));
    studio.inputs.look.quick = false;
    CHECK(studio.draw(160, 90) == settled);
}

TEST_CASE("a quick picture has its twigs joined even where no leaf is left out") {
    Studio studio;
    studio.inputs.look.lodPixels = 4;
    studio.draw(160, 90);
    const uint64_t settled = studio.renderer->stats().emit.spans;
    studio.inputs.look.quick = true;
    studio.draw(160, 90);
    const RenderStats quick = studio.renderer->stats();
    if (studio.device->info().cpu)
        CHECK(quick.emit.spans * 2 < settled);
    else
        CHECK(quick.emit.spans == settled);
}

// A model that was turned over since its triangles were put in order is drawn by the program that knows the meadow.
TEST_CASE("triangles that the meadow can't reach are drawn without it, to the same picture") {
    SurfaceData data = wall(4, 0.5f);
    for (uint32_t i : {0u, 1u, 2u, 1u, 3u, 2u}) data.indices.push_back(uint32_t(data.vertices.size()) + i);
    for (size_t i = 0; i < 4; ++i) {
        data.vertices.push_back(data.vertices[i]);
        data.vertices.back().position.y += 0.5f;
    }
    data.boundsMax.y = 1;
    data.ranges[0].indexCount = uint32_t(data.indices.size());
    glm::mat4 lying(1);
    lying[1] = {0, 0, 1, 0};
    lying[2] = {0, -1, 0, 0};
    std::vector<uint8_t> bare, pictures[2];
    for (int turned : {0, 1}) {
        Studio studio;
        studio.inputs.growth = {};
        studio.inputs.ground.height = -0.03f;
        REQUIRE(studio.renderer->setSurface(0, data, turned ? lying : glm::mat4(1)));
        studio.renderer->placeSurface(0, glm::mat4(1));
        bare = studio.draw(160, 90);
        studio.inputs.ground.kind = GroundKind::meadow;
        pictures[turned] = studio.draw(160, 90);
    }
    const size_t floor = (80 * 160 + 76) * 4, upper = (50 * 160 + 76) * 4;
    CHECK(!std::equal(&bare[floor], &bare[floor] + 3, &pictures[0][floor]));
    CHECK(std::equal(&bare[upper], &bare[upper] + 3, &pictures[0][upper]));
    int most = 0;
    for (size_t i = 0; i < pictures[0].size(); ++i)
        most = std::max(most, std::abs(int(pictures[0][i]) - int(pictures[1][i])));
    CHECK(most <= 1);
}
