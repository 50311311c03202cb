// What grammars of patterns know, and what patterns have come to.
#include "runtime/grammar/vocabulary.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

using namespace espalier;

extern "C" {

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
