// move/…: surfaces that move, come and go by themselves, through the plugin's interface: what an update costs then,
// beside growing everything anew, and what a picture costs after it, beside one for which everything is bound anew.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tools/bake/bake.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/bench_scene.hpp"

namespace espalier {
namespace {

constexpr uint32_t kNodesOnWall = 15'000, kNodesBeside = 500'000;
constexpr int kMoves = 20;  // a run

// A wall of 4 × 3 m, 0.3 m thick.
Model wall() {
    const glm::vec3 half(2, 1.5f, .15f);
    Model model;
    model.name = "wall";
    for (uint32_t i = 0; i < 8; ++i)
        model.positions.push_back(half * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    model.indices = {1, 3, 7, 1, 7, 5, 0, 4, 6, 0, 6, 2, 2, 6, 7, 2, 7, 3,
                     0, 1, 5, 0, 5, 4, 4, 5, 7, 4, 7, 6, 0, 2, 3, 0, 3, 1};
    return model;
}

EspTransform placedAt(float x, float z) {
    EspTransform place = espIdentity();
    place.rows[0][3] = x;
    place.rows[2][3] = z;
    return place;
}

// A wall with plants beside another one with many more, far enough from each other.
class Walls {
  public:
    ~Walls() {
        espDestroy(context_);
        if (!path_.empty()) std::filesystem::remove(path_);
    }
    bool build() {
        BakeOptions options;
        options.resolution = 512;
        Result<Baked> baked = bake(wall(), options);
        if (!baked) return false;
        path_ = (std::filesystem::temp_directory_path() / ("espalier_bench_wall_" + std::to_string(getpid()) + ".glb"))
                    .string();
        if (!writeSurface(baked->surface, path_)) return false;
        EspContextDef def = esp::defaults<EspContextDef>();
        const std::string text = branchingGrammar(0.02f, 100, 40);
        const EspGrammarDef grammar = esp::grammarDef("wall", text);
        if (espCreate(ESP_VERSION, &def, &context_) != ESP_OK || !load(0, kFar, beside_) || !load(0, 0, wall_) ||
            espCompileGrammar(context_, &grammar, &grammar_) != ESP_OK)
            return false;
        if (!plant(0, kNodesOnWall)) return false;
        onWall_ = stats().nodes;
        return plant(kFar, kNodesOnWall + kNodesBeside);
    }
    bool load(float x, float z, EspSurface& out) {
        const EspTransform place = placedAt(x, z);
        return espLoadSurface(context_, path_.c_str(), &place, &out) == ESP_OK;
    }
    bool destroy(EspSurface surface) { return espDestroySurface(context_, surface) == ESP_OK; }
    bool moveWall(float x) {
        const EspTransform place = placedAt(x, 0);
        return espMoveSurface(context_, wall_, &place) == ESP_OK;
    }
    // The one with most of the nodes.
    bool moveOther(float x) {
        const EspTransform place = placedAt(x, kFar);
        return espMoveSurface(context_, beside_, &place) == ESP_OK;
    }
    bool update() { return espUpdate(context_) == ESP_OK; }
    bool growAll() {
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.maxDepth -= ++timesAll_ % 2;
        return espSetGrow(context_, &grow) == ESP_OK && update();
    }
    // A small picture, for what is bound for it.
    bool draw() {
        esp::DrawDef def;
        def.width = 64;
        def.height = 36;
        def.camera = esp::frameAll(context_);
        def.look.shadows = 0;
        return espDraw(context_, &def) == ESP_OK;
    }
    // So that the next picture binds everything anew.
    bool forget() { return espDropFrame(context_) == ESP_OK; }
    uint64_t onWall() const { return onWall_; }
    EspStats stats() const {
        EspStats stats{};
        (void)espReadStats(context_, &stats);
        return stats;
    }
    const char* why() const { return context_ ? espLastError(context_) : espLastError(nullptr); }
    static constexpr float kFar = 40;

  private:
    // Seeds along the foot of the wall that stands there, until there are so many nodes.
    bool plant(float z, uint32_t nodes) {
        while (stats().nodes < nodes) {
            for (int i = 0; i < (nodes > kNodesOnWall ? 200 : 4); ++i) {
                EspSeedDef def = esp::defaults<EspSeedDef>();
                def.grammar = grammar_;
                def.number = ++seeds_;
                def.position[0] = -1.9f + 3.8f * float(seeds_ * 37 % 97) / 97;
                def.position[1] = -1.4f + 1.0f * float(seeds_ * 53 % 89) / 89;
                def.position[2] = z + .15f;
                def.direction[1] = 1;
                EspSeed seed{};
                if (espPlant(context_, &def, &seed) != ESP_OK) return false;
            }
            if (!update()) return false;
        }
        return true;
    }

    std::string path_;
    EspContext* context_ = nullptr;
    EspSurface wall_{}, beside_{};
    EspGrammar grammar_{};
    uint32_t seeds_ = 0, timesAll_ = 0;
    uint64_t onWall_ = 0;
};

std::string figureOf(const char* what, uint64_t nodes) {
    return std::string(what) + "; " + std::to_string(nodes) + " nodes stand";
}

// Times of pictures after `change` and an update, and of such for which everything is bound anew as well.
template <class Change>
Pair picturesAfter(const Bench& bench, Walls& walls, bool& sound, const Change& change) {
    sound = walls.draw() && sound;
    std::vector<double> parts, wholes;
    for (int i = 0; i < 2 * bench.options().repeats; ++i) {
        sound = change() && walls.update() && sound;
        if (i % 2 != 0) sound = walls.forget() && sound;
        (i % 2 != 0 ? wholes : parts).push_back(seconds([&] { sound = walls.draw() && sound; }));
    }
    return {median(parts), median(wholes)};
}

void addPictures(Bench& bench, const char* name, const std::string& figure, const Pair& times) {
    bench.add({name, "a picture of 64 x 36 after " + figure, "ms", 1e3 * times.a, "one for which all is bound anew",
               1e3 * times.b});
}

void moveAlone(Bench& bench, Walls& walls) {
    const uint64_t nodes = walls.stats().nodes;
    uint64_t derived = 0;
    float at = 0;
    bool sound = true;
    const auto move = [&] {
        for (int i = 0; i < kMoves; ++i) {
            sound = walls.moveWall(at = at > 3 ? 0 : at + .01f) && walls.update() && sound;
            derived += walls.stats().derivedNodes;
        }
    };
    const Pair times = medianSeconds(bench.options().repeats, move, [&] { sound = walls.growAll() && sound; });
    if (!sound) return bench.skip("move/alone", walls.why());
    const std::string what = "a wall with " + std::to_string(walls.onWall()) + " nodes moves by itself";
    bench.add(
        {"move/alone", figureOf(what.c_str(), nodes), "ms", 1e3 * times.a / kMoves, "everything anew", 1e3 * times.b});
    bench.add({"move/alone/derived", "nodes derived by all of these", "nodes", double(derived), "those that stand",
               double(nodes)});
    at = 0;
    const Pair few = picturesAfter(bench, walls, sound, [&] { return walls.moveWall(at += .01f); });
    const Pair most = picturesAfter(bench, walls, sound, [&] { return walls.moveOther(at += .01f); });
    if (!sound) return bench.skip("move/alone/picture", walls.why());
    addPictures(bench, "move/alone/picture", "a move of a wall with " + std::to_string(walls.onWall()) + " nodes", few);
    addPictures(bench, "move/most/picture",
                "a move of a wall with " + std::to_string(nodes - walls.onWall()) + " nodes", most);
}

void comeAndGo(Bench& bench, Walls& walls) {
    const uint64_t nodes = walls.stats().nodes;
    uint64_t derived = 0;
    bool sound = true;
    std::vector<double> updates, whole;
    for (int i = 0; i < bench.options().repeats; ++i) {
        EspSurface third{};
        const auto update = [&] {
            updates.push_back(seconds([&] { sound = walls.update() && sound; }));
            derived += walls.stats().derivedNodes;
        };
        sound = walls.load(Walls::kFar, Walls::kFar, third) && sound;
        update();
        sound = walls.destroy(third) && sound;
        update();
        whole.push_back(seconds([&] { sound = walls.growAll() && sound; }));
    }
    EspSurface third{};
    const Pair pictures = picturesAfter(bench, walls, sound, [&] {
        if (third.id != 0) return walls.destroy(std::exchange(third, {}));
        return walls.load(Walls::kFar, Walls::kFar / 2, third);
    });
    if (third.id != 0) sound = walls.destroy(third) && sound;
    if (!sound) return bench.skip("move/unrelated", walls.why());
    addPictures(bench, "move/unrelated/picture", "a surface has come, or gone, that touches nothing", pictures);
    bench.add({"move/unrelated", figureOf("the update after a surface has come, or gone, that touches nothing", nodes),
               "ms", 1e3 * median(updates), "everything anew", 1e3 * median(whole)});
    bench.add({"move/unrelated/derived", "nodes derived by all of these", "nodes", double(derived), "those that stand",
               double(nodes)});
}

}  // namespace

void moveCases(Bench& bench) {
    if (!bench.wants("move/alone") && !bench.wants("move/unrelated")) return;
    Walls walls;
    if (!walls.build()) return bench.skip("move/alone", walls.why());
    if (bench.wants("move/alone")) moveAlone(bench, walls);
    if (bench.wants("move/unrelated")) comeAndGo(bench, walls);
}

}  // namespace espalier
