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
bool sameField(const FieldInfo& a, const FieldInfo& b) {
    return a.name == b.name && a.symmetry == b.symmetry && a.curvature == b.curvature && a.jumps == b.jumps;
}
bool sameSymbol(const SymbolInfo& a, const SymbolInfo& b) {
    return a.name == b.name && a.argCount == b.argCount && a.grows == b.grows;
}

// What a map's words say of one of its parts: records, and the code and sites that they name in place of where these
// lie, since any change of a text puts them elsewhere. All else that they name goes by its number, as it does where
// plants have grown: a part that says the same in two maps means the same to what has used it.
class Part {
  public:
    static Part symbol(const RuleMap& map, uint32_t i) {
        Part part(map);
        part.addSymbol(RuleMapAccess::record<SymbolRecord>(map, kSectionSymbols, i));
        return part;
    }
    static Part extrude(const RuleMap& map, uint32_t i) {
        Part part(map);
        part.addExtrude(RuleMapAccess::record<ExtrudeRecord>(map, kSectionExtrudes, i));
        return part;
    }
    bool operator==(const Part& other) const { return words_ == other.words_; }

  private:
    explicit Part(const RuleMap& map) : map_(map) {}

    void addSymbol(SymbolRecord r) {
        add(r.select);
        addSites(r.firstSite, r.siteCount);
        for (uint32_t i = 0; i < r.ruleCount; ++i)
            addRule(RuleMapAccess::record<RuleRecord>(map_, kSectionRules, r.firstRule + i));
        r.firstRule = 0;
        add(r);
    }
    void addRule(RuleRecord r) {
        add(r.start);
        add(r.arrive);
        addSites(r.firstSite, r.siteCount);
        for (uint32_t i = 0; i < r.successorCount; ++i) {
            auto s = RuleMapAccess::record<SuccessorRecord>(map_, kSectionSuccessors, r.firstSuccessor + i);
            add(s.code);
            add(s);
        }
        r.firstSuccessor = 0;
        // What a program draws goes by its name's key, too.
        if (r.extrude != 0) add(RuleMapAccess::record<ExtrudeRecord>(map_, kSectionExtrudes, r.extrude - 1).nameHash);
        add(r);
    }
    void addExtrude(ExtrudeRecord r) {
        for (uint32_t i = 0; i < r.terminalCount; ++i) {
            auto t = RuleMapAccess::record<TerminalRecord>(map_, kSectionTerminals, r.firstTerminal + i);
            add(t.gate);
            add(t.body);
            addSites(t.gateFirstSite, t.gateSiteCount);
            addSites(t.bodyFirstSite, t.bodySiteCount);
            add(t);
        }
        r.firstTerminal = 0;
        add(r);
    }
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

bool sameDirections(const RuleMap& a, const RuleMap& b) {
    const uint32_t common =
        std::min(RuleMapAccess::count(a, kSectionDirections), RuleMapAccess::count(b, kSectionDirections));
    for (uint32_t i = 0; i < common; ++i)
        if (RuleMapAccess::record<vec4>(a, kSectionDirections, i) !=
            RuleMapAccess::record<vec4>(b, kSectionDirections, i))
            return false;
    return true;
}

}  // namespace

bool RuleMap::growsAs(const RuleMap& other) const {
    const auto sameBytes = [](const auto& a, const auto& b) {
        return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
    };
    const auto sameSection = [](Section a, Section b) { return a.offset == b.offset && a.count == b.count; };
    return startSymbol_ == other.startSymbol_ && kind_ == other.kind_ &&
           std::ranges::equal(fields_, other.fields_, sameField) && width_ == other.width_ && avoid_ == other.avoid_ &&
           std::ranges::equal(params_, other.params_, sameParam) &&
           std::ranges::equal(contexts_, other.contexts_, sameContext) &&
           std::ranges::equal(symbols_, other.symbols_, sameSymbol) &&
           std::ranges::equal(sections_, other.sections_, sameSection) && sameBytes(words_, other.words_) &&
           sameBytes(uniformCode_, other.uniformCode_) && sameBytes(uniforms_, other.uniforms_) &&
           sameBytes(patches_, other.patches_);
}

RuleChanges RuleMap::changesFrom(const RuleMap& before) const {
    const size_t layers = std::min(contexts_.size(), before.contexts_.size());
    if (kind_ != GrammarKind::plants || before.kind_ != GrammarKind::plants || !sameDirections(*this, before) ||
        !std::equal(contexts_.begin(), contexts_.begin() + std::ptrdiff_t(layers), before.contexts_.begin(),
                    sameContext))
        return {.all = true};
    RuleChanges changes;
    const auto count = [](const RuleMap& map, MapSection section) { return RuleMapAccess::count(map, section); };
    const uint32_t slots = RuleMapAccess::slotsOf(before);
    for (uint32_t i = 0; i < count(before, kSectionSymbols); ++i) {
        if (i < count(*this, kSectionSymbols) && Part::symbol(*this, i) == Part::symbol(before, i)) continue;
        const uint32_t bit = symbolBit(i, slots);
        changes.all = changes.all || bit == 0;
        changes.uses |= bit;
    }
    const uint32_t programs = std::min(count(*this, kSectionExtrudes), count(before, kSectionExtrudes));
    // Chunks have noted the layers of the text by which they grew, which may be older than `before`: that a program
    // read a layer then and in every text since is all that is known of them.
    const auto layersOf = [&](const RuleMap& map, uint32_t i) {
        return RuleMapAccess::record<ExtrudeRecord>(map, kSectionExtrudes, i).layers;
    };
    for (uint32_t i = 0; i < programs; ++i) {
        if (Part::extrude(*this, i) == Part::extrude(before, i)) continue;
        changes.extrudes = true;
        changes.all = changes.all || (layersOf(*this, i) & ~layersOf(before, i)) != 0;
    }
    return changes;
}

}  // namespace espalier
