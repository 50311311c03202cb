// In: the town's grids. Out: whole tiles where they stand, and of each house what is cut, a part for each material.
#include <map>

#include "runtime/emit/roof_triangles.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

glm::vec3 linearOf(uint32_t bytes) {
    return {float(bytes & 255u) / 255, float(bytes >> 8 & 255u) / 255, float(bytes >> 16 & 255u) / 255};
}

class TownGatherer {
  public:
    TownGatherer(EspContext& context, RoofRecords& records, PartsWriter& out)
        : meshes_(*context.roofMeshes), roofs_(context, records), out_(out) {}

    void run() {
        RoofTriangles made;
        made.cellsApart = out_.wants(ESP_PART_TILE);
        for (const RoofGrid& grid : roofs_.records.grids) {
            const TerminalVariant* mesh = meshOf(grid.mesh & 255u);
            if (!mesh || !roofs_.stands(grid)) continue;
            made.cells.clear(), made.positions.clear(), made.normals.clear();
            made.colours.clear(), made.indices.clear();
            (void)appendGrid(roofs_.env, grid, meshes_, made);
            if (!made.cells.empty()) addTiles(grid, *mesh, made.cells);
            if (!made.indices.empty() && out_.wants(ESP_PART_HOUSE)) addCut(grid, *mesh, made);
        }
        for (auto& [of, level] : cut_) {
            const uint32_t material = out_.material(meshes_, of.second, false);
            Part& part =
                out_.single(ESP_PART_HOUSE,
                            "house_" + std::to_string(of.first) + "_" + meshes_.materials[of.second].name, material);
            part.house = of.first;
            part.levels.push_back(std::move(level));
        }
    }

  private:
    const TerminalVariant* meshOf(uint32_t kind) const {
        for (const TerminalVariant& v : meshes_.variants)
            if (v.kind == kind) return &v;
        return nullptr;
    }
    void addTiles(const RoofGrid& grid, const TerminalVariant& mesh, const std::vector<RoofTriangles::Cell>& cells) {
        const auto [known, added] = partOf_.try_emplace(&mesh, 0);
        if (added) known->second = out_.variant(ESP_PART_TILE, mesh.name, meshes_, mesh, false);
        const glm::vec3 root = linearOf(grid.colour);
        for (const RoofTriangles::Cell& cell : cells) {
            EspPartInstance instance{};
            const glm::vec3* columns = &cell.x;
            for (int row = 0; row < 3; ++row)
                for (int column = 0; column < 4; ++column) instance.place.rows[row][column] = columns[column][row];
            put(instance.colour, root * root);
            instance.house = grid.house & 0xFFFFFFu;
            out_.part(known->second).instances.push_back(instance);
        }
    }
    void addCut(const RoofGrid& grid, const TerminalVariant& mesh, const RoofTriangles& made) {
        PartLevel& level = cut_[{grid.house & 0xFFFFFFu, mesh.lods.front().material}];
        const uint32_t first = uint32_t(level.vertices.size());
        for (size_t i = 0; i < made.positions.size(); ++i) {
            EspPartVertex v{};
            put(v.position, made.positions[i]);
            put(v.normal, made.normals[i]);
            put(v.colour, linearOf(made.colours[i]));
            level.vertices.push_back(v);
        }
        for (uint32_t index : made.indices) level.indices.push_back(first + index);
    }

    const TerminalData& meshes_;
    TownRoofs roofs_;
    PartsWriter& out_;
    std::map<const TerminalVariant*, uint32_t> partOf_;
    std::map<std::pair<uint32_t, uint32_t>, PartLevel> cut_;  // by house and material
};

}  // namespace

EspResult gatherTown(EspContext& context, PartsWriter& out) {
    if (!out.wants(ESP_PART_TILE) && !out.wants(ESP_PART_HOUSE)) return ESP_OK;
    if (!context.town || !context.roofs || context.town->view.gridCount == 0 || !townGrammar(context)) return ESP_OK;
    Result<RoofRecords> records = context.roofs->read();
    if (!records) return failGpu(&context, records.failure());
    TownGatherer(context, *records, out).run();
    return ESP_OK;
}

}  // namespace espalier
