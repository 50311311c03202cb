// bake/…: all levels and links from a mesh in memory, beside the bake as the paper describes it (one level, kd-tree);
// and how much memory the atlas and the whole take at most.
#include <malloc.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "tools/bench/bench.hpp"
#include "tools/bench/paper_bake.hpp"

namespace espalier {

namespace {

// A line of the process's status in bytes, 0 where there is no such thing.
double ownStatus(const std::string& line) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (double kilobytes = 0; word == line + ":" && status >> kilobytes) return kilobytes * 1024;
    return 0;
}

// Bytes a triangle of what is added while baking, the model itself not counted.
void memoryCases(Bench& bench) {
    constexpr double kBound = 1024;
    const std::pair<const char*, const char*> cases[] = {{"bake/memory-bunny", "derived/bunny.glb"},
                                                         {"bake/memory-armadillo", "derived/armadillo.glb"},
                                                         {"bake/memory-dragon", "derived/dragon_res3.glb"},
                                                         {"bake/memory-house", "models/quaternius/House2.glb"}};
    for (const auto& [name, file] : cases) {
        if (!bench.wants(name)) continue;
        const std::string path = bench.options().dataFolder + "/" + file;
        Result<Model> model = importModel(path);
        ::malloc_trim(0);  // what was freed before had better not be taken again unseen
        if (!model || !(std::ofstream("/proc/self/clear_refs") << "5" << std::flush)) {
            bench.skip(name, model ? "no peak of memory can be measured here" : "needs " + path);
            continue;
        }
        const double before = ownStatus("VmRSS"), triangles = double(model->indices.size() / 3);
        double atlas = 0;
        BakeOptions options;
        options.progress = [&](float, const char* stage) {
            if (std::string(stage) == "links") atlas = ownStatus("VmHWM") - before;
        };
        if (!bake(*model, options)) {
            bench.skip(name, "can't be baked");
            continue;
        }
        bench.add({name, "at most, until charts are placed", "B/triangle", atlas / triangles, "bound", kBound});
        bench.add({std::string(name) + "/whole", "at most, all levels of 1024^2", "B/triangle",
                   (ownStatus("VmHWM") - before) / triangles, "bound", kBound});
    }
}

}  // namespace

void bakeCases(Bench& bench) {
    memoryCases(bench);
    struct Case {
        const char* name;
        const char* file;
    };
    const Case cases[] = {{"bake/bunny-1024", "derived/bunny_unwrap.glb"},
                          {"bake/hermes-1024", "models/threedscans/Hermes.glb"},
                          {"bake/cat-1024", "models/polyhaven_concrete_cat_statue/concrete_cat_statue_1k.gltf"}};
    for (const Case& c : cases) {
        if (!bench.wants(c.name)) continue;
        std::string path = bench.options().dataFolder + "/" + c.file;
        Result<Model> model = importModel(path);
        if (!model) {
            bench.skip(c.name, "needs " + path);
            continue;
        }
        BakeOptions options;
        std::string failure;
        auto ours = [&] {
            if (Result<Baked> baked = bake(*model, options); !baked) failure = baked.failure().text();
        };
        Pair pair = medianSeconds(bench.options().repeats, ours, [&] { (void)paperBake(*model, 1024); });
        if (!failure.empty()) {
            bench.skip(c.name, failure);
            continue;
        }
        std::string figure = "all levels, " + std::to_string(model->indices.size() / 3) + " triangles";
        bench.add({c.name, figure, "s", pair.a, "the paper's bake, one level, one thread", pair.b});
    }
}

}  // namespace espalier
