#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/grammar/graph.hpp"

namespace espalier::grammar {

// What depends on parameters alone: code that the host runs with parameter p in machine slot kSlotParam + p, and the
// places in the map that take its result.
inline constexpr uint32_t kSlotParam = kRegisters;
struct UniformRecord {
    CodeRange code;  // in the uniform code, not the map's
    Value value;
};
// In a Value that is under construction: an immediate that uniform `slot - kSlotUniform` fills.
inline constexpr uint32_t kSlotUniform = 0x10000u;

// What a stage reads; filled while its code is made.
struct StageReads {
    std::vector<uint32_t> sites;  // in the order of the draw slots
    uint32_t inputs = 0, layers = 0, params = 0, args = 0;
};

class CodeGenerator {
  public:
    explicit CodeGenerator(Graph& graph) : graph_(graph) {}

    // Makes code that leaves all roots in values that are valid together. sites: shared by the stages of a rule;
    // reads: of this stage. Returns an empty string or what went wrong.
    std::string generate(std::span<const Node> roots, StageReads& sites, StageReads& reads, CodeRange& range,
                         std::span<Value> values);
    // The value that the host works out for what depends on parameters alone. What goes wrong is in `failure`.
    Value uniform(Node node);

    bool roofs = false;                              // to be said before anything is made, as is
    const std::vector<uint32_t>* queries = nullptr;  // of a grammar of patterns: what its slots from kSlotQuery on hold
    std::string failure;                             // the first that went wrong in the uniform code, or empty
    std::vector<CodeWord> code;
    std::vector<std::pair<uint32_t, uint32_t>> codePatches;  // code word, uniform
    std::vector<CodeWord> uniformCode;
    std::vector<UniformRecord> uniforms;
    std::vector<Node> uniformNodes;

  private:
    Graph& graph_;
};

}  // namespace espalier::grammar
