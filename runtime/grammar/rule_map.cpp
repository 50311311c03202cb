// RuleMap: assembling the words, parameters, addresses.
#include <algorithm>
#include <cmath>

#include "runtime/grammar/rule_map_layout.hpp"
#include "shaders/shared/interpreter.h"
#include "shaders/shared/terminal_meshes.h"

namespace espalier {
namespace {

constexpr uint32_t wordOf(size_t bytes) {
    return static_cast<uint32_t>(bytes / 4);
}
constexpr uint32_t kSymbolValues[] = {wordOf(offsetof(SymbolRecord, selected))};
constexpr uint32_t kRuleValues[] = {wordOf(offsetof(RuleRecord, distance)), wordOf(offsetof(RuleRecord, angle)),
                                    wordOf(offsetof(RuleRecord, condition))};
constexpr uint32_t kPlainValue[] = {0};
constexpr uint32_t kArgs = wordOf(offsetof(SuccessorRecord, args));
constexpr uint32_t kSuccessorValues[] = {kArgs, kArgs + 2, kArgs + 4, kArgs + 6};
constexpr uint32_t kSize = wordOf(offsetof(TerminalRecord, size));
constexpr uint32_t kTerminalValues[] = {wordOf(offsetof(TerminalRecord, count)),
                                        kSize,
                                        kSize + 2,
                                        kSize + 4,
                                        kSize + 6,
                                        kSize + 8,
                                        kSize + 10,
                                        kSize + 12,
                                        kSize + 14,
                                        kSize + 16};

constexpr uint32_t kPartFirst = wordOf(offsetof(PatternPart, args));
constexpr uint32_t kPartValues[] = {kPartFirst, kPartFirst + 2, kPartFirst + 4, kPartFirst + 6, kPartFirst + 8};
constexpr uint32_t kOpFirst = wordOf(offsetof(PatternOp, values));
constexpr uint32_t kOpValues[] = {kOpFirst, kOpFirst + 2, kOpFirst + 4};

template <class T>
void append(std::vector<uint32_t>& words, RuleMapAccess::Section& section, const std::vector<T>& records) {
    while (words.size() % 4 != 0) words.push_back(0);
    section.offset = static_cast<uint32_t>(words.size());
    section.count = static_cast<uint32_t>(records.size());
    size_t n = records.size() * sizeof(T) / 4;
    words.resize(words.size() + n);
    if (n > 0) std::memcpy(&words[section.offset], static_cast<const void*>(records.data()), n * 4);
}

}  // namespace

std::span<const uint32_t> valueOffsets(uint32_t section) {
    switch (section) {
        case kSectionSymbols:
            return kSymbolValues;
        case kSectionRules:
            return kRuleValues;
        case kSectionSuccessors:
            return kSuccessorValues;
        case kSectionTerminals:
            return kTerminalValues;
        case kSectionValues:
            return kPlainValue;
        case kSectionParts:
            return kPartValues;
        case kSectionOps:
            return kOpValues;
        default:
            return {};
    }
}

RuleMap RuleMapAccess::assemble(grammar::Compilation& c, uint64_t contentHash) {
    RuleMap map;
    map.contentHash_ = contentHash;
    map.startSymbol_ = c.startSymbol;
    map.kind_ = c.kind;
    map.fields_ = c.expressions.fields;
    map.params_ = c.expressions.params;
    map.contexts_ = c.expressions.contexts;
    for (const grammar::Symbol& s : c.symbols)
        if (s.grows) map.symbols_.push_back({s.name, s.argCount, true});
    for (size_t i = 0; i < c.nestedNames.size(); ++i)
        map.symbols_.push_back({c.nestedNames[i], c.symbolRecords[c.symbols.size() + i].argCount, true});
    map.warnings_ = c.reporter.all();

    std::vector<vec4> directions;
    std::vector<std::pair<uint32_t, uint32_t>> directionPatches;  // word of the section, uniform
    for (size_t i = 0; i < c.expressions.directions.size(); i += 3) {
        vec4 d(0.0f);
        for (int k = 0; k < 3; ++k) {
            grammar::Node n = c.expressions.directions[i + static_cast<size_t>(k)];
            if (c.graph.isConstant(n))
                d[k] = c.graph[n].value;
            else
                directionPatches.emplace_back(static_cast<uint32_t>(directions.size()) * 4 + static_cast<uint32_t>(k),
                                              c.code.uniform(n).slot - grammar::kSlotUniform);
        }
        directions.push_back(d);
    }
    if (c.kind == GrammarKind::plants)
        for (uint32_t i = 0; i < c.symbolRecords.size(); ++i) c.symbolRecords[i].uses |= symbolBit(i, slotsOf(map));
    append(map.words_, map.sections_[kSectionSymbols], c.symbolRecords);
    append(map.words_, map.sections_[kSectionRules], c.rules);
    append(map.words_, map.sections_[kSectionSuccessors], c.successors);
    append(map.words_, map.sections_[kSectionExtrudes], c.extrudes);
    append(map.words_, map.sections_[kSectionTerminals], c.terminals);
    append(map.words_, map.sections_[kSectionCode], c.code.code);
    append(map.words_, map.sections_[kSectionSites], c.sites);
    append(map.words_, map.sections_[kSectionDirections], directions);
    append(map.words_, map.sections_[kSectionValues], c.roofValues);
    append(map.words_, map.sections_[kSectionParts], c.parts);
    append(map.words_, map.sections_[kSectionOps], c.ops);
    append(map.words_, map.sections_[kSectionQueries], c.expressions.queries);
    while (map.words_.size() % 4 != 0) map.words_.push_back(0);

    for (uint32_t s = 0; s < kSections; ++s)
        for (uint32_t r = 0; r < map.sections_[s].count; ++r)
            for (uint32_t offset : valueOffsets(s)) {
                uint32_t word = map.sections_[s].offset + r * kRecordWords[s] + offset;
                if (map.words_[word] < grammar::kSlotUniform) continue;
                map.patches_.push_back({map.words_[word] - grammar::kSlotUniform, word + 1});
                map.words_[word] = kSlotImmediate;
            }
    for (auto [codeWord, uniform] : c.code.codePatches)
        map.patches_.push_back({uniform, map.sections_[kSectionCode].offset + codeWord * 2 + 1});
    for (auto [word, uniform] : directionPatches)
        map.patches_.push_back({uniform, map.sections_[kSectionDirections].offset + word});
    map.uniformCode_ = c.code.uniformCode;
    for (const grammar::UniformRecord& u : c.code.uniforms) map.uniforms_.push_back({u.code, u.value});
    map.width_ = c.width;
    map.avoid_ = c.avoid;
    evaluate(map);
    return map;
}

void RuleMapAccess::evaluate(RuleMap& map) {
    Machine machine;
    resetMachine(MACHINE_ONLY);
    for (const ParamInfo& p : map.params_)
        for (uint32_t k = 0; k < numbersOf(p); ++k) SLOT(grammar::kSlotParam + p.slot + k) = tamed(p.value[k]);
    CodeBuf code{map.uniformCode_.data()};
    std::vector<float> results;
    for (const RuleMap::Uniform& u : map.uniforms_) {
        runCode(MACHINE code, u.code);
        results.push_back(valueOf(MACHINE u.value));
    }
    for (const RuleMap::Patch& patch : map.patches_) map.words_[patch.word] = floatBitsToUint(results[patch.uniform]);
    for (FixedLength* length : {&map.width_, &map.avoid_})
        if (length->uniform != kNoIndex) length->value = std::max(results[length->uniform], 0.0f);
}

std::optional<uint32_t> RuleMap::findSymbol(std::string_view name) const {
    for (uint32_t i = 0; i < symbols_.size(); ++i)
        if (symbols_[i].name == name) return i;
    return std::nullopt;
}
std::optional<uint32_t> RuleMap::findParam(std::string_view name) const {
    for (uint32_t i = 0; i < params_.size(); ++i)
        if (params_[i].name == name) return i;
    return std::nullopt;
}
std::optional<uint32_t> RuleMap::findContext(std::string_view name) const {
    for (uint32_t i = 0; i < contexts_.size(); ++i)
        if (contexts_[i].name == name) return i;
    return std::nullopt;
}

uint32_t RuleMap::setParam(uint32_t param, std::span<const float> values) {
    assert(param < params_.size());
    ParamInfo& p = params_[param];
    uint32_t changed = 0;
    for (uint32_t k = 0; k < numbersOf(p) && k < values.size(); ++k) {
        float v = values[k];
        if (std::isnan(v)) continue;
        if (p.kind == ParamKind::colour)
            v = std::clamp(v, 0.0f, 1.0f);
        else
            v = std::clamp(v, p.minimum, p.maximum);
        if (p.kind == ParamKind::toggle) v = holds(v) ? 1.0f : 0.0f;
        if (v == p.value[k]) continue;
        p.value[k] = v;
        changed |= 1u << (p.slot + k);
    }
    if (changed != 0) RuleMapAccess::evaluate(*this);
    return changed;
}

std::span<const uint32_t> RuleMap::words() const {
    return words_;
}

namespace {

// What a map's records ask of places: kInput... bits, and layers.
struct Asked {
    uint32_t inputs = 0, layers = 0;
};

Asked askedBy(const RuleMap& map, const RuleMapRef& ref) {
    uint32_t inputs = 0, layers = 0;
    for (uint32_t i = 0; i < ref.symbolCount; ++i) {
        const SymbolRecord r = RuleMapAccess::record<SymbolRecord>(map, kSectionSymbols, i);
        inputs |= r.inputs;
        layers |= r.layers;
    }
    for (uint32_t i = 0; i < ref.ruleCount; ++i) {
        const RuleRecord r = RuleMapAccess::record<RuleRecord>(map, kSectionRules, i);
        inputs |= r.startInputs | r.arriveInputs;
        layers |= r.startLayers | r.arriveLayers;
    }
    for (uint32_t i = 0; i < ref.extrudeCount; ++i) {
        const ExtrudeRecord r = RuleMapAccess::record<ExtrudeRecord>(map, kSectionExtrudes, i);
        inputs |= r.inputs;
        layers |= r.layers;
    }
    return {inputs, layers};
}

// The kFeature... bits of what the map's records ask of places and its code does.
uint32_t featuresOf(const RuleMap& map, const RuleMapRef& ref) {
    const auto [inputs, layers] = askedBy(map, ref);
    uint32_t features = kFeatureKnown;
    for (uint32_t i = 0; i < ref.codeCount; ++i)
        if (isHardOperation(RuleMapAccess::record<CodeWord>(map, kSectionCode, i).bits & 31u))
            features |= kFeatureHardCode;
    for (uint32_t i = 0; i < ref.terminalCount; ++i)
        for (const Value& channel : RuleMapAccess::record<TerminalRecord>(map, kSectionTerminals, i).colour)
            if (channel.slot != kSlotImmediate) features |= kFeatureColours;
    if (inputs & kInputsOfWorld) features |= kFeatureWorld;
    if (layers || (inputs & kInputCurvature)) features |= kFeatureSurface;
    return features;
}

}  // namespace

uint32_t RuleMap::terminalMeshes() const {
    uint32_t meshes = 0;
    for (uint32_t i = 0; i < sections_[kSectionTerminals].count; ++i)
        meshes |= 1u << shippedMesh(RuleMapAccess::record<TerminalRecord>(*this, kSectionTerminals, i).mesh);
    return meshes;
}

void RuleMap::setTerminalMesh(uint32_t shipped, uint32_t mesh) {
    for (uint32_t i = 0; i < sections_[kSectionTerminals].count; ++i) {
        uint32_t& drawn = words_[sections_[kSectionTerminals].offset + i * kRecordWords[kSectionTerminals] +
                                 wordOf(offsetof(TerminalRecord, mesh))];
        if (shippedMesh(drawn) == shipped) drawn = mesh;
    }
}

uint32_t RuleMap::inputs() const {
    return askedBy(*this, ref()).inputs;
}

RuleMapRef RuleMap::refAt(uint64_t address) const {
    RuleMapRef ref = {};
    auto at = [&](uint32_t section) { return address + uint64_t(sections_[section].offset) * 4; };
    ref.symbols.v = reinterpret_cast<SymbolRecord*>(at(kSectionSymbols));
    ref.rules.v = reinterpret_cast<RuleRecord*>(at(kSectionRules));
    ref.successors.v = reinterpret_cast<SuccessorRecord*>(at(kSectionSuccessors));
    ref.extrudes.v = reinterpret_cast<ExtrudeRecord*>(at(kSectionExtrudes));
    ref.terminals.v = reinterpret_cast<TerminalRecord*>(at(kSectionTerminals));
    ref.code.v = reinterpret_cast<CodeWord*>(at(kSectionCode));
    ref.sites.v = reinterpret_cast<uint*>(at(kSectionSites));
    ref.symbolCount = sections_[kSectionSymbols].count;
    ref.ruleCount = sections_[kSectionRules].count;
    ref.successorCount = sections_[kSectionSuccessors].count;
    ref.extrudeCount = sections_[kSectionExtrudes].count;
    ref.terminalCount = sections_[kSectionTerminals].count;
    ref.codeCount = sections_[kSectionCode].count;
    ref.siteCount = sections_[kSectionSites].count;
    ref.features = featuresOf(*this, ref);
    for (uint32_t i = 0; i < kMaxDirections; ++i) {
        ref.directions[i] = vec4(0.0f);
        if (i < sections_[kSectionDirections].count)
            ref.directions[i] = RuleMapAccess::record<vec4>(*this, kSectionDirections, i);
    }
    for (uint32_t i = 0; i < kMaxLayers; ++i) ref.layerOf[i] = i;
    ref.values.v = reinterpret_cast<Value*>(at(kSectionValues));
    ref.valueCount = sections_[kSectionValues].count;
    ref.kind = uint32_t(kind_);
    ref.parts.v = reinterpret_cast<PatternPart*>(at(kSectionParts));
    ref.ops.v = reinterpret_cast<PatternOp*>(at(kSectionOps));
    ref.queries.v = reinterpret_cast<uint*>(at(kSectionQueries));
    ref.queryCount = sections_[kSectionQueries].count;
    ref.guide = fields_.empty() ? kGuideNone : fields_[0].jumps ? kGuideJumps : kGuideNearest;
    return ref;
}

std::vector<TerminalMesh> standardTerminalMeshes() {
    return {{"bark", true}, {"leaf", false}, {"pebble", false}, {"oval", false}, {"blossom", false}, {"tuft", false}};
}

}  // namespace espalier
