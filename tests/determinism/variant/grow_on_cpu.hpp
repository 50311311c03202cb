#pragma once

// The CPU reference on fixed inputs, told in one line; in all variants and in the test itself.

#include <cstdio>

#include "runtime/expand/cpu_growth.hpp"
#include "tests/determinism/fixed_inputs.hpp"

namespace espalier::determinismtest {

template <class T>
uint64_t hashRecords(const std::vector<T>& records, uint64_t hash) {
    const unsigned char* at = reinterpret_cast<const unsigned char*>(records.data());
    for (size_t i = 0; i < records.size() * sizeof(T); ++i) hash = (hash ^ at[i]) * 1099511628211ull;
    return hash;
}

// "HASH BYTES nodes N branches N leaves N": the canonical hash and one of every bit of the records. Empty: failed.
inline std::string grownOnCpu(FixedInputs& in) {
    SurfaceRef surface = surfaceAt(in, [](auto& values) { return reinterpret_cast<uint64_t>(values.data()); });
    std::vector<LayerRef> layers(kMaxLayers, LayerRef{{nullptr}, 0, 1});
    std::vector<RuleMapRef> grammars;
    for (FixedGrammar& g : in.grammars) grammars.push_back(grammarAt(g, reinterpret_cast<uint64_t>(g.words.data())));
    GrowthInputs inputs;
    inputs.surfaces = {&surface};
    inputs.surfaceCount = 1;
    inputs.layers = {layers.data()};
    inputs.grammars = grammars;
    inputs.seeds = in.seeds;
    inputs.limits.maxNodes = kMostNodes;
    Result<CpuGrowth> grown = growOnCpu(inputs);
    if (!grown) {
        std::fprintf(stderr, "%s\n", grown.failure().text().c_str());
        return "";
    }
    uint64_t bytes = hashRecords(grown->nodes, 14695981039346656037ull);
    bytes = hashRecords(grown->branches, bytes);
    bytes = hashRecords(grown->leaves, bytes);
    char line[160];
    std::snprintf(line, sizeof line, "%016llx %016llx nodes %zu branches %zu leaves %zu",
                  static_cast<unsigned long long>(grown->stats.hash), static_cast<unsigned long long>(bytes),
                  grown->nodes.size(), grown->branches.size(), grown->leaves.size());
    return line;
}

}  // namespace espalier::determinismtest
