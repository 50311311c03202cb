// bake/…: all levels and links from a mesh in memory, beside the bake as the paper describes it (one level, kd-tree);
// and the atlas of models without UVs, beside what xatlas took.
#include <cstdio>

#include "tools/bench/bench.hpp"
#include "tools/bench/paper_bake.hpp"

namespace espalier {

namespace {

// Seconds from triangles to charts that lie in the square.
double atlasSeconds(const BakeReport& report) {
    double sum = 0;
    for (const auto& [stage, time] : report.seconds)
        if (stage == "mesh" || stage == "atlas" || stage == "layout") sum += time;
    return sum;
}

void atlasCases(Bench& bench) {
    struct Case {
        const char *name, *file, *otherName;
        double otherSeconds;  // xatlas isn't packaged: measured once, by itself, on such a machine
    };
    // Of 124k triangles in 5.6 s to 65k in 7.2 s: for models that it wasn't run on, the fastest of its rates.
    const char* rate = "xatlas at its best rate";
    constexpr double kRate = 5.6 / 124000;
    const Case cases[] = {{"bake/atlas-bunny", "derived/bunny.glb", "xatlas, measured elsewhere, 53 charts", 12.3},
                          {"bake/atlas-armadillo", "derived/armadillo.glb", rate, kRate * 86482},
                          {"bake/atlas-dragon", "derived/dragon_res3.glb", rate, kRate * 47794},
                          {"bake/atlas-house", "models/quaternius/House2.glb", rate, kRate * 19714}};
    for (const Case& c : cases) {
        if (!bench.wants(c.name)) continue;
        std::string path = bench.options().dataFolder + "/" + c.file;
        Result<Model> model = importModel(path);
        if (!model) {
            bench.skip(c.name, "needs " + path);
            continue;
        }
        std::vector<double> times;
        BakeReport last;
        for (int i = 0; i < bench.options().repeats; ++i)
            if (Result<Baked> baked = bake(*model, {})) {
                last = baked->report;
                times.push_back(atlasSeconds(last));
            }
        if (times.empty()) {
            bench.skip(c.name, "can't be baked");
            continue;
        }
        char figure[96];
        std::snprintf(figure, sizeof figure, "%u triangles, %u charts, stretch %.2f at p95", last.triangles,
                      last.charts, last.stretch95);
        bench.add({c.name, figure, "s", median(times), c.otherName, c.otherSeconds});
    }
}

}  // namespace

void bakeCases(Bench& bench) {
    atlasCases(bench);
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
