// frame/place…: the sample game's whole place, with village, props and ivy, through the plugin's interface: one picture
// at its best, and the frames of a camera that goes once around, drawn as the window draws them then. frame/dense…: the
// same place with half a million nodes of ivy, also with a brush that paints in each frame, as small as it takes, and
// at larger sizes up to the whole one. frame/device…: the stages of that place by the device's clock.
// What the window adds, its panels and the way to the screen, espalier-sample --turn tells.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "plugin_api/espalier.hpp"
#include "tools/bench/bench.hpp"
#include "tools/scene/moving.hpp"
#include "tools/scene/scene.hpp"

namespace espalier {
namespace {

constexpr uint32_t kWidth = 1280, kHeight = 720;
constexpr uint64_t kNodes = 500'000;
constexpr int kTurn = 180;     // frames
constexpr int kSettling = 60;  // ahead of them, in which detail and size find their level
constexpr int kSteps = 90;
constexpr float kStep = 0.1f;               // metres, as somebody walks
constexpr int kStrokes = 8, kDabs = 8;      // a dab a frame
constexpr double kWhole = 1e3;              // ms: a picture that nothing moves in
constexpr float kLayerOpacity = 0.75f;      // as the editor shows layers at first
constexpr double kPaintingFrame = 1e3 / 8;  // ms
constexpr double kFrame = scene::MovingDetail::kFrameMs;
constexpr double kSmooth = 1e3 / 60;  // ms, on a GPU

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
    std::vector<double> cpu, wall, update, leaves, share;  // of each frame; ms; empty: they can't be drawn
    std::string leavesDrawn() const {
        const double least = *std::min_element(leaves.begin(), leaves.end());
        return std::to_string(uint32_t(mean(leaves))) + " leaves drawn in the mean; at least " +
               std::to_string(uint32_t(least));
    }
    std::string size() const { return std::to_string(std::lround(100 * mean(share))) + " % of its width"; }
};

struct PlaceFilm {
    EspContext* context;
    const scene::Scene& scene;
    // Of the window's width that what moves is drawn with, at the detail of the smallest; none: as small as it takes.
    std::optional<float> fixed = {};
    const char* layer = nullptr;  // shown over the surfaces, as while the brush is in hand; null: the shaded view
    scene::MovingPicture picture{};
    EspStats stats{};
    float share = 1;  // of the window's width, as the last frame was drawn
    using Clock = std::chrono::steady_clock;

    struct Cost {
        double cpu = 0, wall = 0, update = 0;  // ms, update: of the wall's, by growth; wall 0: it can't be drawn
    };

    // `edit`: what is done to the scene in it.
    Cost frame(const EspCamera& camera, bool moving, const std::function<bool()>& edit = {}) {
        esp::DrawDef draw;
        draw.camera = camera;
        draw.look = scene.look;
        draw.look.shadowsLag = 1;
        if (layer) {
            draw.look.view = ESP_VIEW_LAYER;
            draw.look.viewLayer = layer;
            draw.look.viewOpacity = kLayerOpacity;
        }
        share = picture.prepare(draw.look, moving, stats.drawMs, !fixed);
        if (draw.look.quick && fixed) {
            share = *fixed;
            draw.look.lodPixels *= share / scene::MovingDetail::kShare;
            draw.look.leafPixels *= share / scene::MovingDetail::kShare;
        }
        draw.width = uint32_t(kWidth * share);
        draw.height = uint32_t(kHeight * share);
        const std::clock_t before = std::clock();
        const auto began = Clock::now();
        const auto since = [](Clock::time_point then) {
            return std::chrono::duration<double, std::milli>(Clock::now() - then).count();
        };
        if (edit && !edit()) return {};
        const auto edited = Clock::now();
        if (espUpdate(context) != ESP_OK) return {};
        const double update = since(edited);
        if (espDraw(context, &draw) != ESP_OK || espReadStats(context, &stats) != ESP_OK) return {};
        const Cost cost{double(std::clock() - before) * 1e3 / CLOCKS_PER_SEC, since(began), update};
        picture.drew(cost.wall, uint32_t(stats.drawnLeaves), bool(edit));
        return cost;
    }

    // As many frames, once levels of detail have settled.
    Moves move(int frames, const std::function<EspCamera(int)>& cameraAt, const std::function<bool(int)>& edit = {}) {
        Moves moves;
        for (int i = -kSettling; i < frames; ++i) {
            const Cost cost =
                edit ? frame(cameraAt(i), true, [&] { return i < 0 || edit(i); }) : frame(cameraAt(i), true);
            if (cost.wall == 0) return {};
            if (i < 0) continue;
            moves.cpu.push_back(cost.cpu);
            moves.wall.push_back(cost.wall);
            moves.update.push_back(cost.update);
            moves.leaves.push_back(double(stats.drawnLeaves));
            moves.share.push_back(double(share));
        }
        return moves;
    }
    Moves turn() {
        return move(kTurn, [&](int frame) { return scene::turned(scene.camera, float(frame) * 6.2831853f / kTurn); });
    }
    Moves walk() {
        return move(kSteps, [&](int frame) { return aside(scene.camera, kStep * float(frame)); });
    }
    Moves stand(int frames, const std::function<bool(int)>& edit) {
        return move(
            frames, [&](int) { return scene.camera; }, edit);
    }
};

// Strokes on what the camera sees, a dab at a time, that take ivy away and bring it by turns.
class Hand {
  public:
    Hand(EspContext* context, const EspCamera& camera) : context_(context), camera_(camera) {}

    bool dab(int frame) {
        if (frame % kDabs == 0 && !begin(frame / kDabs)) return false;
        from_[0] += 0.12f;  // metres, to the right
        EspHit hit;
        const float way[3] = {from_[0] - camera_.eye[0], from_[1] - camera_.eye[1], from_[2] - camera_.eye[2]};
        if (espPick(context_, camera_.eye, way, &hit) == ESP_OK) {
            const EspDab dab{
                {hit.position[0], hit.position[1], hit.position[2]}, {hit.normal[0], hit.normal[1], hit.normal[2]}, 1};
            if (espStrokeDabs(context_, stroke_, &dab, 1) != ESP_OK) return false;
        }
        return frame % kDabs != kDabs - 1 || espEndStroke(context_, stroke_) == ESP_OK;
    }

  private:
    bool begin(int stroke) {
        EspBrush brush = esp::defaults<EspBrush>();
        brush.layer = "mask";
        brush.radius = 0.25f;
        brush.strength = 1;
        brush.value = stroke % 2 ? 0.62f : 0;
        const int pair = stroke / 2;  // the second goes where the first did
        from_[0] = -2.2f + 1.1f * float(pair);
        from_[1] = 0.8f + 0.5f * float(pair % 3);
        from_[2] = 0.36f;  // the wall
        return espBeginStroke(context_, &brush, &stroke_) == ESP_OK;
    }

    EspContext* context_;
    EspCamera camera_;
    EspStroke stroke_{};
    float from_[3]{};
};

// Plants the scene's seeds again and again, with other numbers, until so many nodes have grown.
bool thicken(EspContext* context, scene::Scene& scene, EspStats& stats) {
    const std::vector<scene::Seed> seeds = scene.seeds;
    const size_t most = 16 * seeds.size();
    for (size_t i = 0; i < most; ++i) {
        if (espUpdate(context) != ESP_OK || espReadStats(context, &stats) != ESP_OK) return false;
        if (stats.nodes >= kNodes) return true;
        const scene::Seed& seed = seeds[i % seeds.size()];
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = scene.grammars[seed.grammar].id;
        std::copy(seed.position.begin(), seed.position.end(), def.position);
        std::copy(seed.direction.begin(), seed.direction.end(), def.direction);
        def.number = seed.number + 1000 * uint32_t(1 + i / seeds.size());
        EspSeed planted;
        if (espPlant(context, &def, &planted) != ESP_OK) return false;
    }
    return false;
}

void sampleCases(Bench& bench, EspContext* context, const scene::Scene& scene) {
    const char* name = "frame/place";
    PlaceFilm film{context, scene};
    std::vector<double> still;
    for (int frame = -2; frame < bench.options().repeats; ++frame)
        if (const double took = film.frame(scene::turned(scene.camera, float(frame) * 1e-3f), false).wall; frame >= 0)
            still.push_back(took);
    const Moves turn = film.turn(), walk = film.walk();
    if (turn.wall.empty() || walk.wall.empty()) return bench.skip(name, espLastError(context));
    PlaceFilm over{context, scene};
    over.layer = "mask";
    Hand bare(context, scene.camera), showing(context, scene.camera);
    const Moves painting = film.stand(kStrokes * kDabs, [&](int frame) { return bare.dab(frame); });
    const Moves shown = over.stand(kStrokes * kDabs, [&](int frame) { return showing.dab(frame); });
    if (painting.wall.empty() || shown.wall.empty()) return bench.skip(name, espLastError(context));
    bench.add({"frame/place/still", "a whole picture by the clock", "ms", median(still), "a second", kWhole});
    bench.add({name, "CPU time of a moving frame of the whole place, " + turn.size() + ", mean of a turn", "ms",
               mean(turn.cpu), "15 frames/s on two cores", 2 * kFrame});
    bench.add({"frame/place/wall", "the same by the clock, " + turn.leavesDrawn(), "ms", mean(turn.wall), "15 frames/s",
               kFrame});
    bench.add({"frame/place/worst", "the same, worst", "ms", most(turn.wall), "15 frames/s", kFrame});
    bench.add({"frame/place/walk", "by the clock, while it goes sideways, mean", "ms", mean(walk.wall), "15 frames/s",
               kFrame});
    bench.add({"frame/place/painting", "a dab and its frame by the clock, " + painting.size() + ", mean", "ms",
               mean(painting.wall), "8 frames/s", kPaintingFrame});
    bench.add({"frame/place/painting/layer", "the same with the layer shown, " + shown.size() + ", mean", "ms",
               mean(shown.wall), "8 frames/s", kPaintingFrame});
    bench.add(
        {"frame/place/walk/worst", "the same, worst: shadows follow", "ms", most(walk.wall), "15 frames/s", kFrame});
}

void denseCases(Bench& bench, EspContext* context, scene::Scene& scene) {
    const char* name = "frame/dense";
    EspStats stats;
    if (!thicken(context, scene, stats)) return bench.skip(name, "the ivy doesn't grow as dense as that");
    PlaceFilm film{context, scene};
    const Moves turn = film.turn();
    Hand hand(context, scene.camera);
    const Moves painting = film.stand(kStrokes * kDabs, [&](int frame) { return hand.dab(frame); });
    if (turn.wall.empty() || painting.wall.empty()) return bench.skip(name, espLastError(context));
    bench.add({name,
               "by the clock, a moving frame of the place with " + std::to_string(stats.nodes) + " nodes, " +
                   turn.size() + ", " + turn.leavesDrawn() + " of a turn",
               "ms", mean(turn.wall), "15 frames/s", kFrame});
    bench.add({"frame/dense/cpu", "CPU time of it", "ms", mean(turn.cpu), "15 frames/s on two cores", 2 * kFrame});
    bench.add({"frame/dense/worst", "by the clock, worst", "ms", most(turn.wall), "15 frames/s", kFrame});
    const Moves finer = PlaceFilm{context, scene, scene::MovingDetail::kShare}.turn();
    if (finer.wall.empty()) return bench.skip("frame/dense/coarser", espLastError(context));
    bench.add({"frame/dense/coarser", "by the clock, as coarse as its time asks for", "ms", mean(turn.wall),
               "at the detail that all moving pictures have", mean(finer.wall)});
    for (const auto& [row, share] :
         {std::pair("frame/dense/0.6", .6f), {"frame/dense/0.75", .75f}, {"frame/dense/whole", 1.f}}) {
        const Moves larger = PlaceFilm{context, scene, share}.turn();
        if (larger.wall.empty()) return bench.skip(row, espLastError(context));
        bench.add({row, "the same, mean, " + larger.size() + ", " + larger.leavesDrawn(), "ms", mean(larger.wall),
                   "15 frames/s", kFrame});
    }
    bench.add({"frame/dense/painting",
               "a dab and its frame by the clock, " + painting.size() + ", " + painting.leavesDrawn(), "ms",
               mean(painting.wall), "8 frames/s", kPaintingFrame});
    bench.add(
        {"frame/dense/painting/worst", "the same, worst", "ms", most(painting.wall), "8 frames/s", kPaintingFrame});
    bench.add({"frame/dense/painting/growth", "of it growing what a dab concerns, worst", "ms", most(painting.update),
               "8 frames/s", kPaintingFrame});
}

// Growth by shaders, culling and drawing at best by the device's time stamps; on a software device those of stages that
// others overlap say little.
void deviceCases(Bench& bench, EspContext* context, scene::Scene& scene) {
    EspStats stats;
    if (!thicken(context, scene, stats)) return bench.skip("frame/device", "the ivy doesn't grow as dense as that");
    PlaceFilm film{context, scene};
    Hand hand(context, scene.camera);
    std::vector<double> whole, dabs, culls, draws;
    const auto grows = [&](EspGrowDef def, std::vector<double>& times) {
        if (espSetGrow(context, &def) != ESP_OK || espUpdate(context) != ESP_OK) return false;
        times.push_back(espReadStats(context, &stats) == ESP_OK ? stats.expandMs : 0);
        return true;
    };
    EspGrowDef grow = scene.grow;
    grow.shadersOnly = 1;
    std::vector<double> ignored;
    bool sound = grows(grow, ignored);  // makes kernels and room
    for (int i = 0; sound && i < 3; ++i) {
        ++grow.maxDepth;  // all anew
        sound = grows(grow, whole);
    }
    for (int i = 0; sound && i < kStrokes * kDabs; ++i) {
        sound = hand.dab(i) && espUpdate(context) == ESP_OK && espReadStats(context, &stats) == ESP_OK;
        if (stats.derivedNodes > 0) dabs.push_back(stats.expandMs);
    }
    for (int i = -2; sound && i < bench.options().repeats; ++i) {
        sound = film.frame(scene::turned(scene.camera, float(i) * 2e-3f), false).wall > 0;
        if (i < 0) continue;
        culls.push_back(film.stats.emitMs);
        draws.push_back(film.stats.drawMs);
    }
    if (!sound || dabs.empty() || !grows(scene.grow, ignored)) return bench.skip("frame/device", espLastError(context));
    const std::string nodes = std::to_string(stats.nodes) + " nodes";
    bench.add({"frame/device/expand", "expansion of all " + nodes + ", time stamps", "ms", median(whole), "60 frames/s",
               kSmooth});
    bench.add(
        {"frame/device/dab", "expansion after a dab, time stamps", "ms", median(dabs), "all anew", median(whole)});
    bench.add({"frame/device/cull", "culling what is bound, time stamps", "ms", median(culls), "60 frames/s", kSmooth});
    bench.add(
        {"frame/device/draw", "drawing a whole picture, time stamps", "ms", median(draws), "60 frames/s", kSmooth});
}

}  // namespace

void placeCases(Bench& bench) {
    const auto wanted = [&](std::initializer_list<const char*> names) {
        return std::any_of(names.begin(), names.end(), [&](const char* name) { return bench.wants(name); });
    };
    const bool sample = wanted({"frame/place", "frame/place/wall", "frame/place/still", "frame/place/walk"});
    const bool dense = wanted({"frame/dense", "frame/dense/coarser", "frame/dense/0.6", "frame/dense/0.75",
                               "frame/dense/whole", "frame/dense/painting"});
    const bool stages = wanted({"frame/device", "frame/device/expand", "frame/device/draw"});
    if (!sample && !dense && !stages) return;
    const char* name = sample ? "frame/place" : dense ? "frame/dense" : "frame/device";
    const EspContextDef def = esp::defaults<EspContextDef>();
    EspContext* made = nullptr;
    if (espCreate(ESP_VERSION, &def, &made) != ESP_OK) return bench.skip(name, espLastError(nullptr));
    const std::unique_ptr<EspContext, void (*)(EspContext*)> context(made, espDestroy);
    scene::Scene scene;
    scene::Request request;
    request.file = bench.options().contentFolder + "/sample.json";
    std::string error;
    if (!scene::openScene(made, request, scene, error) || !scene::plantAll(made, scene, error))
        return bench.skip(name, error);
    if (sample) sampleCases(bench, made, scene);
    if (dense) denseCases(bench, made, scene);
    if (stages) deviceCases(bench, made, scene);
}

}  // namespace espalier
