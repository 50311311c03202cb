// frame/…: what a frame of the sample's court costs, with half a million nodes of ivy: standing; while the camera goes
// round, shadows kept, drawn at half the window's size and as coarsely as MovingDetail says, as the window does where
// no larger picture is in time; and with a dab of the brush in each frame, shadows following a few tiles at a time. CPU
// time, which on a software device is all of it and which other programs disturb less than the clock, beside what a
// frame may cost on two cores; stages by the device's clock. What moves also by the clock on the wall.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>
#include <utility>

#include "runtime/render/renderer.hpp"
#include "shaders/shared/exact.h"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"
#include "tools/scene/moving.hpp"

namespace espalier {
namespace {

constexpr uint32_t kNodes = 500'000;
constexpr uint32_t kMaskTexels = 1024;                     // of the mask
constexpr int kPaintedFrames = 64;                         // in which growth has to close its gaps
constexpr double kMoving = 2e3 / 15, kPainting = 2e3 / 8;  // CPU ms of a frame on two cores: 15 and 8 frames/s
constexpr double kRecording = 0.1;                         // ms of the thread for an unchanged frame in a host's pass
constexpr int kRounds = 5;                                 // of frames by the clock, which others disturb
constexpr int kSettling = 24;                              // frames ahead of each, in which the detail finds its level
constexpr DrawTarget kFull{.width = 1280, .height = 720}, kHalf{.width = 640, .height = 360};

struct FrameTimes {
    double median = 0, mean = 0, worst = 0;  // CPU ms
    double wall = 0;                         // ms by the clock, mean
};

struct FrameClock {
    double overlapped = 0, waited = 0;  // ms from a frame to the next
    uint32_t leaves = 0;                // in view, when each was waited for
};

Camera turned(Camera camera, float degrees) {
    const float a = degrees * 0.0174533f;
    const glm::vec3 d = camera.eye - camera.target;
    camera.eye =
        camera.target + glm::vec3(std::cos(a) * d.x + std::sin(a) * d.z, d.y, std::cos(a) * d.z - std::sin(a) * d.x);
    return camera;
}

struct Film {
    Device& device;
    Renderer& renderer;
    DrawInputs inputs;
    int repeats;
    scene::MovingDetail detail{};
    bool coarse = false;  // as `detail` says, which follows the frames' time

    // Milliseconds of CPU time a frame, the camera turned by `degrees` for each, once levels of detail have settled;
    // with `edit` done in each frame, over kPaintedFrames. 0: it can't be drawn.
    FrameTimes cost(const DrawTarget& target, float degrees, const std::function<void(int)>& edit = {}) {
        const Camera start = inputs.camera;
        const Look look = inputs.look;
        std::vector<double> times;
        double wall = 0;
        for (int frame = -9; frame < (edit ? kPaintedFrames : repeats); ++frame) {
            inputs.camera = turned(start, degrees * float(frame));
            if (coarse) hurry();
            const std::clock_t before = std::clock();
            const auto began = std::chrono::steady_clock::now();
            if (edit) edit(frame);
            Result<uint64_t> sent = send(target);
            if (!sent || !device.wait(*sent)) return {};
            const double cost = double(std::clock() - before) * 1e3 / CLOCKS_PER_SEC;
            if (coarse) detail.follow(cost / 2, renderer.stats().emit.leaves);
            if (frame < 0) continue;
            times.push_back(cost);
            wall += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
        }
        inputs.camera = start;
        inputs.look = look;
        device.collect();
        double sum = 0;
        for (double t : times) sum += t;
        const double count = double(times.size());
        return {median(times), sum / count, *std::max_element(times.begin(), times.end()), wall / count};
    }

    // The same by the clock, in rounds by turns: each frame waited for, as coarse as a window makes it by the time that
    // it takes; or one recorded while the last is drawn, as coarse as those were.
    FrameClock clock(const DrawTarget& target, float degrees) {
        using Clock = std::chrono::steady_clock;
        const Camera start = inputs.camera;
        const Look look = inputs.look;
        std::vector<double> overlapped, waited, leaves;
        for (int round = 0; round < 2 * kRounds; ++round) {
            const bool overlaps = round % 2 == 1;
            uint64_t last = device.submitted();
            Clock::time_point begin, before = Clock::now();
            for (int frame = -kSettling; frame < repeats; ++frame) {
                if (frame == 0) begin = Clock::now();
                inputs.camera = turned(start, degrees * float(frame));
                hurry();
                Result<uint64_t> sent = send(target);
                if (!sent || !device.wait(overlaps ? last : *sent)) return {};
                last = *sent;
                const Clock::time_point now = Clock::now();
                const double took = std::chrono::duration<double, std::milli>(now - before).count();
                before = now;
                if (overlaps) continue;
                const uint32_t drawn = renderer.stats().emit.leaves;
                detail.follow(took, drawn);
                if (frame >= 0) leaves.push_back(drawn);
            }
            const double took = std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
            (overlaps ? overlapped : waited).push_back(took / repeats);
            if (!device.wait(last)) return {};
        }
        inputs.camera = start;
        inputs.look = look;
        return {median(overlapped), median(waited), uint32_t(median(leaves))};
    }

    // Milliseconds of the recording thread's CPU time for an unchanged frame within a pass, median of 100; 0: it can't
    // be drawn.
    double recording(VkExtent2D size) {
        Image colour, depth;
        ImageDesc desc{.name = "pass", .width = size.width, .height = size.height, .samples = 4};
        desc.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        if (!assign(colour, Image::create(device, desc))) return 0;
        desc.format = kDepthFormat;
        desc.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        if (!assign(depth, Image::create(device, desc))) return 0;
        PassView pass;
        pass.format = {.colors = {colour.format()},
                       .depth = kDepthFormat,
                       .samples = 4,
                       .reversed = false,
                       .output = kOutputEncoded};
        pass.viewport = {0, 0, float(size.width), float(size.height), 0, 1};
        const Camera& camera = inputs.camera;
        pass.view = glm::lookAtRH(camera.eye, camera.target, camera.up);
        pass.projection = glm::perspectiveRH_ZO(camera.fovY, float(size.width) / float(size.height), 0.1f, 1000.0f);
        pass.projection[1][1] *= -1;
        std::vector<double> times;
        for (int frame = -3; frame < 100; ++frame) {
            Result<Commands> commands = Commands::begin(device, "frame");
            if (!commands) return 0;
            commands->transition(colour, ImageState::colorTarget, true);
            commands->transition(depth, ImageState::depthTarget, true);
            double cost = threadMilliseconds();
            if (!renderer.prepare(*commands, inputs, pass)) return 0;
            cost = threadMilliseconds() - cost;
            {
                DrawTargets targets;
                targets.extent = size;
                targets.colors.push_back({.view = colour.view(), .clear = std::array<float, 4>{0, 0, 0, 1}});
                targets.depth = DepthTarget{.view = depth.view(), .clear = 1.0f};
                DrawPass drawn(*commands, "pass", targets);
                const double begun = threadMilliseconds();
                renderer.record(*commands);
                cost += threadMilliseconds() - begun;
            }
            // One is drawn, the others are dropped: only recording is measured.
            if (frame == -3 && !commands->finish()) return 0;
            if (frame >= 0) times.push_back(cost);
        }
        return median(times);
    }

  private:
    static double threadMilliseconds() {
        timespec now{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
        return double(now.tv_sec) * 1e3 + double(now.tv_nsec) * 1e-6;
    }
    void hurry() {
        inputs.look.lodPixels = scene::MovingDetail::kLod;
        inputs.look.leafPixels = Look{}.leafPixels * detail.leaf();
        inputs.look.quick = true;
    }
    // One frame; the timeline's value when it is done.
    Result<uint64_t> send(const DrawTarget& target) {
        Result<Commands> commands = Commands::begin(device, "frame");
        if (!commands) return commands.failure();
        if (Status s = renderer.draw(*commands, inputs, target); !s) return s.failure();
        return commands->submit();
    }
};

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

// A dab of a quarter of a metre or so, each at another node, the mask now higher, now as it was.
class FramePainter {
  public:
    FramePainter(BenchScene& scene, Growth& growth, Film& film) : scene_(scene), growth_(growth), film_(film) {
        Result<GrowthRecords> records = growth.read();
        if (!records) return;
        std::vector<uint32_t> places;  // in an order that all runs have
        for (const Node& node : records->nodes) places.push_back(node.uv);
        std::sort(places.begin(), places.end());
        for (size_t i = 0; i < 64; ++i)
            places_.push_back(unpackUv(places[i * 777'777'777 % places.size()]) * float(kMaskTexels));
    }
    void dab(int frame) {
        constexpr float kReach = 12;
        const glm::vec2 at = places_[size_t(frame + 10) / 2 % places_.size()];
        const glm::ivec2 low = glm::clamp(glm::ivec2(at - kReach), 0, int(kMaskTexels)),
                         high = glm::clamp(glm::ivec2(at + kReach) + 1, 0, int(kMaskTexels));
        GrowthChanges changes;
        changes.everything = false;
        for (uint32_t y = uint32_t(low.y); y < uint32_t(high.y); ++y)
            for (uint32_t x = uint32_t(low.x); x < uint32_t(high.x); ++x) {
                if (glm::distance(glm::vec2(x, y) + 0.5f, at) >= kReach) continue;
                texels_[texelIndex(kMaskTexels, x, y)] = frame & 1 ? 0.5f : 0.62f;
                changes.markTexels(0, 0, kMaskTexels, x, y, x + 1, y + 1);
            }
        scene_.changes = &changes;
        (void)scene_.paint(0, kMaskTexels, texels_);
        (void)scene_.grow(growth_);
        scene_.changes = nullptr;
        film_.inputs.growth = growth_.view();
    }

  private:
    BenchScene& scene_;
    Growth& growth_;
    Film& film_;
    std::vector<float> texels_ = std::vector<float>(size_t(kMaskTexels) * kMaskTexels, 0.5f);
    std::vector<glm::vec2> places_;
};

}  // namespace

void frameCases(Bench& bench) {
    const char* name = "frame/sample";
    if (!bench.wants(name) && !bench.wants("frame/moving") && !bench.wants("frame/painting") &&
        !bench.wants("frame/record"))
        return;
    const std::string& content = bench.options().contentFolder;
    Result<std::unique_ptr<Device>> device = Device::create();
    if (!device) return bench.skip(name, device.failure().text());
    auto scene = BenchScene::create(**device, content + "/ruin.glb", 1024);
    Result<std::unique_ptr<Growth>> growth = Growth::create(**device);
    Result<std::unique_ptr<Renderer>> renderer = Renderer::create(**device, content + "/terminals.glb");
    if (!scene || !growth) return bench.skip(name, "needs " + content);
    if (!renderer) return bench.skip(name, renderer.failure().text());
    const std::vector<float> grey(size_t(kMaskTexels) * kMaskTexels, 0.5f);  // the mask as the scene has it
    if (!scene->setGrammar(textOf(content + "/grammars/ivy_free.grammar")) || !scene->paint(0, kMaskTexels, grey) ||
        !growEnough(*scene, **growth))
        return bench.skip(name, "the ivy doesn't grow");
    if (Status s = (*renderer)->setSurface(0, scene->surface(), glm::mat4(1)); !s)
        return bench.skip(name, s.failure().text());

    Film film{**device, **renderer, {}, bench.options().repeats};
    film.inputs.camera = {.eye = {4.6f, 1.75f, 10.3f}, .target = {-0.1f, 1.5f, 1.3f}, .fovY = 0.663f};
    film.inputs.ground.kind = GroundKind::meadow;
    film.inputs.ground.height = -0.06f;
    const double bare = film.cost(kFull, 0).median;
    film.coarse = true;
    const double bareHalf = film.cost(kHalf, 2).median;
    film.coarse = false;
    film.inputs.growth = (*growth)->view();
    film.inputs.surfaces = scene->surfaces();
    const double still = film.cost(kFull, 0).median;
    const RenderStats stats = (*renderer)->stats();
    const double recording = film.recording({kFull.width, kFull.height});
    film.coarse = true;
    const double moving = film.cost(kFull, 2).median;
    std::vector<std::pair<std::string, double>> stages;
    for (const char* stage : {"emit", "draw scene", "draw occlusion", "draw resolve"})
        stages.emplace_back(stage, (*device)->milliseconds(stage));
    const double whole = (*device)->milliseconds("draw");
    const double movingHalf = film.cost(kHalf, 2).median;
    const uint32_t drawn = (*renderer)->stats().emit.leaves;
    const FrameClock wall = film.clock(kHalf, 2);
    FramePainter painter(*scene, **growth, film);
    film.inputs.look.shadowsLag = true;  // as in the window
    const FrameTimes painting = film.cost(kHalf, 0, [&](int frame) { painter.dab(frame); });
    std::printf("%u nodes, %u leaves grown; %u spans and %u leaves in view, %.2f million triangles of them\n",
                film.inputs.growth.nodeCount, film.inputs.growth.leafCount, stats.emit.spans, stats.emit.leaves,
                double(stats.emit.drawnTriangles) * 1e-6);
    bench.add({name, "CPU time of a frame, nothing moves", "ms", still, "the same without ivy", bare});
    bench.add({"frame/record", "an unchanged frame recorded into a host's pass, CPU time of the thread, median of 100",
               "ms", recording, "bound", kRecording});
    const std::string seen = std::to_string(drawn) + " leaves drawn";
    bench.add({"frame/moving/bare", "CPU time of a frame without ivy, half size", "ms", bareHalf,
               "15 frames/s on two cores", kMoving});
    bench.add({"frame/moving", "CPU time of a frame, half size, " + seen, "ms", movingHalf, "15 frames/s on two cores",
               kMoving});
    bench.add({"frame/moving/wall", "a frame by the clock, half size, " + std::to_string(wall.leaves) + " leaves drawn",
               "ms", wall.waited, "15 frames/s", kMoving / 2});
    bench.add({"frame/moving/overlap", "the same, each waited for", "ms", wall.waited,
               "each recorded while the last is drawn", wall.overlapped});
    bench.add(
        {"frame/moving/full", "CPU time of a frame, full size", "ms", moving, "15 frames/s on two cores", kMoving});
    for (const auto& [stage, ms] : stages)
        bench.add({"frame/moving/full/" + stage, "time of the stage", "ms", ms, "the whole frame", whole});
    bench.add({"frame/painting",
               "CPU time of a dab and its frame, half size, mean of " + std::to_string(kPaintedFrames), "ms",
               painting.mean, "8 frames/s on two cores", kPainting});
    bench.add(
        {"frame/painting/median", "the same, median", "ms", painting.median, "8 frames/s on two cores", kPainting});
    bench.add({"frame/painting/worst", "the same, worst", "ms", painting.worst, "8 frames/s on two cores", kPainting});
    bench.add({"frame/painting/wall", "a dab and its frame by the clock, mean", "ms", painting.wall, "8 frames/s",
               kPainting / 2});
}

}  // namespace espalier
