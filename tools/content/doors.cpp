// In: footprints and a grammar. Out: the doors among the terminals that it grows from them.

#include "tools/content/doors.hpp"

#include <algorithm>
#include <filesystem>

#include "runtime/core/file.hpp"
#include "runtime/roof/shapes.hpp"
#include "runtime/roof_growth/roof_growth.hpp"
#include "tools/content/roof_mesh.hpp"

namespace espalier::content {
namespace {

// By the numbers that a grammar gets for them.
struct Terminals {
    std::vector<std::string> names;
    std::vector<RoofMesh> bounds;
};
Terminals roofTerminals() {
    Terminals out;
    for (const RoofMeshes::Entry& e : makeRoofMeshes().all) {
        const std::string name = e.name.substr(0, e.name.find("_lod"));
        if (std::find(out.names.begin(), out.names.end(), name) != out.names.end()) continue;
        RoofMesh bounds{glm::vec3(1e9f), glm::vec3(-1e9f)};
        for (glm::vec3 p : e.mesh.positions) {
            bounds.low = glm::min(bounds.low, p);
            bounds.high = glm::max(bounds.high, p);
        }
        out.names.push_back(name);
        out.bounds.push_back(bounds);
    }
    return out;
}

Result<RuleMap> compileFile(const std::string& path, const std::vector<std::string>& terminals) {
    CompileOptions options;
    for (const std::string& name : terminals) options.roofMeshes.push_back({name, false});
    return compileGrammarFile(path, options);
}

}  // namespace

Result<std::vector<Door>> findDoors(const std::string& town, const std::string& grammar) {
    const Terminals terminals = roofTerminals();
    Result<RuleMap> map = compileFile(grammar, terminals.names);
    if (!map) return map.failure();
    if (!map->roofs()) return Failure(grammar, "makes no roofs");
    Result<Town> read = readFootprints(town);
    if (!read) return read.failure();
    const RoofStructure structure = roofsOf(read->footprints, read->diagnostics);
    if (structure.houses.empty()) return Failure(town, "holds no building whose roof could be made");
    const RoofTables tables = makeAtoms(structure);
    RoofInputs inputs;
    inputs.town = &tables;
    inputs.grammar = &*map;
    inputs.meshes = terminals.bounds;
    const CpuRoofs grown = growRoofsOnCpu(inputs);
    if (!grown.complete) return grown.complete.failure();
    std::vector<Door> doors;
    for (const RoofGrid& g : grown.records.grids) {
        if (terminals.names[g.mesh & 255u] != "door") continue;
        const glm::vec3 x(g.axisX), out = glm::cross(x, glm::vec3(g.axisY)),
                                    sill = glm::vec3(g.origin) + x * (g.size.x / 2);
        const glm::vec2 plot = grown.records.plots[g.house & 0xFFFFFFu].at;
        doors.push_back({plot + glm::vec2(sill.x, sill.z), glm::normalize(glm::vec2(out.x, out.z))});
    }
    // Growth knows no order.
    std::sort(doors.begin(), doors.end(),
              [](const Door& a, const Door& b) { return a.at.x != b.at.x ? a.at.x < b.at.x : a.at.y < b.at.y; });
    return doors;
}

}  // namespace espalier::content
