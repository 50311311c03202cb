// In: copies of parts. Out: a glTF file: meshes that nodes share, plants and houses as groups.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <map>

#include "tools/export/collision.hpp"
#include "tools/export/colours.hpp"
#include "tools/export/export.hpp"
#include "tools/export/meshes.hpp"
#include "tools/export/placing.hpp"
#include "tools/export/surfaces.hpp"

namespace espalier::exporting {
namespace {

constexpr size_t kMostColours = 12, kMostTileColours = 64;  // materials of one part
constexpr size_t kStep = 4096;                              // instances from one look at the progress to the next
constexpr float kPicturePixels = 1080;                      // height of the picture that levels are chosen for

// What belongs together, under a name.
struct Group {
    std::string name;
    std::vector<size_t> children;
};

class Encoder {
  public:
    Encoder(const Gathered& gathered, const Options& options, const std::function<bool(float)>& goOn)
        : gathered_(gathered), options_(options), goOn_(goOn), meshes_(gathered, options, file_) {}

    bool run(std::string& bytes, Written& written, std::string& error) {
        if (!meshes_.addPictures(error)) return false;
        for (const ExportPart& part : gathered_.parts) total_ += part.instances.size();
        for (const ExportPart& part : gathered_.parts)
            if (part.kind == ESP_PART_STEMS) groupOf("ivy", part.seed, plantName(part));
        for (const ExportPart& part : gathered_.parts)
            if (!addPart(part)) return false;
        std::vector<size_t> roots;
        for (auto& [kind, groups] : groups_) roots.push_back(closeGroups(kind, groups));
        if (options_.collision) roots.push_back(nodeOver("collision", addCollision(gathered_, file_)));
        if (std::vector<size_t> nodes; !gathered_.surfaces.empty()) {
            if (!addSurfaces(gathered_.surfaces, file_, nodes, error)) return false;
            roots.push_back(nodeOver("surfaces", nodes));
        }
        bytes = file_.finish(roots, "espalier");
        if (bytes.empty()) error = "it is more than a binary glTF can hold (4 GiB)";
        written_.nodes = file_.nodeCount();
        written_.meshes = file_.json()["meshes"].size();
        written_.materials = file_.json()["materials"].size();
        written_.bytes = bytes.size();
        written = written_;
        return !bytes.empty();
    }

  private:
    static std::string plantName(const ExportPart& stems) { return "plant" + stems.name.substr(stems.name.find('_')); }

    // owner: the seed, the house; groups of patterns have none.
    Group& groupOf(const std::string& kind, uint32_t owner, const std::string& name) {
        const auto [known, added] = groups_[kind].try_emplace(owner);
        if (added) known->second.name = name;
        return known->second;
    }
    Group& groupOf(const ExportPart& part, const EspPartInstance* instance) {
        switch (part.kind) {
            case ESP_PART_STEMS:
                return groupOf("ivy", part.seed, plantName(part));
            case ESP_PART_LEAF:
                return instance ? groupOf("ivy", instance->seed.id, "plant") : groupOf("ivy", 0, "leaves");
            case ESP_PART_TILE:
                return instance ? groupOf("roofs", instance->house, "house_" + std::to_string(instance->house))
                                : groupOf("roofs", ~0u, "tiles");
            case ESP_PART_HOUSE:
                return groupOf("roofs", part.house, "house_" + std::to_string(part.house));
            case ESP_PART_PIECE:
                break;
        }
        return groupOf("patterns", 0, "pieces");
    }
    size_t closeGroups(const std::string& kind, const std::map<uint32_t, Group>& groups) {
        std::vector<size_t> children;
        for (const auto& [owner, group] : groups) children.push_back(nodeOver(group.name, group.children));
        return nodeOver(kind, children);
    }
    size_t nodeOver(const std::string& name, const std::vector<size_t>& children) {
        std::string text, list;
        appendText(text, "name", name);
        for (size_t node : children) list += (list.empty() ? "" : ",") + std::to_string(node);
        return file_.node(list.empty() ? text : text + ",\"children\":[" + list + "]");
    }

    bool addPart(const ExportPart& part) {
        const auto groups =
            groupedByColour(part.instances, part.kind == ESP_PART_LEAF ? kMostColours : kMostTileColours);
        int number = 0;
        for (const ColourGroup& group : groups) {
            ++number;
            const std::string name = part.name + (number > 1 ? "_" + std::to_string(number) : "");
            const std::vector<size_t> meshes = meshes_.meshes(part, group.colour, name);
            written_.instances += group.instances.size();
            written_.triangles += group.instances.size() * (part.levels.front().indices.size() / 3);
            const bool alone = part.kind == ESP_PART_STEMS || part.kind == ESP_PART_HOUSE;
            if (options_.instancing && !alone)
                addInstanced(part, group, meshes, name);
            else if (!addNodes(part, group, meshes, alone ? name : ""))
                return false;
        }
        return true;
    }
    // A node each. name: of nodes that stand alone; what stands many times is told by its mesh's name.
    bool addNodes(const ExportPart& part, const ColourGroup& group, const std::vector<size_t>& meshes,
                  const std::string& name) {
        for (uint32_t i : group.instances) {
            if (done_++ % kStep == 0 && !goOn_(float(double(done_) / double(total_)))) return false;
            const EspPartInstance& instance = part.instances[i];
            const std::string place = placeText(instance.place);
            groupOf(part, &instance).children.push_back(addLevels(part, meshes, name, place));
        }
        return true;
    }
    // extra: what the nodes of all levels say. The finest level's node.
    size_t addLevels(const ExportPart& part, const std::vector<size_t>& meshes, const std::string& name,
                     const std::string& place, const std::string& instancing = "") {
        const auto textOfLevel = [&](size_t level) {
            std::string text = "\"mesh\":" + std::to_string(meshes[level]);
            if (!name.empty()) appendText(text, "name", name + "_LOD" + std::to_string(level));
            if (!place.empty()) text += "," + place;
            return text;
        };
        const auto extensions = [](const std::string& inside) {
            return inside.empty() ? "" : ",\"extensions\":{" + inside + "}";
        };
        std::string ids;
        for (size_t level = 1; level < meshes.size(); ++level)
            ids += (level > 1 ? "," : "") + std::to_string(file_.node(textOfLevel(level) + extensions(instancing)));
        std::string inside = instancing, coverage;
        if (!ids.empty()) {
            file_.use("MSFT_lod", false);
            inside += (inside.empty() ? "" : ",") + ("\"MSFT_lod\":{\"ids\":[" + ids + "]}");
            coverage = ",\"extras\":{\"MSFT_screencoverage\":[" + coveragesOf(part) + "]}";
        }
        return file_.node(textOfLevel(0) + extensions(inside) + coverage);
    }
    // The share of a picture below which the next level does: where its error is a pixel.
    std::string coveragesOf(const ExportPart& part) const {
        glm::vec3 low(1e30f), high(-1e30f);
        for (const EspPartVertex& v : part.levels.front().vertices) {
            const glm::vec3 p(v.position[0], v.position[1], v.position[2]);
            low = glm::min(low, p), high = glm::max(high, p);
        }
        std::string text;
        for (size_t level = 1; level <= part.levels.size(); ++level) {
            float share = 0;
            if (level < part.levels.size()) {
                const float side = glm::length(high - low) / std::max(part.levels[level].error, 1e-9f) / kPicturePixels;
                share = std::min(side * side, 1.0f);
                text.append(level > 1 ? "," : "");
            } else {
                text += ',';
            }
            appendNumber(text, share, 6);
        }
        return text;
    }
    void addInstanced(const ExportPart& part, const ColourGroup& group, const std::vector<size_t>& meshes,
                      const std::string& name) {
        file_.use("EXT_mesh_gpu_instancing", true);
        std::vector<std::array<float, 3>> moves, scales;
        std::vector<std::array<int16_t, 4>> turns;
        std::vector<std::array<uint16_t, 2>> winds;
        for (uint32_t i : group.instances) {
            const EspPartInstance& instance = part.instances[i];
            const Placing p = placingOf(instance.place);
            moves.push_back({p.move.x, p.move.y, p.move.z});
            scales.push_back({p.scale.x, p.scale.y, p.scale.z});
            const auto snorm = [](float x) { return int16_t(std::lround(std::clamp(x, -1.0f, 1.0f) * 32767)); };
            turns.push_back({snorm(p.turn.x), snorm(p.turn.y), snorm(p.turn.z), snorm(p.turn.w)});
            const auto unorm = [](float x) { return uint16_t(std::lround(std::clamp(x, 0.0f, 1.0f) * 65535)); };
            winds.push_back({unorm(instance.wind), unorm(instance.age)});
        }
        const auto add = [&](const char* attribute, size_t accessor) {
            return "\"" + std::string(attribute) + "\":" + std::to_string(accessor);
        };
        std::string attributes =
            add("TRANSLATION", file_.accessor(moves, GltfFile::kFloat, "VEC3", false, GltfFile::kOther)) + "," +
            add("ROTATION", file_.accessor(turns, GltfFile::kShort, "VEC4", true, GltfFile::kOther)) + "," +
            add("SCALE", file_.accessor(scales, GltfFile::kFloat, "VEC3", false, GltfFile::kOther));
        if (part.kind == ESP_PART_LEAF && options_.wind != WindChannel::none)
            attributes += "," + add("_WIND", file_.accessor(winds, GltfFile::kUshort, "VEC2", true, GltfFile::kOther));
        groupOf(part, nullptr)
            .children.push_back(
                addLevels(part, meshes, name, "", "\"EXT_mesh_gpu_instancing\":{\"attributes\":{" + attributes + "}}"));
    }

    const Gathered& gathered_;
    const Options& options_;
    const std::function<bool(float)>& goOn_;
    GltfFile file_;
    MeshWriter meshes_;
    std::map<std::string, std::map<uint32_t, Group>> groups_;  // by kind and owner
    size_t total_ = 0, done_ = 0;
    Written written_;
};

}  // namespace

bool encode(const Gathered& gathered, const Options& options, const std::function<bool(float)>& goOn,
            std::string& bytes, Written& written, std::string& error) {
    return Encoder(gathered, options, goOn).run(bytes, written, error);
}

}  // namespace espalier::exporting
