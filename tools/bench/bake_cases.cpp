// bake/…: all levels and links from a mesh in memory, beside the bake as the paper describes it (one level, kd-tree).
#include <cstdio>

#include "tools/bench/bench.hpp"
#include "tools/bench/paper_bake.hpp"

namespace espalier {

void bakeCases(Bench& bench) {
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
