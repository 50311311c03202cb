// frame/place…: the sample game's whole place, with village, props and ivy, through the plugin's interface: one picture
// at its best, and the frames of a camera that goes once around, drawn as the window draws them then. What the window
// adds, its panels and the way to the screen, espalier-sample --turn tells.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>

#include "tools/bench/bench.hpp"
#include "tools/scene/moving.hpp"
#include "tools/scene/scene.hpp"

namespace espalier {
namespace {

constexpr uint32_t kWidth = 1280, kHeight = 720;
constexpr int kTurn = 180;     // frames
constexpr int kSettling = 24;  // ahead of them, in which the detail finds its level
constexpr int kSteps = 90;
constexpr float kStep = 0.1f;   // metres, as somebody walks
constexpr double kWhole = 1e3;  // ms: a picture that nothing moves in

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (double v : values) sum += v;
    return sum / double(values.size());
}
double most(const std::vector<double>& values) {
    return *std::max_element(values.begin(), values.end());
}

// The camera, `metres` to its right.
EspCamera aside(EspCamera camera, float metres) {
    const float x = camera.eye[2] - camera.target[2], z = camera.target[0] - camera.eye[0], far = std::hypot(x, z);
    for (float* point : {camera.eye, camera.target}) {
        point[0] += x / far * metres;
        point[2] += z / far * metres;
    }
    return camera;
}

struct Moves {
    std::vector<double> cpu, wall, leaves;  // of each frame; ms; empty: they can't be drawn
};

struct PlaceFilm {
    EspContext* context;
    const scene::Scene& scene;
    scene::MovingPicture picture{};
    EspStats stats{};

    struct Cost {
        double cpu = 0, wall = 0;  // ms; 0: it can't be drawn
    };

    Cost frame(const EspCamera& camera, bool moving) {
        EspDrawDef draw = espDefaultDrawDef();
        draw.camera = camera;
        draw.look = scene.look;
        draw.look.shadowsLag = 1;
        const float scale = picture.prepare(draw, moving, stats.drawMs, true);
        draw.width = uint32_t(kWidth * scale);
        draw.height = uint32_t(kHeight * scale);
        const std::clock_t before = std::clock();
        const auto began = std::chrono::steady_clock::now();
        if (espUpdate(context) != ESP_OK || espDraw(context, &draw) != ESP_OK ||
            espReadStats(context, &stats) != ESP_OK)
            return {};
        const Cost cost{double(std::clock() - before) * 1e3 / CLOCKS_PER_SEC,
                        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count()};
        picture.drew(cost.wall, uint32_t(stats.drawnLeaves));
        return cost;
    }

    // As many frames of a camera that moves, once levels of detail have settled.
    Moves move(int frames, const std::function<EspCamera(int)>& cameraAt) {
        Moves moves;
        for (int i = -kSettling; i < frames; ++i) {
            const Cost cost = frame(cameraAt(i), true);
            if (cost.wall == 0) return {};
            if (i < 0) continue;
            moves.cpu.push_back(cost.cpu);
            moves.wall.push_back(cost.wall);
            moves.leaves.push_back(double(stats.drawnLeaves));
        }
        return moves;
    }
};

}  // namespace

void placeCases(Bench& bench) {
    const char* name = "frame/place";
    if (!bench.wants(name) && !bench.wants("frame/place/wall") && !bench.wants("frame/place/still")) return;
    const EspContextDef def = espDefaultContextDef();
    EspContext* made = nullptr;
    if (espCreate(&def, &made) != ESP_OK) return bench.skip(name, espLastError(nullptr));
    const std::unique_ptr<EspContext, void (*)(EspContext*)> context(made, espDestroy);
    scene::Scene scene;
    scene::Request request;
    request.file = bench.options().contentFolder + "/sample.json";
    std::string error;
    if (!scene::openScene(made, request, scene, error) || !scene::plantAll(made, scene, error))
        return bench.skip(name, error);

    PlaceFilm film{made, scene};
    std::vector<double> still;
    for (int frame = -2; frame < bench.options().repeats; ++frame)
        if (const double took = film.frame(scene::turned(scene.camera, float(frame) * 1e-3f), false).wall; frame >= 0)
            still.push_back(took);
    const Moves turn =
        film.move(kTurn, [&](int frame) { return scene::turned(scene.camera, float(frame) * 6.2831853f / kTurn); });
    const Moves walk = film.move(kSteps, [&](int frame) { return aside(scene.camera, kStep * float(frame)); });
    if (turn.wall.empty() || walk.wall.empty()) return bench.skip(name, espLastError(made));
    constexpr double kFrame = scene::MovingDetail::kFrameMs;
    bench.add({"frame/place/still", "a whole picture by the clock", "ms", median(still), "a second", kWhole});
    bench.add({name, "CPU time of a moving frame of the whole place, half size, mean of a turn", "ms", mean(turn.cpu),
               "15 frames/s on two cores", 2 * kFrame});
    bench.add({"frame/place/wall",
               "the same by the clock, " + std::to_string(uint32_t(mean(turn.leaves))) + " leaves drawn in the mean",
               "ms", mean(turn.wall), "15 frames/s", kFrame});
    bench.add({"frame/place/worst", "the same, worst", "ms", most(turn.wall), "15 frames/s", kFrame});
    bench.add({"frame/place/walk", "by the clock, while it goes sideways, mean", "ms", mean(walk.wall), "15 frames/s",
               kFrame});
    bench.add(
        {"frame/place/walk/worst", "the same, worst: shadows follow", "ms", most(walk.wall), "15 frames/s", kFrame});
}

}  // namespace espalier
