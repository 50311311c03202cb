// In: meshes that graphs want as ground. Out: their surfaces, from the cache or from the baker.
#include "tools/baking/graph_bakes.hpp"

#include <array>
#include <cstring>
#include <filesystem>

#include "tools/baking/bake_program.hpp"
#include "tools/export/gltf_file.hpp"
#include "tools/scene/hash.hpp"
#include "tools/scene/text_file.hpp"
#include "tools/scene/user_folders.hpp"

namespace espalier::baking {
namespace {

namespace fs = std::filesystem;
using exporting::GltfFile;
using exporting::Json;

std::string surfaceFor(uint64_t key) {
    const std::string cache = scene::cacheFolder();
    const fs::path folder = cache.empty() ? fs::temp_directory_path() / "espalier" : fs::path(cache);
    return (folder / "graph_bakes" / (scene::hashName(&key, sizeof key) + ".surface.glb")).string();
}

// An older baker may have made another surface of the same mesh.
bool isThere(const std::string& surface) {
    std::error_code none;
    const auto made = fs::last_write_time(surface, none);
    if (none) return false;
    const auto baker = fs::last_write_time(bakeProgram(), none);
    return none || baker < made;
}

std::string modelOf(const EspGraphBake& bake) {
    GltfFile file;
    std::vector<std::array<float, 3>> places(bake.positionCount);
    std::memcpy(places.data(), bake.positions, places.size() * sizeof places[0]);
    const std::vector<uint32_t> corners(bake.indices, bake.indices + bake.indexCount);
    const size_t material =
        file.add("materials", {{"pbrMetallicRoughness",
                                {{"baseColorFactor", {bake.colour[0], bake.colour[1], bake.colour[2], 1}},
                                 {"metallicFactor", 0},
                                 {"roughnessFactor", bake.roughness}}}});
    const Json primitive = {{"attributes", {{"POSITION", file.points(places)}}},
                            {"indices", file.accessor(corners, GltfFile::kUint, "SCALAR", false, GltfFile::kIndices)},
                            {"material", material}};
    file.add("meshes", {{"primitives", Json::array({primitive})}});
    file.node("\"mesh\":0");
    return file.finish({0}, "graph");
}

document::Work::Plan baking(std::string model, const std::string& surface, uint32_t resolution) {
    document::Work::Plan plan;
    plan.beside = [model = std::move(model), surface, resolution](document::Progress& progress, std::string& error) {
        if (model.empty()) {
            error = "the mesh is too large for a binary glTF, which holds 4 GiB";
            return false;
        }
        std::error_code code;
        fs::create_directories(fs::path(surface).parent_path(), code);
        const std::string file = surface.substr(0, surface.size() - std::strlen(".surface.glb")) + ".glb";
        if (!scene::writeText(file, model, error)) return false;
        const bool baked = bake(file, surface, {"--resolution", std::to_string(resolution)}, progress, error);
        fs::remove(file, code);
        return baked;
    };
    return plan;
}

}  // namespace

std::optional<GraphBake> nextGraphBake(EspContext* context, const std::vector<scene::LoadedGraph>& graphs) {
    for (const scene::LoadedGraph& graph : graphs) {
        EspGraphBake asked{};
        asked.structSize = sizeof asked;
        if (espNextGraphBake(context, graph.id, &asked) != ESP_OK || !asked.key) continue;
        GraphBake bake{graph.id, asked.key, surfaceFor(asked.key), false, {}};
        bake.there = isThere(bake.surface);
        if (!bake.there) bake.plan = baking(modelOf(asked), bake.surface, asked.resolution);
        return bake;
    }
    return std::nullopt;
}

// A graph that is gone by now answers with an error, which is nobody's loss.
void answerGraphBake(EspContext* context, const GraphBake& bake, const std::string& error) {
    const char* file = error.empty() ? bake.surface.c_str() : nullptr;
    (void)espGiveGraphBake(context, bake.graph, bake.key, file, file ? nullptr : error.c_str());
}

bool bakeForGraphs(EspContext* context, const std::vector<scene::LoadedGraph>& graphs, std::string& error) {
    while (const std::optional<GraphBake> bake = nextGraphBake(context, graphs)) {
        std::string why;
        if (!bake->there) (void)document::Work(bake->plan).finish(why);  // the node tells why not
        answerGraphBake(context, *bake, why);
        if (espUpdate(context) == ESP_OK) continue;
        error = espLastError(context);
        return false;
    }
    return true;
}

}  // namespace espalier::baking
