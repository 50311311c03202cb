// In: footprints. Out: a glTF 2.0 binary of the town's houses (Buron 2013 §5: geometry only where someone asks for it).
#include "tools/bake/main/town.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "runtime/core/file.hpp"
#include "runtime/core/glb.hpp"
#include "runtime/roof/shapes.hpp"
#include "tools/bake/main/town_mesh.hpp"
#include "tools/bake/main/town_walls.hpp"

namespace espalier {
namespace {

using nlohmann::json;
constexpr size_t kMostBytes = 3u << 30;  // a glTF binary counts in 32 bits

class GlbWriter {
  public:
    // A house's triangles on its plot, `at` in the town: its node is moved there if that is so far away that floats
    // would lose what the triangles hold. False when the file would grow beyond what its format can count.
    bool add(const std::string& name, RoofTriangles mesh, glm::vec2 at) {
        constexpr float kFar = 1000;  // metres
        if (mesh.indices.empty()) return true;
        json node = {{"name", name}, {"mesh", root_["nodes"].size()}};
        if (glm::length(at) > kFar)
            node["translation"] = {at.x, 0, at.y};
        else
            for (glm::vec3& p : mesh.positions) p += glm::vec3(at.x, 0, at.y);
        const size_t bytes = mesh.bytes();
        if (binary_.size() + bytes > kMostBytes) return false;
        glm::vec3 low(1e30f), high(-1e30f);
        for (glm::vec3 p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
        const json position = accessor(mesh.positions, 34962, 5126, "VEC3");
        root_["accessors"].back()["min"] = {low.x, low.y, low.z};
        root_["accessors"].back()["max"] = {high.x, high.y, high.z};
        const json normal = accessor(mesh.normals, 34962, 5126, "VEC3");
        const json colour = accessor(mesh.colours, 34962, 5121, "VEC4");
        root_["accessors"].back()["normalized"] = true;
        const json indices = accessor(mesh.indices, 34963, 5125, "SCALAR");
        root_["nodes"].push_back(std::move(node));
        root_["meshes"].push_back(
            {{"name", name},
             {"primitives",
              json::array({json{{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"COLOR_0", colour}}},
                                {"indices", indices},
                                {"material", 0}}})}});
        return true;
    }
    Status write(const std::string& path, const std::string& footprints, const Town& town) {
        json nodes = json::array();
        for (size_t i = 0; i < root_["nodes"].size(); ++i) nodes.push_back(i);
        root_["asset"] = {{"version", "2.0"}, {"generator", "espalier-bake " ESPALIER_VERSION}};
        root_["scene"] = 0;
        root_["scenes"] = json::array({json{{"nodes", nodes}}});
        const json surface = {{"metallicFactor", 0}, {"roughnessFactor", 0.9}};
        root_["materials"] =
            json::array({json{{"name", "town"}, {"doubleSided", true}, {"pbrMetallicRoughness", surface}}});
        root_["extensionsUsed"] = json::array({"ESPALIER_town"});
        root_["extensions"]["ESPALIER_town"] = {
            {"footprints", footprints}, {"origin", {town.origin.x, town.origin.y}}, {"geographic", town.geographic}};
        root_["buffers"] = json::array({json{{"byteLength", binary_.size()}}});
        return writeGlb(path, root_.dump(-1, ' ', false, json::error_handler_t::replace),
                        std::as_bytes(std::span(binary_)));
    }

  private:
    template <class T>
    size_t accessor(const std::vector<T>& values, int target, int component, const char* type) {
        const size_t bytes = values.size() * sizeof(T);
        root_["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}, {"target", target}});
        binary_.append(reinterpret_cast<const char*>(values.data()), bytes);
        root_["accessors"].push_back({{"bufferView", root_["bufferViews"].size() - 1},
                                      {"componentType", component},
                                      {"count", values.size()},
                                      {"type", type}});
        return root_["accessors"].size() - 1;
    }
    json root_ = json::object();
    std::string binary_;
};

Result<RuleMap> compileFor(const TownArguments& arguments, const TerminalData& meshes) {
    CompileOptions options;
    for (const std::string& kind : meshes.kinds) options.roofMeshes.push_back({kind, false});
    Result<RuleMap> map = compileGrammarFile(arguments.grammar, options);
    if (map && !map->roofs()) return Failure(arguments.grammar, "makes no roofs");
    return map;
}

void warn(const std::string& file, std::string message) {
    std::fprintf(stderr, "%s\n", toString(Diagnostic{file, 0, 0, {}, std::move(message), true}).c_str());
}

Status addTiles(const TownArguments& arguments, const RoofStructure& structure, GlbWriter& glb, size_t& triangles) {
    Result<TerminalData> meshes = readTerminals(arguments.meshes, {"bark"});
    if (!meshes) return meshes.failure();
    Result<RuleMap> map = compileFor(arguments, *meshes);
    if (!map) return map.failure();
    const RoofTables tables = makeAtoms(structure);
    const std::vector<RoofMesh> bounds = terminalBounds(*meshes);
    RoofInputs inputs;
    inputs.town = &tables;
    inputs.grammar = &*map;
    inputs.meshes = bounds;
    CpuRoofs roofs = growRoofsOnCpu(inputs, 0);
    if (!roofs.complete) return Failure(arguments.grammar, roofs.complete.failure().diagnostics.front().message);
    if (roofs.status.stopped)
        warn(arguments.grammar, "a limit ended " + std::to_string(roofs.status.stopped) + " shapes: more than " +
                                    std::to_string(kMaxRoofDepth) +
                                    " rules followed each other, or a Repeat was too large");
    RoofEnv env{};
    env.grids.v = roofs.records.grids.data();
    env.runs.v = roofs.records.runs.data();
    env.regions.v = roofs.records.regions.data();
    env.parts.v = roofs.records.parts.data();
    env.planes.v = roofs.records.planes.data();
    env.meshes.v = const_cast<RoofMesh*>(bounds.data());
    std::vector<RoofPlot> onPlots(structure.houses.size());  // triangles are written where their house's plot begins
    env.plots.v = onPlots.data();
    RoofLayer layers[kRoofLayers] = {};  // nothing is painted
    for (uint32_t i = 0; i < kRoofLayers; ++i) layers[i].fill = inputs.fill(i);
    env.layers.v = layers;
    std::vector<std::vector<uint32_t>> gridsOf(structure.houses.size());
    for (uint32_t i = 0; i < roofs.records.grids.size(); ++i)
        gridsOf[roofs.records.grids[i].house & 0xFFFFFFu].push_back(i);
    // Threads have drawn the grids' places, keys are the same in every run.
    for (std::vector<uint32_t>& grids : gridsOf)
        std::ranges::sort(grids, {}, [&](uint32_t i) { return roofs.records.grids[i].key; });
    for (uint32_t h = 0; h < structure.houses.size(); ++h) {
        RoofTriangles mesh;
        if (arguments.walls)
            appendWalls(env, gridsOf[h], structure, h, mesh);
        else
            for (uint32_t g : gridsOf[h])
                if (!appendGrid(env, roofs.records.grids[g], *meshes, mesh, kMostBytes)) break;  // which add() refuses
        triangles += mesh.indices.size() / 3;
        if (!glb.add(structure.houses[h].id, std::move(mesh), tables.plots[h].at))
            return Failure(arguments.output,
                           "more than 3 GiB of triangles: leave the grammar out, or give fewer houses");
    }
    return Done{};
}

// Leaves the footprints that were asked for.
Status keepHouses(const TownArguments& arguments, std::vector<Footprint>& footprints) {
    for (const std::string& id : arguments.houses)
        if (std::none_of(footprints.begin(), footprints.end(), [&](const Footprint& f) { return f.id == id; }))
            return Failure(arguments.footprints, "holds no building '" + id + "'");
    if (!arguments.houses.empty())
        std::erase_if(footprints, [&](const Footprint& f) {
            return std::find(arguments.houses.begin(), arguments.houses.end(), f.id) == arguments.houses.end();
        });
    return Done{};
}

}  // namespace

bool isTown(const std::string& path) {
    const std::filesystem::path file(path);
    if (file.extension() == ".geojson") return true;
    if (file.extension() != ".json") return false;
    Result<std::string> text = readTextFile(path);
    const auto has = [&](const char* word) { return text->find(word) != std::string::npos; };
    // What isn't a model in JSON either is told of as a town.
    return text && (has("\"buildings\"") || has("\"FeatureCollection\"") || !has("\"asset\""));
}

Status bakeTown(const TownArguments& arguments) {
    Result<std::string> text = readTextFile(arguments.footprints);
    if (!text) return text.failure();
    Result<Town> town = parseFootprints(*text, arguments.footprints);
    if (!town) return town.failure();
    if (Status s = keepHouses(arguments, town->footprints); !s) return s;
    std::vector<Diagnostic> diagnostics = std::move(town->diagnostics);
    const RoofStructure structure = roofsOf(town->footprints, diagnostics);
    for (Diagnostic& d : diagnostics) {
        if (d.file.empty()) d.file = arguments.footprints;
        d.warning = true;
        std::fprintf(stderr, "%s\n", toString(d).c_str());
    }
    if (structure.houses.empty()) return Failure(arguments.footprints, "holds no building whose roof could be made");
    GlbWriter glb;
    size_t triangles = 0;
    if (!arguments.grammar.empty()) {
        if (Status s = addTiles(arguments, structure, glb, triangles); !s) return s;
    } else {
        for (uint32_t h = 0; h < structure.houses.size(); ++h) {
            RoofTriangles mesh;
            appendMassing(structure, h, mesh);
            triangles += mesh.indices.size() / 3;
            const glm::dvec2 origin = structure.houses[h].origin;
            if (!glb.add(structure.houses[h].id, std::move(mesh), glm::vec2(origin.x, -origin.y)))
                return Failure(arguments.output, "more than 3 GiB of triangles");
        }
    }
    if (Status s = glb.write(arguments.output, *text, *town); !s) return s;
    if (!arguments.quiet)
        std::fprintf(stderr, "%zu footprints: %zu houses, %zu triangles\n", town->footprints.size(),
                     structure.houses.size(), triangles);
    return Done{};
}

}  // namespace espalier
