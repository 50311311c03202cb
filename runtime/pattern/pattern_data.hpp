#pragma once

// What patterns are derived from and what they leave (Li 2011); records are in shaders/shared/pattern_records.h.

#include <span>
#include <vector>

#include "runtime/core/result.hpp"
#include "shaders/shared/pattern_records.h"

namespace espalier {

// The triangles by which meshes meet each other.
struct PieceMeshes {
    std::vector<PatternMesh> meshes;  // by PatternPart::mesh
    std::vector<vec4> clusters;
    std::vector<vec3> corners;

    // Triangles of a mesh: three corners each. They are sorted so that neighbours share a cluster. A mesh whose every
    // edge two triangles share has an inside.
    void add(std::span<const glm::vec3> positions, std::span<const uint32_t> indices);
};

struct PatternLimits {
    uint32_t maxPieces = 4'000'000;  // tried, all in all
    uint32_t maxShapes = 200'000;    // symbols derived, and as many more as shapesPerSet says
    uint32_t shapesPerSet = 100;     // for each set that stands
    uint32_t maxWaiting = 500'000;   // symbols at once
    uint32_t maxDepth = 4096;        // productions one behind the other
};

// Addresses are those of the CPU that grows the pattern, or of the device that does.
struct PatternInputs {
    SurfaceBuf surfaces{};
    uint32_t surfaceCount = 0;
    LayerBuf layers{};                     // surfaceCount * kMaxLayers
    std::span<const RuleMapRef> grammars;  // of patterns; at least one
    FieldBuf fields{};                     // as PatternEnv::fields
    std::span<const Seed> seeds;           // grammar: index into `grammars`
    const PieceMeshes* meshes = nullptr;
    PatternLimits limits;
};

struct PatternStats {
    uint64_t hash = 0;  // of what stands, whatever the order it was found in
    uint32_t shapes = 0, tried = 0, standing = 0, fallen = 0;
    uint32_t ended = 0, deep = 0;  // symbols at the surface's end; beyond maxDepth
    uint32_t waves = 0, rounds = 0;
    uint32_t pieces = 0;  // that stand
    double ms = 0;
};

struct GrownPattern {
    std::vector<PatternPiece> pieces;  // that stand, by mesh and then by key; `set` and `next` have no meaning
    PatternStats stats;
};

// Waits for the result. Fails where a limit is reached, and says which.
Result<GrownPattern> growPatternsOnCpu(const PatternInputs& inputs, unsigned threads = 0);

}  // namespace espalier
