// In: pieces of patterns as they are drawn. Out: the same, mesh by mesh.
#include <map>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

constexpr glm::vec3 kPlain(.42f, .39f, .33f);  // of pieces without a colour or a picture, as piece.vert draws them

glm::vec3 colourOf(const PatternPiece& piece, bool textured) {
    if (piece.colour == kNoIndex) return textured ? glm::vec3(1) : kPlain;
    return glm::vec3(piece.colour >> 20 & 1023u, piece.colour >> 10 & 1023u, piece.colour & 1023u) / 1023.0f;
}

}  // namespace

void gatherPieces(EspContext& context, PartsWriter& out) {
    const PieceDraw* drawn = context.renderer->pieces();
    if (!out.wants(ESP_PART_PIECE) || !drawn) return;
    const TerminalData& meshes = drawn->meshes();
    std::map<const TerminalVariant*, uint32_t> partOf;
    for (const PatternPiece& piece : drawn->pieces()) {
        const TerminalVariant* mesh = drawn->meshOf(piece);
        if (!mesh) continue;
        const auto [known, added] = partOf.try_emplace(mesh, 0);
        if (added) known->second = out.variant(ESP_PART_PIECE, "piece_" + mesh->name, meshes, *mesh, true);
        EspPartInstance instance{};
        const glm::vec3 columns[] = {piece.x, piece.y, piece.z, piece.position};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) instance.place.rows[row][column] = columns[column][row];
        put(instance.colour, colourOf(piece, meshes.materials[mesh->lods.front().material].baseColorPicture >= 0));
        out.part(known->second).instances.push_back(instance);
    }
}

}  // namespace espalier
