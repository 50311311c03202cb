// Whether two maps are the same to growth, or to those parts of it that a text has changed.
#include <algorithm>
#include <cstring>

#include "runtime/grammar/rule_map_layout.hpp"

namespace espalier {
namespace {

bool sameParam(const ParamInfo& a, const ParamInfo& b) {
    return a.name == b.name && a.kind == b.kind && a.minimum == b.minimum && a.maximum == b.maximum && a.slot == b.slot;
}
bool sameContext(const ContextInfo& a, const ContextInfo& b) {
    return a.name == b.name && a.fill == b.fill;
}
bool sameSymbol(const SymbolInfo& a, const SymbolInfo& b) {
    return a.name == b.name && a.argCount == b.argCount && a.grows == b.grows;
}

// What a map's words say of branches and nodes: records, and the code and sites that they name in place of where these
// lie, since texts that draw something else on spans put them elsewhere.
class Derivation {
  public:
    explicit Derivation(const RuleMap& map) : map_(map) {
        for (uint32_t i = 0; i < RuleMapAccess::count(map, kSectionSymbols); ++i) {
            auto r = RuleMapAccess::record<SymbolRecord>(map, kSectionSymbols, i);
            add(r.select);
            addSites(r.firstSite, r.siteCount);
            add(r);
        }
        for (uint32_t i = 0; i < RuleMapAccess::count(map, kSectionRules); ++i) {
            auto r = RuleMapAccess::record<RuleRecord>(map, kSectionRules, i);
            add(r.start);
            add(r.arrive);
            addSites(r.firstSite, r.siteCount);
            add(r);
        }
        for (uint32_t i = 0; i < RuleMapAccess::count(map, kSectionSuccessors); ++i) {
            auto r = RuleMapAccess::record<SuccessorRecord>(map, kSectionSuccessors, i);
            add(r.code);
            add(r);
        }
        for (uint32_t i = 0; i < RuleMapAccess::count(map, kSectionDirections); ++i)
            add(RuleMapAccess::record<vec4>(map, kSectionDirections, i));
        // Nodes tell programs apart by their numbers, and what these draw by their names' keys.
        for (uint32_t i = 0; i < RuleMapAccess::count(map, kSectionExtrudes); ++i)
            add(RuleMapAccess::record<ExtrudeRecord>(map, kSectionExtrudes, i).nameHash);
    }
    bool operator==(const Derivation& other) const { return words_ == other.words_; }

  private:
    template <class Record>
    void add(const Record& record) {
        const size_t at = words_.size();
        words_.resize(at + sizeof(Record) / 4);
        std::memcpy(&words_[at], &record, sizeof(Record));
    }
    void add(CodeRange& range) {
        for (uint32_t i = 0; i < range.count; ++i)
            add(RuleMapAccess::record<CodeWord>(map_, kSectionCode, range.first + i));
        range.first = 0;
    }
    void addSites(uint32_t& first, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) add(RuleMapAccess::record<uint32_t>(map_, kSectionSites, first + i));
        first = 0;
    }

    const RuleMap& map_;
    std::vector<uint32_t> words_;
};

}  // namespace

bool RuleMap::growsAs(const RuleMap& other) const {
    const auto sameBytes = [](const auto& a, const auto& b) {
        return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
    };
    const auto sameSection = [](Section a, Section b) { return a.offset == b.offset && a.count == b.count; };
    return startSymbol_ == other.startSymbol_ && roofs_ == other.roofs_ && widthUniform_ == other.widthUniform_ &&
           width_ == other.width_ && std::ranges::equal(params_, other.params_, sameParam) &&
           std::ranges::equal(contexts_, other.contexts_, sameContext) &&
           std::ranges::equal(symbols_, other.symbols_, sameSymbol) &&
           std::ranges::equal(sections_, other.sections_, sameSection) && sameBytes(words_, other.words_) &&
           sameBytes(uniformCode_, other.uniformCode_) && sameBytes(uniforms_, other.uniforms_) &&
           sameBytes(patches_, other.patches_);
}

bool RuleMap::derivesAs(const RuleMap& other) const {
    const auto sameValues = [](const ParamInfo& a, const ParamInfo& b) {
        return sameParam(a, b) && std::equal(std::begin(a.value), std::end(a.value), std::begin(b.value));
    };
    return !roofs_ && !other.roofs_ && startSymbol_ == other.startSymbol_ && width_ == other.width_ &&
           ref().features == other.ref().features && std::ranges::equal(params_, other.params_, sameValues) &&
           std::ranges::equal(contexts_, other.contexts_, sameContext) &&
           std::ranges::equal(symbols_, other.symbols_, sameSymbol) && Derivation(*this) == Derivation(other);
}

}  // namespace espalier
