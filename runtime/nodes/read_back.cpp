// What nodes have made, as hosts and tests want it: without the padding between rows.
#include <bit>
#include <cstring>

#include "runtime/nodes/read_back.hpp"

namespace espalier {
namespace {

uint32_t placeOf(const GeometryPart& part, uint32_t element) {
    return element / part.used * part.row + element % part.used;
}

Result<std::vector<uint32_t>> words(NodeMachine& machine, const NodeBlock& block, uint64_t count) {
    Result<std::vector<std::byte>> bytes = machine.read(block, count * sizeof(uint32_t));
    if (!bytes) return bytes.failure();
    std::vector<uint32_t> words(count);
    if (count > 0) std::memcpy(words.data(), bytes->data(), bytes->size());
    return words;
}

}  // namespace

Result<std::vector<glm::vec3>> readPlaces(NodeMachine& machine, const GeometryPart& part) {
    const uint32_t stride = part.positions.stride;
    Result<std::vector<uint32_t>> planes = words(machine, *part.positionBlock, uint64_t(stride) * 3);
    if (!planes) return planes.failure();
    std::vector<glm::vec3> out(part.elements);
    for (uint32_t i = 0; i < part.elements; ++i)
        for (uint32_t axis = 0; axis < 3; ++axis)
            out[i][int(axis)] = std::bit_cast<float>((*planes)[size_t(axis) * stride + placeOf(part, i)]);
    return out;
}

Result<std::vector<uint32_t>> readWords(NodeMachine& machine, const GeometryPart& part, const BlockRef& block) {
    if (!block) return std::vector<uint32_t>();
    Result<std::vector<uint32_t>> all = words(machine, *block, part.positions.count);
    if (!all) return all;
    std::vector<uint32_t> out(part.elements);
    for (uint32_t i = 0; i < part.elements; ++i) out[i] = (*all)[placeOf(part, i)];
    return out;
}

Result<std::vector<uint32_t>> readCorners(NodeMachine& machine, const GeometryPart& part) {
    if (!part.indices) return std::vector<uint32_t>();
    Result<std::vector<uint32_t>> all = words(machine, *part.indices, part.indexCount);
    if (!all) return all;
    for (uint32_t& corner : *all) corner = corner / part.row * part.used + corner % part.row;
    return all;
}

}  // namespace espalier
