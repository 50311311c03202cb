#pragma once

// A level's records as bytes, without loss. Positions are told by a texel's triangle: its map at the texel's centre is
// what the bake stores, so that nothing is left to quantise, and both sides of a seam follow from the same corners.
// The rest is predicted from the texels to the left and above, and packed by zstd.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier::surface_file {

// Any records in arrays of the right length, even such as a reader would refuse; nothing where lengths don't fit.
std::optional<std::vector<uint8_t>> encodeLevel(const SurfaceLevelData& level,
                                                std::span<const TrianglePlane> triangles);

// Fills the arrays of a level whose size is set; refs: how many crossingRefs it has. Returns what is wrong, or nothing.
// Trusts nothing, allocates what size and refs say. Uses all cores.
std::string decodeLevel(std::span<const std::byte> bytes, std::span<const TrianglePlane> triangles, uint64_t refs,
                        SurfaceLevelData& level);

// Records of one kind, by meshoptimizer's vertex encoding and zstd.
std::vector<uint8_t> encodeRecords(const void* records, size_t count, size_t stride);
bool decodeRecords(std::span<const std::byte> bytes, void* records, size_t count, size_t stride);

}  // namespace espalier::surface_file
