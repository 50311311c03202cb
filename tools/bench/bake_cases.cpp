// bake/…: all levels and links from a mesh in memory, beside the bake as the paper describes it (one level, kd-tree);
// and how much memory the atlas and the whole take at most.
#include <malloc.h>

#include <cstdio>
#include <fstream>
#include <map>
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

// Each triangle in four, by its edges' middles.
Model refined(const Model& model) {
    Model out = model;
    out.normals.clear(), out.uvs.clear(), out.materialUvs.clear(), out.triangleMaterial.clear();
    out.indices.clear();
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    auto middle = [&](uint32_t a, uint32_t b) {
        auto [at, isNew] = middles.try_emplace(std::minmax(a, b), uint32_t(out.positions.size()));
        if (isNew) out.positions.push_back((model.positions[a] + model.positions[b]) / 2.0f);
        return at->second;
    };
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        const uint32_t a = model.indices[i], b = model.indices[i + 1], c = model.indices[i + 2];
        const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        out.indices.insert(out.indices.end(), {a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca});
    }
    return out;
}

// Bytes a triangle of what is added while baking, the model itself not counted.
void memoryRows(Bench& bench, const std::string& name, const Model& model) {
    constexpr double kBound = 1024;
    ::malloc_trim(0);  // what was freed before had better not be taken again unseen
    if (!(std::ofstream("/proc/self/clear_refs") << "5" << std::flush))
        return bench.skip(name, "no peak of memory can be measured here");
    const double before = ownStatus("VmRSS"), triangles = double(model.indices.size() / 3);
    double atlas = 0, most = 0;
    std::string stage, highest;
    BakeOptions options;
    options.progress = [&](float, const char* next) {
        const double peak = ownStatus("VmHWM") - before;
        if (peak > most) most = peak, highest = stage;
        stage = next;
        if (stage == "links") atlas = peak;
    };
    Result<Baked> baked = bake(model, options);
    if (!baked) return bench.skip(name, "can't be baked");
    double images = 0;
    for (const SurfaceLevelData& level : baked->surface.levels)
        images += double(level.texels.size() * sizeof(Texel) + level.aux.size() * sizeof(TexelAux) +
                         level.crossingHead.size() * 4 + level.crossingRefs.size() * 4);
    bench.add({name, "at most, until charts are placed", "B/triangle", atlas / triangles, "bound", kBound});
    bench.add({name + "/whole", "at most, in the stage " + highest, "B/triangle", most / triangles,
               "of it images of all levels of 1024^2", images / triangles});
}

void memoryCases(Bench& bench) {
    const std::pair<const char*, const char*> cases[] = {{"bake/memory-bunny", "derived/bunny.glb"},
                                                         {"bake/memory-armadillo", "derived/armadillo.glb"},
                                                         {"bake/memory-armadillo-346k", "derived/armadillo.glb"},
                                                         {"bake/memory-dragon", "derived/dragon_res3.glb"},
                                                         {"bake/memory-house", "models/quaternius/House2.glb"}};
    for (const auto& [name, file] : cases) {
        if (!bench.wants(name)) continue;
        const std::string path = bench.options().dataFolder + "/" + file;
        Result<Model> model = importModel(path);
        if (!model)
            bench.skip(name, "needs " + path);
        else
            memoryRows(bench, name, std::string(name).ends_with("346k") ? refined(*model) : *model);
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
