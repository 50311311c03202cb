// In: parts and where they stand. Out: one mesh for what belongs together, each place once.
#include "tools/export/collision.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace espalier::exporting {
namespace {

using Point = std::array<float, 3>;

class CollisionMesh {
  public:
    void add(const ExportPart::Level& level, const EspTransform& place) {
        const auto& m = place.rows;
        std::vector<uint32_t> numbers;
        for (const EspPartVertex& v : level.vertices) {
            Point p;
            for (size_t i = 0; i < 3; ++i)
                p[i] = m[i][0] * v.position[0] + m[i][1] * v.position[1] + m[i][2] * v.position[2] + m[i][3];
            const auto [known, added] = known_.try_emplace(p, uint32_t(points_.size()));
            if (added) points_.push_back(p);
            numbers.push_back(known->second);
        }
        for (size_t i = 0; i + 2 < level.indices.size(); i += 3) {
            const uint32_t a = numbers[level.indices[i]], b = numbers[level.indices[i + 1]],
                           c = numbers[level.indices[i + 2]];
            if (a != b && b != c && c != a) indices_.insert(indices_.end(), {a, b, c});
        }
    }
    void write(const std::string& name, GltfFile& file, std::vector<size_t>& nodes) const {
        if (indices_.empty()) return;
        Json primitive = {{"attributes", {{"POSITION", file.points(points_)}}},
                          {"indices", file.accessor(indices_, GltfFile::kUint, "SCALAR", false, GltfFile::kIndices)}};
        const size_t mesh = file.add("meshes", {{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
        std::string text = "\"mesh\":" + std::to_string(mesh);
        appendText(text, "name", name);
        nodes.push_back(file.node(text));
    }

  private:
    std::map<Point, uint32_t> known_;
    std::vector<Point> points_;
    std::vector<uint32_t> indices_;
};

std::string nameOf(const ExportPart& part, const EspPartInstance& instance) {
    if (part.kind == ESP_PART_STEMS) return part.name;
    if (part.kind == ESP_PART_PIECE) return "pieces";
    return "house_" + std::to_string(part.kind == ESP_PART_HOUSE ? part.house : instance.house);
}

}  // namespace

std::vector<size_t> addCollision(const Gathered& gathered, GltfFile& file) {
    std::map<std::string, CollisionMesh> meshes;
    for (const ExportPart& part : gathered.parts) {
        if (part.kind == ESP_PART_LEAF) continue;
        for (const EspPartInstance& instance : part.instances)
            meshes[nameOf(part, instance)].add(part.levels.back(), instance.place);
    }
    std::vector<size_t> nodes;
    for (const auto& [name, mesh] : meshes) mesh.write(name + "_collision", file, nodes);
    return nodes;
}

}  // namespace espalier::exporting
