// frame/…: what a frame of the sample's court costs, with half a million nodes of ivy: standing, and while the camera
// goes round, as large as a window draws it then. CPU time, which on a software device is all of it and which other
// programs don't change; stages by the device's clock.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>

#include "runtime/render/renderer.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"

namespace espalier {
namespace {

constexpr uint32_t kNodes = 500'000;
constexpr DrawTarget kFull{.width = 1280, .height = 720}, kHalf{.width = 640, .height = 360};

struct Film {
    Device& device;
    Renderer& renderer;
    DrawInputs inputs;
    int repeats;

    // Milliseconds of CPU time a frame, the camera turned by `degrees` for each; the median. 0: it can't be drawn.
    double cost(const DrawTarget& target, float degrees) {
        const Camera start = inputs.camera;
        std::vector<double> times;
        for (int frame = -1; frame < repeats; ++frame) {
            const float a = degrees * float(frame) * 0.0174533f;
            const glm::vec3 d = start.eye - start.target;
            inputs.camera.eye = start.target + glm::vec3(std::cos(a) * d.x + std::sin(a) * d.z, d.y,
                                                         std::cos(a) * d.z - std::sin(a) * d.x);
            const std::clock_t before = std::clock();
            Result<Commands> commands = Commands::begin(device, "frame");
            if (!commands || !renderer.draw(*commands, inputs, target) || !commands->finish()) return 0;
            if (frame >= 0) times.push_back(double(std::clock() - before) * 1e3 / CLOCKS_PER_SEC);
        }
        inputs.camera = start;
        device.collect();
        return median(times);
    }
};

std::string textOf(const std::string& path) {
    std::ifstream file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

// As many seeds as it takes.
bool growEnough(BenchScene& scene, Growth& growth) {
    uint32_t seeds = 40;
    for (int attempt = 0; attempt < 4; ++attempt) {
        scene.plant(seeds);
        if (!scene.grow(growth)) return false;
        const uint32_t nodes = growth.view().nodeCount;
        if (nodes >= kNodes) return true;
        seeds = uint32_t(1.1 * seeds * kNodes / std::max(nodes, 1u)) + 1;
    }
    return false;
}

}  // namespace

void frameCases(Bench& bench) {
    const char* name = "frame/sample";
    if (!bench.wants(name) && !bench.wants("frame/sample-moving")) return;
    const std::string& content = bench.options().contentFolder;
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    auto scene = BenchScene::create(**device, content + "/ruin.glb", 1024);
    Result<std::unique_ptr<Growth>> growth = Growth::create(**device);
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(**device, content + "/terminals.glb");
    if (!scene || !growth || !renderer) return bench.skip(name, "needs " + content);
    const std::vector<float> grey(64 * 64, 0.5f);  // the mask as the scene has it
    if (!scene->setGrammar(textOf(content + "/grammars/ivy_free.grammar")) || !scene->paint(0, 64, grey) ||
        !growEnough(*scene, **growth))
        return bench.skip(name, "the ivy doesn't grow");
    if (Status s = (*renderer)->setSurface(0, scene->surface(), glm::mat4(1)); !s)
        return bench.skip(name, s.failure().text());

    Film film{**device, **renderer, {}, bench.options().repeats};
    film.inputs.camera = {.eye = {4.6f, 1.75f, 10.3f}, .target = {-0.1f, 1.5f, 1.3f}, .fovY = 0.663f};
    film.inputs.ground.drawn = true;
    film.inputs.ground.height = -0.06f;
    const double bare = film.cost(kFull, 0);
    film.inputs.growth = (*growth)->view();
    film.inputs.surfaces = scene->surfaces();
    const double still = film.cost(kFull, 0);
    const RenderStats stats = (*renderer)->stats();
    const double moving = film.cost(kFull, 2), movingHalf = film.cost(kHalf, 2);
    std::printf("%u nodes, %u leaves grown; %u spans and %u leaves in view, %.2f million triangles of them\n",
                film.inputs.growth.nodeCount, film.inputs.growth.leafCount, stats.emit.spans, stats.emit.leaves,
                double(stats.emit.drawnTriangles) * 1e-6);
    bench.add({name, "CPU time of a frame", "ms", still, "the same without ivy", bare});
    for (const char* stage : {"emit", "draw scene", "draw occlusion", "draw resolve"})
        bench.add({std::string(name) + "/" + stage, "time of the stage", "ms", (*device)->milliseconds(stage),
                   "the whole frame", (*device)->milliseconds("draw")});
    bench.add({"frame/sample-moving", "CPU time of a frame, half size", "ms", movingHalf, "full size", moving});
}

}  // namespace espalier
