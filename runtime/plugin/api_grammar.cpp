// Compiling grammars and setting their parameters; the layers that they read get their numbers here.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/looks.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMaxGrammars = 1024;

Result<RuleMap> compile(const EspContext& context, const EspGrammarDef& def) {
    CompileOptions options;
    options.fileName = def.name ? def.name : "grammar";
    options.readInclude = context.files.includesOf(options.fileName);
    options.roofMeshes = context.roofMeshNames;
    options.pieces = context.patterns.names;
    return compileGrammar({def.text, def.length}, options, context.cacheFolder);
}

// Gives the layers that a grammar of plants reads their numbers; those of roofs lie over the town. old: id of the
// grammar in whose place it comes, whose layers it may take; 0.
Status bindLayers(EspContext& context, LoadedGrammar& grammar, uint32_t old) {
    if (grammar.map.roofs()) return Done{};
    std::vector<uint32_t> kept;
    for (const ContextInfo& layer : grammar.map.contexts())
        if (const auto known = std::ranges::find(context.sceneLayers, SceneLayer{layer.name, layer.fill});
            known != context.sceneLayers.end())
            kept.push_back(uint32_t(known - context.sceneLayers.begin()));
    for (const ContextInfo& layer : grammar.map.contexts()) {
        const std::optional<uint32_t> number = sceneLayer(context, layer.name, layer.fill, kept, old);
        if (!number)
            return Failure(grammar.name, "layer '" + layer.name + "': the grammars of this scene read more than " +
                                             std::to_string(kMaxLayers) + " layers");
        grammar.layerOf.push_back(*number);
        kept.push_back(*number);
    }
    return Done{};
}

// Everything of a grammar but its seeds, ready to take the place of what stood there. oldId: 0, or the grammar whose
// parameters are taken over by name.
Result<LoadedGrammar> prepare(EspContext& context, const EspGrammarDef& def, uint32_t oldId) {
    const auto begin = std::chrono::steady_clock::now();
    // Without their files, grammars of roofs and of patterns know no meshes; ivy doesn't mind.
    std::string ignored;
    (void)knowRoofMeshes(context, ignored);
    (void)knowPieces(context);
    Result<RuleMap> map = compile(context, def);
    if (!map) return map.failure();
    LoadedGrammar grammar;
    grammar.name = def.name ? def.name : "grammar";
    grammar.map = std::move(*map);
    grammar.warnings = toString(grammar.map.warnings());
    for (const Diagnostic& warning : grammar.map.warnings()) context.log(Severity::warning, toString(warning));
    if (const LoadedGrammar* old = context.grammars.find(oldId))
        for (const ParamInfo& param : old->map.params())
            if (auto index = grammar.map.findParam(param.name))
                if (grammar.map.params()[*index].kind == param.kind)
                    grammar.map.setParam(*index, std::span(param.value, numbersOf(param)));
    takeLooks(context, oldId, grammar.map);
    if (Status bound = bindLayers(context, grammar, oldId); !bound) return bound.failure();
    grammar.compileMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return grammar;
}

EspResult checkDef(const EspContext* context, const EspGrammarDef& def) {
    if (!def.text && def.length) return fail(context, ESP_INVALID_ARGUMENT, "compiling a grammar: its text is null");
    if (def.length > kMaxGrammarBytes)
        return fail(context, ESP_INVALID_CONTENT,
                    std::string(def.name ? def.name : "a grammar") + ": the text is longer than 1 MiB");
    return ESP_OK;
}

LoadedGrammar* find(const EspContext* context, EspGrammar grammar) {
    return context ? const_cast<EspContext*>(context)->grammars.find(grammar.id) : nullptr;
}

EspParamKind kindOf(const ParamInfo& param) {
    switch (param.kind) {
        case ParamKind::toggle:
            return ESP_PARAM_BOOL;
        case ParamKind::colour:
            return ESP_PARAM_COLOUR;
        case ParamKind::number:
            break;
    }
    return ESP_PARAM_FLOAT;
}

// The first of the grammar's seeds whose start symbol `map` hasn't got.
std::string lostSymbol(const EspContext& context, uint32_t grammarId, const RuleMap& map) {
    std::string lost;
    context.seeds.forEach([&](uint32_t, const PlantedSeed& seed) {
        if (seed.grammar != grammarId || seed.symbol.empty() || !lost.empty()) return;
        const auto symbol = map.findSymbol(seed.symbol);
        if (!symbol || !map.symbols()[*symbol].grows) lost = seed.symbol;
    });
    return lost;
}

const char* kindName(GrammarKind kind) {
    return kind == GrammarKind::roofs ? "roofs" : kind == GrammarKind::patterns ? "patterns" : "plants";
}

// What the grammar is of use for, if it can't be of the other kind for that; else null.
const char* useOf(const EspContext& context, uint32_t grammarId) {
    if (context.town && context.town->grammar == grammarId) return "the town's roofs grow by it";
    bool planted = false;
    context.seeds.forEach([&](uint32_t, const PlantedSeed& seed) { planted = planted || seed.grammar == grammarId; });
    return planted ? "planted seeds grow by it" : nullptr;
}

// Where nothing grows differently by the new text, `old` takes what is told of it and all that grew stands.
bool takeText(LoadedGrammar& old, LoadedGrammar& grammar) {
    if (!grammar.map.growsAs(old.map) || grammar.layerOf != old.layerOf) return false;
    old.name = std::move(grammar.name);
    old.map = std::move(grammar.map);
    old.warnings = std::move(grammar.warnings);
    old.compileMs = grammar.compileMs;
    return true;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

uint32_t EspContext::grammarIndex(uint32_t id) const {
    uint32_t index = kNoIndex, next = 0;
    grammars.forEach([&](uint32_t other, const LoadedGrammar&) {
        if (other == id) index = next;
        ++next;
    });
    return index;
}

extern "C" {

EspResult espCompileGrammar(EspContext* context, const EspGrammarDef* given, EspGrammar* out) {
    return guarded(context, [&] {
        const EspGrammarDef def = taken("espCompileGrammar", given);
        if (!out) return fail(context, ESP_INVALID_ARGUMENT, "espCompileGrammar: null pointer");
        if (EspResult bad = checkDef(context, def)) return bad;
        if (context->grammars.size() >= kMaxGrammars)
            return fail(context, ESP_INVALID_ARGUMENT, "espCompileGrammar: there are 1024 grammars already");
        std::vector<SceneLayer> before = context->sceneLayers;
        Undo binding([&] { context->sceneLayers.swap(before); });
        Result<LoadedGrammar> grammar = prepare(*context, def, 0);
        if (!grammar) return failContent(context, grammar.failure());
        context->compileMs = grammar->compileMs;
        const uint32_t id = context->grammars.insert(std::move(*grammar));
        if (!id) return fail(context, ESP_OUT_OF_MEMORY, "espCompileGrammar: no ids left");
        binding.done();
        out->id = id;
        return ESP_OK;
    });
}

EspResult espRecompileGrammar(EspContext* context, EspGrammar id, const EspGrammarDef* given) {
    return guarded(context, [&] {
        const EspGrammarDef def = taken("espRecompileGrammar", given);
        LoadedGrammar* old = find(context, id);
        if (!old) return fail(context, ESP_INVALID_ARGUMENT, "espRecompileGrammar: no such grammar");
        if (EspResult bad = checkDef(context, def)) return bad;
        std::vector<SceneLayer> before = context->sceneLayers;
        Undo binding([&] { context->sceneLayers.swap(before); });
        Result<LoadedGrammar> grammar = prepare(*context, def, id.id);
        if (!grammar) return failContent(context, grammar.failure());
        const std::string lost = lostSymbol(*context, id.id, grammar->map);
        if (!lost.empty())
            return fail(context, ESP_INVALID_CONTENT,
                        grammar->name + ": no rule grows from '" + lost + "', which planted seeds start with");
        const char* use = grammar->map.kind() != old->map.kind() ? useOf(*context, id.id) : nullptr;
        if (use)
            return fail(context, ESP_INVALID_CONTENT,
                        grammar->name + ": would make " + kindName(grammar->map.kind()) + ", yet " + use);
        context->compileMs = grammar->compileMs;
        if (takeText(*old, *grammar)) {
            binding.done();
            return ESP_OK;
        }
        noteRules(*context, context->grammarIndex(id.id), {old->map, old->layerOf}, {grammar->map, grammar->layerOf});
        binding.done();
        *old = std::move(*grammar);
        context->changeRules(*old);
        return ESP_OK;
    });
}

const char* espGrammarWarnings(const EspContext* context, EspGrammar id) {
    const LoadedGrammar* grammar = find(context, id);
    return grammar ? grammar->warnings.c_str() : "";
}

EspResult espDestroyGrammar(EspContext* context, EspGrammar id) {
    return guarded(context, [&] {
        if (!find(context, id)) return fail(context, ESP_INVALID_ARGUMENT, "espDestroyGrammar: no such grammar");
        std::vector<uint32_t> gone;
        context->seeds.forEach([&](uint32_t seedId, const PlantedSeed& seed) {
            if (seed.grammar == id.id) gone.push_back(seedId);
        });
        for (uint32_t seedId : gone) removeSeed(*context, seedId);
        std::erase_if(context->looks, [&](const GrammarLook& look) { return look.grammar == id.id; });
        context->grammars.erase(id.id);
        context->nodes.rules.change();
        return ESP_OK;
    });
}

uint32_t espParamCount(const EspContext* context, EspGrammar id) {
    const LoadedGrammar* grammar = find(context, id);
    return grammar ? uint32_t(grammar->map.params().size()) : 0;
}

EspResult espParamInfo(const EspContext* context, EspGrammar id, uint32_t index, EspParamInfo* out) {
    return guarded(context, [&] {
        const LoadedGrammar* grammar = find(context, id);
        if (!grammar || index >= grammar->map.params().size())
            return fail(context, ESP_INVALID_ARGUMENT, "espParamInfo: no such grammar or parameter");
        const ParamInfo& param = grammar->map.params()[index];
        EspParamInfo info{};
        info.name = param.name.c_str();
        info.label = param.label.empty() ? param.name.c_str() : param.label.c_str();
        info.unit = param.unit.c_str();
        info.kind = kindOf(param);
        std::memcpy(info.value, param.value, sizeof info.value);
        std::memcpy(info.initial, param.standard, sizeof info.initial);
        info.low = param.minimum;
        info.high = param.maximum;
        give("espParamInfo", out, info);
        return ESP_OK;
    });
}

EspResult espSetParam(EspContext* context, EspGrammar id, const char* name, const float* value, uint32_t count) {
    return guarded(context, [&] {
        LoadedGrammar* grammar = find(context, id);
        if (!grammar || !name || !value || count < 1 || count > 3)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetParam: no such grammar, or null, or not 1 to 3 numbers");
        for (uint32_t i = 0; i < count; ++i)
            if (!std::isfinite(value[i]))
                return fail(context, ESP_INVALID_ARGUMENT, std::string("espSetParam: ") + name + ": not a number");
        const std::optional<uint32_t> index = grammar->map.findParam(name);
        if (!index)
            return fail(context, ESP_INVALID_ARGUMENT, grammar->name + ": there is no parameter '" + name + "'");
        if (const uint32_t takes = numbersOf(grammar->map.params()[*index]); count != takes)
            return fail(context, ESP_INVALID_ARGUMENT,
                        grammar->name + ": '" + name + "' takes " + std::to_string(takes) +
                            (takes == 1 ? " number" : " numbers"));
        if (const uint32_t slots = grammar->map.setParam(*index, std::span(value, count))) {
            context->changes.markUses(context->grammarIndex(id.id), slots);
            context->changeRules(*grammar);
        }
        return ESP_OK;
    });
}

uint32_t espLayerCount(const EspContext* context, EspGrammar id) {
    const LoadedGrammar* grammar = find(context, id);
    return grammar ? uint32_t(grammar->map.contexts().size()) : 0;
}

const char* espLayerName(const EspContext* context, EspGrammar id, uint32_t index) {
    const LoadedGrammar* grammar = find(context, id);
    return grammar && index < grammar->map.contexts().size() ? grammar->map.contexts()[index].name.c_str() : "";
}

const char* espLayerLabel(const EspContext* context, EspGrammar id, uint32_t index) {
    const LoadedGrammar* grammar = find(context, id);
    return grammar && index < grammar->map.contexts().size() ? grammar->map.contexts()[index].label.c_str() : "";
}

float espLayerFill(const EspContext* context, EspGrammar id, uint32_t index) {
    const LoadedGrammar* grammar = find(context, id);
    return grammar && index < grammar->map.contexts().size() ? grammar->map.contexts()[index].fill : 0;
}

}  // extern "C"
