// Verification of a rule map: after it, nothing the interpreter or the expander does with the map leaves a buffer,
// and no chain of List rules is endless. Also run on what the compiler made.
#include <algorithm>
#include <cmath>

#include "runtime/grammar/rule_map_layout.hpp"

namespace espalier {
namespace {

bool inRange(uint32_t first, uint32_t count, size_t size) {
    return first <= size && count <= size - first;
}
bool sane(float x) {
    return std::isfinite(x) && std::fabs(x) <= 1e18f;
}
bool readable(uint32_t slot) {
    return slot < kMachineSlots || slot == kSlotImmediate;
}

class Verifier {
  public:
    explicit Verifier(const RuleMap& map) : map_(map) {
        for (uint32_t s = 0; s < RuleMapAccess::kSections; ++s) counts_[s] = RuleMapAccess::count(map, s);
    }

    std::string run() {
        for (uint32_t i = 0; i < counts_[kSectionCode] && ok(); ++i) codeWord(get<CodeWord>(kSectionCode, i));
        for (uint32_t i = 0; i < counts_[kSectionSymbols] && ok(); ++i) symbol(i);
        for (uint32_t i = 0; i < counts_[kSectionRules] && ok(); ++i) rule(get<RuleRecord>(kSectionRules, i));
        for (uint32_t i = 0; i < counts_[kSectionSuccessors] && ok(); ++i) successor(i);
        for (uint32_t i = 0; i < counts_[kSectionExtrudes] && ok(); ++i) extrude(i);
        for (uint32_t i = 0; i < counts_[kSectionTerminals] && ok(); ++i) terminal(i);
        for (uint32_t i = 0; i < counts_[kSectionDirections] && ok(); ++i) {
            vec4 d = get<vec4>(kSectionDirections, i);
            for (int k = 0; k < 4; ++k) need(std::isfinite(d[k]), "a direction isn't a number");
        }
        // Expansion packs indices into 16 bits, a node the number of its extrude program into 8.
        for (uint32_t count : counts_) need(count <= 0xFFFFu, "section sizes: more than 65,535 records");
        need(counts_[kSectionSymbols] > 0 && counts_[kSectionDirections] <= kMaxDirections &&
                 counts_[kSectionExtrudes] <= kMaxExtrudes,
             "section sizes");
        // Recursion of roofs ends by the expander's limit on depth.
        if (ok() && map_.kind() == GrammarKind::plants) lists();
        for (uint32_t i = 0; i < counts_[kSectionParts] && ok(); ++i) part(get<PatternPart>(kSectionParts, i));
        for (uint32_t i = 0; i < counts_[kSectionOps] && ok(); ++i) op(get<PatternOp>(kSectionOps, i));
        for (uint32_t i = 0; i < counts_[kSectionQueries] && ok(); ++i) query(get<uint32_t>(kSectionQueries, i));
        need(counts_[kSectionQueries] <= kMaxQueries, "too many queries of fields");
        for (uint32_t i = 0; i < counts_[kSectionValues] && ok(); ++i) value(get<Value>(kSectionValues, i));
        return error_;
    }

    void codeWord(const CodeWord& w) {
        bool good = (w.bits & 31u) < kOpCount && (w.bits >> 30u) == 0;
        for (uint32_t shift : {9u, 16u, 23u}) good = good && readable((w.bits >> shift) & 127u);
        need(good && sane(w.immediate), "a code word");
    }
    void value(const Value& v) { need(readable(v.slot) && sane(v.immediate), "a value"); }
    bool ok() const { return error_.empty(); }
    std::string error() const { return error_; }
    void need(bool condition, const char* what) {
        if (!condition && error_.empty()) error_ = what;
    }

  private:
    template <class T>
    T get(uint32_t section, uint32_t i) const {
        return RuleMapAccess::record<T>(map_, section, i);
    }

    void code(const CodeRange& range) {
        need(inRange(range.first, range.count, counts_[kSectionCode]), "a range of code");
    }
    void sites(uint32_t first, uint32_t count) {
        need(count <= kMaxDraws && inRange(first, count, counts_[kSectionSites]), "a range of draws");
    }
    void layers(uint32_t mask) { need((mask >> kMaxLayers) == 0, "a mask of layers"); }

    void symbol(uint32_t i) {
        SymbolRecord s = get<SymbolRecord>(kSectionSymbols, i);
        need(i < map_.symbols().size() && s.argCount == map_.symbols()[i].argCount && s.argCount <= kMaxArgs,
             "a symbol's arguments");
        need(i < map_.symbols().size() && s.nameHash == grammar::nameHash(map_.symbols()[i].name), "a symbol's name");
        need(inRange(s.firstRule, s.ruleCount, counts_[kSectionRules]), "a symbol's rules");
        code(s.select);
        value(s.selected);
        sites(s.firstSite, s.siteCount);
        layers(s.layers);
    }
    void rule(const RuleRecord& r) {
        if (map_.patterns()) return patternRule(r);
        const bool roof = r.kind >= kRuleExtrude;
        need(r.kind <= kRuleShape && (!roof || map_.roofs()) && (!map_.roofs() || r.kind != kRuleMarch),
             "a rule's kind");
        need(r.successorCount <= (r.kind == kRuleMarch ? 1u : kMaxSuccessors) &&
                 inRange(r.firstSuccessor, r.successorCount, counts_[kSectionSuccessors]),
             "a rule's successors");
        if (roof)
            roofRule(r);
        else
            need(r.extrude <= counts_[kSectionExtrudes] && (r.kind != kRuleMarch || r.values <= kMachineSlots),
                 "a rule's extrude program");
        code(r.start);
        code(r.arrive);
        value(r.distance);
        value(r.angle);
        value(r.condition);
        sites(r.firstSite, r.siteCount);
        layers(r.startLayers | r.arriveLayers);
        uint32_t continuing = 0;
        for (uint32_t i = 0; ok() && i < r.successorCount; ++i)
            continuing += get<SuccessorRecord>(kSectionSuccessors, r.firstSuccessor + i).flags & kSuccessorContinues;
        need(continuing <= 1, "a rule with two continuations");
    }
    // A production: what stands behind a set names one of those before it.
    void patternRule(const RuleRecord& r) {
        const uint32_t sets = r.extrude & 0xFFFFu, pieces = r.extrude >> 16;
        need(r.kind == kRulePattern && r.successorCount <= kMaxParts &&
                 inRange(r.firstSuccessor, r.successorCount, counts_[kSectionParts]),
             "a production");
        uint32_t foundPieces = 0, foundSets = 0;
        for (uint32_t i = 0; ok() && i < r.successorCount; ++i) {
            const PatternPart p = get<PatternPart>(kSectionParts, r.firstSuccessor + i);
            need(p.prereq == kNoIndex || (p.prereq & ~kIfFallen) < foundSets, "what a part of a production waits for");
            if (p.kind == kPartSymbol) continue;
            need(p.set == foundSets || (foundSets > 0 && p.set == foundSets - 1), "a set of a production");
            foundSets = std::max(foundSets, p.set + 1);
            ++foundPieces;
        }
        need(foundSets == sets && foundPieces == pieces, "the sets of a production");
    }
    void part(const PatternPart& p) {
        need(p.kind < kPartKinds && inRange(p.firstOp, p.opCount, counts_[kSectionOps]) && p.opCount <= kMaxOps &&
                 p.priority <= kMaxPriority,
             "a part of a production");
        if (p.kind == kPartSymbol) {
            need(p.symbol < counts_[kSectionSymbols], "a part's symbol");
            if (!ok()) return;
            const SymbolRecord target = get<SymbolRecord>(kSectionSymbols, p.symbol);
            need(p.argCount == target.argCount && p.nameHash == target.nameHash, "a part's symbol");
        } else {
            need((p.kind != kPartLine && p.kind != kPartMergedLine) || p.begin < p.opCount, "a segment of a line");
            need(p.mesh < 256 && p.argCount <= kPartArgs, "a piece");
        }
        code(p.code);
        sites(p.firstSite, p.siteCount);
        layers(p.layers);
        for (const Value& v : p.args) value(v);
    }
    void op(const PatternOp& o) {
        need(o.kind < kOpKinds, "a scope command");
        code(o.code);
        sites(o.firstSite, o.siteCount);
        layers(o.layers);
        for (const Value& v : o.values) value(v);
    }
    void query(uint32_t q) {
        need(queryField(q) < map_.fields().size() && queryQuantity(q) < kQuantities, "a query of a field");
    }
    void roofRule(const RuleRecord& r) {
        uint32_t parts = 1, values = 0;
        switch (r.kind) {
            case kRuleExtrude:
                parts = 2;
                values = 1;
                break;
            case kRuleJoin:
                parts = 3;
                values = 7;
                break;
            case kRuleProject:
                values = 6;
                break;
            case kRuleExplode:
                parts = 5;
                break;
            case kRuleSplit:
                parts = values = kMaxSplit;
                break;
            case kRuleRepeat:
                values = 2;
                break;
            case kRuleShape:
                parts = 0;
                need(r.extrude < 256, "a terminal");
                [[fallthrough]];
            case kRuleScope:
                values = kScopeValues;
                break;
            default:
                break;
        }
        need(inRange(r.values, values, counts_[kSectionValues]), "a rule's values");
        need(parts > 0 || r.successorCount == 0, "a terminal's successors");
        for (uint32_t i = 0; ok() && i < r.successorCount; ++i)
            need(get<SuccessorRecord>(kSectionSuccessors, r.firstSuccessor + i).part < parts, "a successor's part");
    }
    bool terminalFlags(uint32_t flags, const SymbolRecord& target) {
        if (!map_.roofs() || target.ruleCount != 1 || target.firstRule >= counts_[kSectionRules]) return false;
        const RuleRecord rule = get<RuleRecord>(kSectionRules, target.firstRule);
        if (rule.params != 0 || !inRange(rule.values, kScopeValues, counts_[kSectionValues])) return false;
        Value values[kScopeValues];
        for (uint32_t i = 0; i < kScopeValues; ++i) values[i] = get<Value>(kSectionValues, rule.values + i);
        return isPlainTerminal(target, rule, values) && flags == (kSuccessorTerminal | rule.extrude << kSuccessorMesh);
    }
    void successor(uint32_t i) {
        SuccessorRecord s = get<SuccessorRecord>(kSectionSuccessors, i);
        need(s.symbol < counts_[kSectionSymbols], "a successor's symbol");
        if (!ok()) return;
        SymbolRecord target = get<SymbolRecord>(kSectionSymbols, s.symbol);
        need(s.argCount == target.argCount && s.nameHash == target.nameHash && s.ordinal < kMaxSuccessors &&
                 (s.flags <= 1 || terminalFlags(s.flags, target)),
             "a successor");
        code(s.code);
        for (const Value& v : s.args) value(v);
    }
    void extrude(uint32_t i) {
        ExtrudeRecord e = get<ExtrudeRecord>(kSectionExtrudes, i);
        need(inRange(e.firstTerminal, e.terminalCount, counts_[kSectionTerminals]) && e.terminalCount <= 64,
             "an extrude program");
        layers(e.layers);
    }
    void terminal(uint32_t i) {
        TerminalRecord t = get<TerminalRecord>(kSectionTerminals, i);
        need(t.mesh < 256 && t.smoothness <= kSmoothC1 && t.flags <= kTerminalBark, "a terminal");
        code(t.gate);
        code(t.body);
        sites(t.gateFirstSite, t.gateSiteCount);
        sites(t.bodyFirstSite, t.bodySiteCount);
        for (const Value& v :
             {t.count, t.size, t.t, t.lift, t.turn, t.pitch, t.tint, t.colour[0], t.colour[1], t.colour[2]})
            value(v);
    }

    // Longest chain of List rules from each symbol, by relaxation; more than the limit means too long or endless.
    void lists() {
        std::vector<uint32_t> height(counts_[kSectionSymbols], 0);
        bool changed = true;
        for (uint32_t round = 0; changed && round <= kMaxListDepth + 1; ++round) {
            changed = false;
            for (uint32_t s = 0; s < counts_[kSectionSymbols]; ++s) {
                SymbolRecord symbol = get<SymbolRecord>(kSectionSymbols, s);
                for (uint32_t r = 0; r < symbol.ruleCount; ++r) {
                    RuleRecord rule = get<RuleRecord>(kSectionRules, symbol.firstRule + r);
                    for (uint32_t i = 0; rule.kind == kRuleList && i < rule.successorCount; ++i) {
                        uint32_t below =
                            height[get<SuccessorRecord>(kSectionSuccessors, rule.firstSuccessor + i).symbol] + 1;
                        changed = changed || below > height[s];
                        height[s] = std::max(height[s], std::min(below, kMaxListDepth + 2));
                    }
                }
            }
        }
        for (uint32_t h : height) need(h <= kMaxListDepth, "a chain of rules that never marches");
    }

    const RuleMap& map_;
    uint32_t counts_[RuleMapAccess::kSections];
    std::string error_;
};

}  // namespace

bool RuleMapAccess::meshesWithin(const RuleMap& map, const CompileOptions& options) {
    for (uint32_t i = 0; i < count(map, kSectionRules); ++i) {
        const RuleRecord rule = record<RuleRecord>(map, kSectionRules, i);
        if (rule.kind == kRuleShape && rule.extrude >= options.meshesOfRoofs().size()) return false;
    }
    for (uint32_t i = 0; i < count(map, kSectionTerminals); ++i)
        if (record<TerminalRecord>(map, kSectionTerminals, i).mesh >= options.meshes.size()) return false;
    for (uint32_t i = 0; i < count(map, kSectionParts); ++i) {
        const PatternPart part = record<PatternPart>(map, kSectionParts, i);
        if (part.kind != kPartSymbol && part.mesh >= options.meshesOfPatterns().size()) return false;
    }
    return true;
}

std::string RuleMapAccess::verify(const RuleMap& map) {
    // One section follows the other: no patch can reach into another's records.
    uint64_t end = 0;
    for (uint32_t s = 0; s < kSections; ++s) {
        const Section& section = map.sections_[s];
        if (section.offset != (end + 3) / 4 * 4) return "the sections' places";
        end = section.offset + uint64_t(section.count) * kRecordWords[s];
        if (end > map.words_.size()) return "a section lies outside the map";
    }
    if (map.startSymbol_ >= map.sections_[kSectionSymbols].count ||
        map.symbols_.size() != map.sections_[kSectionSymbols].count)
        return "the start symbol";
    Verifier v(map);
    for (const CodeWord& w : map.uniformCode_) v.codeWord(w);
    for (const Uniform& u : map.uniforms_) {
        v.need(inRange(u.code.first, u.code.count, map.uniformCode_.size()), "a range of uniform code");
        v.value(u.value);
    }
    // Only immediates are patched.
    std::vector<bool> patchable(map.words_.size(), false);
    for (uint32_t s = 0; s < kSections; ++s)
        for (uint32_t r = 0; r < map.sections_[s].count; ++r) {
            uint32_t at = map.sections_[s].offset + r * kRecordWords[s];
            for (uint32_t offset : valueOffsets(s)) patchable[at + offset + 1] = true;
            if (s == kSectionCode) patchable[at + 1] = true;
            for (uint32_t k = 0; s == kSectionDirections && k < 3; ++k) patchable[at + k] = true;
        }
    for (const Patch& p : map.patches_)
        v.need(p.uniform < map.uniforms_.size() && p.word < patchable.size() && patchable[p.word], "a patch");
    const auto needLength = [&](const FixedLength& length, const char* what) {
        v.need(length.uniform == kNoIndex || length.uniform < map.uniforms_.size(), what);
        v.need(sane(length.value) && length.value >= 0, what);
    };
    needLength(map.width_, "the width");
    needLength(map.avoid_, "the distance to keep");
    uint32_t slots = 0;
    for (const ParamInfo& p : map.params_) {
        v.need(p.kind <= ParamKind::colour && p.slot == slots, "a parameter");
        slots += numbersOf(p);
        v.need(sane(p.minimum) && sane(p.maximum) && p.minimum < p.maximum, "a parameter's range");
        for (int k = 0; k < 3; ++k) v.need(sane(p.standard[k]), "a parameter's default");
    }
    v.need(map.kind_ <= GrammarKind::patterns && map.fields_.size() <= kMaxFields, "the kind of grammar");
    for (const FieldInfo& f : map.fields_) v.need(f.symmetry >= 1 && f.symmetry <= kMaxSymmetry, "a field");
    v.need(slots <= kMaxParams && map.contexts_.size() <= kMaxLayers, "too many parameters or layers");
    for (const ContextInfo& c : map.contexts_) v.need(c.fill >= 0 && c.fill <= 1, "a layer's default");
    return v.ok() ? v.run() : v.error();
}

}  // namespace espalier
