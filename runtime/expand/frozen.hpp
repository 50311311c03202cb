#pragma once

// Frozen plants: plants that stand as they have grown, whatever becomes of the inputs. A frozen plant is its records;
// its seed isn't among GrowthInputs::seeds any more.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "runtime/core/result.hpp"
#include "shaders/shared/growth_records.h"

namespace espalier {

// A growth's records on the CPU.
struct GrowthRecords {
    std::vector<Node> nodes;
    std::vector<Chunk> chunks;
    std::vector<BranchRecord> branches;
    std::vector<Leaf> leaves;
};

// Records of one plant alone: without gaps, indices among themselves, its seed has index 0.
using PlantRecords = GrowthRecords;

struct FrozenPlant {
    uint64_t key = 0;  // of its seed; unlike those of all other seeds and frozen plants
    // As Growth::read() gave them. Compared by address: other records are another plant.
    std::shared_ptr<const PlantRecords> records;
};

// The plant of seed `seed` out of a growth's records (as Growth::read() gives them).
PlantRecords plantOf(const GrowthRecords& growth, uint32_t seed);

// Indices as they are behind that many other records; those of seeds stay.
void shiftRecords(GrowthRecords& records, uint32_t nodes, uint32_t chunks, uint32_t branches);

// What frozen plants are together, to begin a growth with. Seeds have the indices from firstSeed on.
struct FrozenSum {
    GrowthRecords records;
    uint32_t hash[2] = {};  // their share of the structure's hash
    uint32_t steps = 0, inserted = 0, stopped = 0, deadEnds = 0;
};
FrozenSum sumOf(std::span<const FrozenPlant> plants, uint32_t firstSeed);

// A plant as bytes of a file, and back. Of hostile bytes, what isn't a plant on surface instances below `surfaces` is
// refused.
std::vector<std::byte> packPlant(const PlantRecords& plant);
Result<PlantRecords> unpackPlant(std::span<const std::byte> bytes, uint32_t surfaces);

}  // namespace espalier
