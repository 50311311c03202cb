// Seeds with values of their own grow by a copy of their grammar's rule map in which these are set: a variant. Seeds of
// the same settings share one. A variant keeps its place among growth's grammars, behind the grammars themselves; a
// place that nobody uses any more is given to the next one that comes.
#include <algorithm>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/seeds.hpp"

namespace espalier {
namespace {

constexpr size_t kManyPlaces = 32768;

// The variant that a seed asks for, if there is one.
uint32_t placeOf(const std::vector<GrammarVariant>& variants, const PlantedSeed& seed) {
    for (uint32_t i = 0; i < variants.size(); ++i)
        if (variants[i].used && variants[i].grammar == seed.grammar && variants[i].params == seed.params) return i;
    return kNoIndex;
}

uint32_t freePlace(std::vector<GrammarVariant>& variants, const std::vector<bool>& wanted) {
    for (uint32_t i = 0; i < variants.size(); ++i)
        if (!wanted[i]) return i;
    variants.emplace_back();
    return uint32_t(variants.size() - 1);
}

// The grammar's map with the variant's values; parameters that it hasn't got (any more), or has of another kind, are
// passed over.
Status fill(EspContext& context, GrammarVariant& variant, uint32_t place) {
    const LoadedGrammar& grammar = *context.grammars.find(variant.grammar);
    RuleMap map = grammar.map;
    for (const SeedParam& param : variant.params)
        if (const auto index = map.findParam(param.name); index && numbersOf(map.params()[*index]) == param.count)
            map.setParam(*index, std::span(param.value.data(), param.count));
    Result<Buffer> words = makeBuffer(*context.device, "rule map variant", std::as_bytes(map.words()));
    if (!words) return words.failure();
    const uint32_t index = context.grammars.size() + place;
    if (variant.used)
        noteRules(context, index, {variant.map, variant.layerOf}, {map, grammar.layerOf});
    else
        context.changes.grammars.push_back(index);
    variant.map = std::move(map);
    variant.words = std::move(*words);
    variant.madeFrom = grammar.version;
    variant.layerOf = grammar.layerOf;
    variant.used = true;
    return Done{};
}

}  // namespace

void noteRules(EspContext& context, uint32_t index, const BoundRules& before, const BoundRules& now) {
    const size_t common = std::min(before.layerOf.size(), now.layerOf.size());
    const RuleChanges changes = now.map.changesFrom(before.map);
    if (changes.all ||
        !std::equal(now.layerOf.begin(), now.layerOf.begin() + std::ptrdiff_t(common), before.layerOf.begin())) {
        context.changes.grammars.push_back(index);
        return;
    }
    context.changes.markUses(index, changes.uses);
    if (changes.extrudes) context.changes.extrudes.push_back(index);
}

Status refreshVariants(EspContext& context) {
    std::vector<GrammarVariant>& variants = context.variants;
    std::vector<bool> wanted(variants.size());
    context.seeds.forEach([&](uint32_t, PlantedSeed& seed) {
        seed.variant = seed.params.empty() ? kNoIndex : placeOf(variants, seed);
        if (seed.variant != kNoIndex) wanted[seed.variant] = true;
    });
    Status status = Done{};
    context.seeds.forEach([&](uint32_t, PlantedSeed& seed) {
        if (seed.params.empty() || seed.variant != kNoIndex || !status) return;
        seed.variant = placeOf(variants, seed);  // made for a seed before this one
        if (seed.variant != kNoIndex) return;
        const uint32_t place = freePlace(variants, wanted);
        GrammarVariant variant;
        variant.grammar = seed.grammar;
        variant.params = seed.params;
        status = fill(context, variant, place);
        if (!status) return;
        variants[place] = std::move(variant);
        wanted.resize(variants.size());
        wanted[place] = true;
        seed.variant = place;
    });
    for (uint32_t i = 0; i < variants.size() && status; ++i) {
        variants[i].used = wanted[i];
        if (wanted[i] && variants[i].madeFrom != context.grammars.find(variants[i].grammar)->version)
            status = fill(context, variants[i], i);
    }
    // Growth names so many grammars at most. Who has more places than that has had very many: a shorter list makes all
    // grow anew.
    while (variants.size() > kManyPlaces && !variants.back().used) variants.pop_back();
    return status;
}

}  // namespace espalier
