// Pictures of ivy made on the CPU, judged by their statistics. With ESPALIER_PICTURES=DIR they are written there.
#include <doctest/doctest.h>
#include <cstdlib>
#include <ctime>
#include <iostream>

#include "runtime/render/renderer.hpp"
#include "tests/emit/fixture.hpp"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

using namespace espalier;

namespace {

void save(const std::string& name, const std::vector<uint8_t>& rgba, uint32_t width, uint32_t height) {
    if (const char* folder = std::getenv("ESPALIER_PICTURES"))
        stbi_write_png((std::string(folder) + "/" + name + ".png").c_str(), int(width), int(height), 4, rgba.data(),
                       int(width * 4));
}

// A wall z = 0 and the ground y = 0.
SurfaceData wall(float width, float height) {
    SurfaceData data;
    auto quad = [&](glm::vec3 origin, glm::vec3 u, glm::vec3 v) {
        const uint32_t first = uint32_t(data.vertices.size());
        const glm::vec3 n = glm::normalize(glm::cross(u, v));
        for (int i = 0; i < 4; ++i) {
            const glm::vec2 at(i & 1, i >> 1);
            data.vertices.push_back({origin + u * at.x + v * at.y, n, glm::vec4(glm::normalize(u), 1), at, at});
        }
        for (uint32_t i : {0u, 1u, 2u, 1u, 3u, 2u}) data.indices.push_back(first + i);
    };
    quad({-width / 2, 0, 0}, {width, 0, 0}, {0, height, 0});
    quad({-width / 2, 0, 2}, {width, 0, 0}, {0, 0, -2});
    data.boundsMin = {-width / 2, 0, 0};
    data.boundsMax = {width / 2, height, 2};
    data.materials.resize(1);
    data.materials[0].baseColor = {0.55f, 0.5f, 0.44f, 1};
    data.ranges.push_back({0, uint32_t(data.indices.size()), 0});
    return data;
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
        save(shot.name, *pixels, target.width, target.height);
    }
    for (const std::string& text : (*device)->validationTexts()) MESSAGE(text);
    CHECK((*device)->validationMessages() == 0);
}
