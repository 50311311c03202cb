#pragma once

#include "runtime/grammar/compilation.hpp"

// The layout of RuleMap's words, shared by assembly, evaluation, saving and loading.
namespace espalier {

enum MapSection : uint32_t {
    kSectionSymbols,
    kSectionRules,
    kSectionSuccessors,
    kSectionExtrudes,
    kSectionTerminals,
    kSectionCode,
    kSectionSites,
    kSectionDirections,
    kSectionValues,
    kSectionParts,
    kSectionOps,
    kSectionQueries
};
inline constexpr uint32_t kRecordWords[] = {sizeof(SymbolRecord) / 4,
                                            sizeof(RuleRecord) / 4,
                                            sizeof(SuccessorRecord) / 4,
                                            sizeof(ExtrudeRecord) / 4,
                                            sizeof(TerminalRecord) / 4,
                                            sizeof(CodeWord) / 4,
                                            1,
                                            sizeof(vec4) / 4,
                                            sizeof(Value) / 4,
                                            sizeof(PatternPart) / 4,
                                            sizeof(PatternOp) / 4,
                                            1};

// Where in a record of that section Values stand (in words); a code word's immediate is patched too, but is none.
std::span<const uint32_t> valueOffsets(uint32_t section);

// What a chunk that derived the symbol notes in Chunk::uses, of a grammar whose parameters take so many slots: the bits
// that these leave are given from the highest down, and over again. 0: they leave none.
inline uint32_t symbolBit(uint32_t symbol, uint32_t slots) {
    return slots < 32 ? 1u << (31 - symbol % (32 - slots)) : 0;
}

// True if the symbol's only rule is a terminal that leaves its shape as it is. values: the rule's kScopeValues numbers.
inline bool isPlainTerminal(const SymbolRecord& symbol, const RuleRecord& rule, std::span<const Value> values) {
    if (symbol.ruleCount != 1 || symbol.select.count != 0 || symbol.selected.slot != kSlotImmediate) return false;
    if (rule.kind != kRuleShape || rule.start.count != 0) return false;
    for (uint32_t i = 0; i < kScopeValues; ++i) {
        const bool change = i >= 3 && i < 8;  // T and R: by how much; the others: negative leaves what there is
        if (values[i].slot != kSlotImmediate) return false;
        if (change ? values[i].immediate != 0 : values[i].immediate >= 0) return false;
    }
    return true;
}

struct RuleMapAccess {
    using Section = RuleMap::Section;
    using Uniform = RuleMap::Uniform;
    using Patch = RuleMap::Patch;
    static constexpr uint32_t kSections = RuleMap::kSections;

    // What compiling left, as a map; to be verified before use.
    static RuleMap assemble(grammar::Compilation& c, uint64_t contentHash);
    // Runs the uniform code for the parameters' values and patches the words.
    static void evaluate(RuleMap& map);
    // Empty, or what is wrong: every index, range and operation is checked.
    static std::string verify(const RuleMap& map);
    // Whether every mesh that it draws is one of those that a text is compiled with, which its file doesn't tell.
    static bool meshesWithin(const RuleMap& map, const CompileOptions& options);

    template <class T>
    static T record(const RuleMap& map, uint32_t section, uint32_t index) {
        T r;
        std::memcpy(static_cast<void*>(&r), &map.words_[map.sections_[section].offset + index * kRecordWords[section]],
                    sizeof(T));
        return r;
    }
    static uint32_t count(const RuleMap& map, uint32_t section) { return map.sections_[section].count; }
    // Slots that its parameters take.
    static uint32_t slotsOf(const RuleMap& map) {
        return map.params_.empty() ? 0 : map.params_.back().slot + numbersOf(map.params_.back());
    }
    static std::vector<Diagnostic>& warnings(RuleMap& map) { return map.warnings_; }
};

}  // namespace espalier
