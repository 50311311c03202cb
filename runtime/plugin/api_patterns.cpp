// Fields of surfaces, and what patterns have come to.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/grammar/vocabulary.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostElements = 4096;

EspResult checkField(const EspContext* context, const EspFieldDef& def) {
    if ((def.elementCount > 0 && !def.elements) || def.elementCount > kMostElements)
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: null pointer, or more than 4096 elements");
    if (!finite(def.drift) || !(def.lean >= 0 && def.lean <= 1e6f))
        return fail(context, ESP_INVALID_ARGUMENT, "espSetField: the drift isn't finite, or 'lean' isn't 0 to 1e6");
    for (uint32_t i = 0; i < def.elementCount; ++i) {
        const EspFieldElement& e = def.elements[i];
        if (!isAmong(e.kind, ESP_ELEMENT_REGULAR, ESP_ELEMENT_SADDLE) || !finite(e.position) || !finite(e.direction) ||
            !(e.radius >= 0 && e.radius <= 1e9f))
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espSetField: element " + std::to_string(i) + " is out of range");
    }
    return ESP_OK;
}

}  // namespace

void setDefaults(EspFieldDef& def) {
    const AskedField standard;
    std::memcpy(def.drift, standard.drift, sizeof def.drift);
    def.lean = standard.lean;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultFieldDef(EspFieldDef* out) {
    return giveDefaults("espDefaultFieldDef", out);
}

EspResult espSetField(EspContext* context, EspSurface surface, const char* name, const EspFieldDef* given) {
    return guarded(context, [&] {
        if (!context->surfaces.find(surface.id) || !name || !*name)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetField: no such surface, or no name");
        ContextPatterns& patterns = context->patterns;
        const std::pair<uint32_t, std::string> key{surface.id, name};
        if (!given) {
            if (patterns.asked.erase(key) > 0) context->nodes.fields.change();
            return ESP_OK;
        }
        const EspFieldDef def = taken("espSetField", given);
        if (EspResult bad = checkField(context, def)) return bad;
        AskedField asked;
        asked.elements.assign(def.elements, def.elements + def.elementCount);
        std::memcpy(asked.drift, def.drift, sizeof asked.drift);
        asked.lean = def.lean;
        asked.exact = def.exact != 0;
        asked.number = context->nodes.fields.change();
        patterns.asked[key] = std::move(asked);
        return ESP_OK;
    });
}

EspResult espFieldSingularities(EspContext* context, EspSurface surface, const char* name, EspSingularity* out,
                                uint32_t* count) {
    return guarded(context, [&] {
        const PlacedSurface* placed = context->surfaces.find(surface.id);
        const FieldInfo* info = name ? fieldNamed(*context, name) : nullptr;
        if (!placed || !info || !count)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espFieldSingularities: no such surface, no grammar that declares the field, or no count");
        const Result<MadeField*> made = fieldOn(*context, surface.id, *info);
        if (!made) return failWork(context, made.failure());
        std::vector<Singularity> found;
        const FieldMesh& mesh = context->patterns.ground[surface.id].mesh;
        if (made.value()) found = singularitiesOf(mesh, made.value()->field);
        for (uint32_t i = 0; out && i < std::min(size_t(*count), found.size()); ++i) {
            const glm::vec3 place(placed->toWorld * glm::vec4(glm::vec3(placeOf(mesh, found[i])), 1));
            out[i] = {{place.x, place.y, place.z}, float(found[i].turns) / float(info->symmetry)};
        }
        *count = uint32_t(found.size());
        return ESP_OK;
    });
}

EspResult espSetPieces(EspContext* context, const char* path) {
    return guarded(context, [&] {
        bool known = false;
        context->grammars.forEach(
            [&](uint32_t, const LoadedGrammar& grammar) { known = known || grammar.map.patterns(); });
        if (known)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espSetPieces: a grammar of patterns is compiled already; destroy it before");
        return usePieces(*context, path ? std::filesystem::path(path) : std::filesystem::path());
    });
}

EspResult espGrammarKind(const EspContext* context, EspGrammar grammar, EspGrammarKind* out) {
    return guarded(context, [&] {
        const LoadedGrammar* found = context->grammars.find(grammar.id);
        if (!found || !out) return fail(context, ESP_INVALID_ARGUMENT, "espGrammarKind: no such grammar, or null");
        static_assert(uint32_t(GrammarKind::patterns) == ESP_GRAMMAR_PATTERNS);
        *out = EspGrammarKind(found->map.kind());
        return ESP_OK;
    });
}

uint32_t espWordCount(EspGrammarKind kind) {
    return isAmong(kind, ESP_GRAMMAR_PLANTS, ESP_GRAMMAR_PATTERNS)
               ? uint32_t(grammar::wordsOf(GrammarKind(kind)).size())
               : 0;
}

EspResult espWord(EspGrammarKind kind, uint32_t index, EspWord* out) {
    return guardedAlone([&] {
        if (index >= espWordCount(kind))
            return failAlone(ESP_INVALID_ARGUMENT, "espWord: no such kind of grammars, or beyond its last word");
        const grammar::WordInfo& word = grammar::wordsOf(GrammarKind(kind))[index];
        EspWord given{};
        given.name = word.name.data();
        given.usage = word.usage.empty() ? "" : word.usage.data();
        give("espWord", out, given);
        return ESP_OK;
    });
}

uint32_t espFieldCount(const EspContext* context, EspGrammar grammar) {
    const LoadedGrammar* found = context ? context->grammars.find(grammar.id) : nullptr;
    return found ? uint32_t(found->map.fields().size()) : 0;
}

const char* espFieldName(const EspContext* context, EspGrammar grammar, uint32_t index) {
    const LoadedGrammar* found = context ? context->grammars.find(grammar.id) : nullptr;
    return found && index < found->map.fields().size() ? found->map.fields()[index].name.c_str() : "";
}

EspResult espPatternStats(EspContext* context, EspPatternStats* out) {
    return guarded(context, [&] {
        const PatternStats& s = context->patterns.stats;
        EspPatternStats stats{};
        stats.seeds = context->patterns.seeds;
        stats.shapes = s.shapes;
        stats.tried = s.tried;
        stats.standing = s.standing;
        stats.fallen = s.fallen;
        stats.waves = s.waves;
        stats.rounds = s.rounds;
        stats.pieces = s.pieces;
        stats.hash = s.hash;
        stats.ms = s.ms;
        give("espPatternStats", out, stats);
        return ESP_OK;
    });
}

}  // extern "C"
