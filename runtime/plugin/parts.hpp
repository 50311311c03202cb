#pragma once

// What stands, as parts (espalier_parts.h): gathered on the CPU from records.

#include <cstdint>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/core/result.hpp"
#include "runtime/emit/terminals.hpp"

struct EspContext;

namespace espalier {

struct PartLevel {
    std::vector<EspPartVertex> vertices;
    std::vector<uint32_t> indices;
    float error = 0;
};

struct Part {
    EspPartKind kind = ESP_PART_STEMS;
    std::string name;
    uint32_t material = 0;
    std::vector<PartLevel> levels;  // finest first
    std::vector<EspPartInstance> instances;
    EspSeed seed{};
    uint32_t house = 0;
};

struct StandingParts {
    std::vector<Part> parts;
    std::vector<TerminalMaterial> materials;  // pictures: indices into `pictures`
    std::vector<TerminalPicture> pictures;
    std::vector<bool> twoSided;  // [material]
};

// Adds to what there is.
class PartsWriter {
  public:
    explicit PartsWriter(const EspPartsDef& def) : def_(def) {}

    bool wants(EspPartKind kind) const { return (def_.kinds >> kind & 1u) != 0; }
    const EspPartsDef& def() const { return def_; }
    // The number of a file's material here; the same for each time that it is asked for.
    uint32_t material(const TerminalData& data, uint32_t material, bool twoSided);
    // A part of its own mesh, which stands once and as its vertices say.
    Part& single(EspPartKind kind, const std::string& name, uint32_t material);
    // The part that stands for a variant of a file's meshes, without instances; its number.
    uint32_t variant(EspPartKind kind, const std::string& name, const TerminalData& data,
                     const TerminalVariant& variant, bool twoSided);
    Part& part(uint32_t number) { return out_.parts[number]; }
    // Without parts that stand nowhere, and with second UVs where these are missing.
    StandingParts finish();

  private:
    int picture(const TerminalData& data, int number);
    std::string unlikeOthers(const std::string& name) const;

    EspPartsDef def_;
    StandingParts out_;
    struct Known {
        const TerminalData* data;
        uint32_t of, number;
    };
    std::vector<Known> known_, knownPictures_;
};

// Gives all vertices a place in [0, 1] of their own, splitting those where sides meet: each piece that looks along one
// axis is laid flat, and apart where it would lie on itself. textured false: `uv` becomes the same in metres.
void unwrap(PartLevel& level, bool textured);

// What lies beside each other: sizes to places, and the size of all.
struct Packing {
    std::vector<glm::vec2> places;
    glm::vec2 size{1};
};
Packing packed(const std::vector<glm::vec2>& sizes);

EspResult gatherPlants(EspContext& context, PartsWriter& out);
EspResult gatherTown(EspContext& context, PartsWriter& out);
void gatherPieces(EspContext& context, PartsWriter& out);

}  // namespace espalier
