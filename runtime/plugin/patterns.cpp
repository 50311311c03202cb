// Enters: seeds of grammars of patterns, fields that were asked for. Leaves: pieces that the renderer draws.
#include "runtime/plugin/patterns.hpp"

#include <algorithm>
#include <bit>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/seeds.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

constexpr uint32_t kMostCollider = 100;  // triangles by which a mesh meets others, if it has a level of so few

// The level of detail by which a mesh meets others: the finest that isn't too fine.
const TerminalLod& colliderOf(const TerminalVariant& variant) {
    for (const TerminalLod& lod : variant.lods)
        if (lod.indexCount / 3 <= kMostCollider) return lod;
    return variant.lods.back();
}

PieceMeshes collidersOf(const TerminalData& data) {
    PieceMeshes meshes;
    for (uint32_t kind = 0; kind < data.kinds.size(); ++kind) {
        // A mesh may bring another one by which it meets others: KIND_collider.
        auto variant = std::ranges::find(data.variants, data.kinds[kind] + "_collider", &TerminalVariant::name);
        if (variant == data.variants.end()) variant = std::ranges::find(data.variants, kind, &TerminalVariant::kind);
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        if (variant != data.variants.end() && !variant->lods.empty()) {
            const TerminalLod& lod = colliderOf(*variant);
            for (uint32_t i = 0; i < lod.vertexCount; ++i)
                positions.push_back(data.vertices[lod.firstVertex + i].position);
            indices.assign(data.indices.begin() + lod.firstIndex,
                           data.indices.begin() + lod.firstIndex + lod.indexCount);
        }
        meshes.add(positions, indices);
    }
    return meshes;
}

// What patterns are derived from.
struct PatternPlanting {
    std::vector<RuleMapRef> maps;
    std::vector<const RuleMap*> rules;
    std::vector<Seed> seeds;
    uint64_t signature = 1;
};

class Gathering {
  public:
    explicit Gathering(const EspContext& context) : context_(context) {}

    PatternPlanting run() {
        context_.seeds.forEach([&](uint32_t, const PlantedSeed& planted) {
            if (!beginsPattern(context_, planted) || planted.onBare || planted.hidden || isAway(context_, planted))
                return;
            Seed seed{};
            seed.key = seedKey(planted);
            seed.walk = planted.walk;
            seed.grammar = mapOf(planted);
            const RuleMap& map = *out_.rules[seed.grammar];
            seed.symbol = planted.symbol.empty() ? map.startSymbol() : *map.findSymbol(planted.symbol);
            out_.seeds.push_back(seed);
            note(seed.key);
            note(uint64_t(seed.walk.place) << 32 | std::bit_cast<uint32_t>(seed.walk.uv.x));
            note(uint64_t(std::bit_cast<uint32_t>(seed.walk.uv.y)) << 32 |
                 std::bit_cast<uint32_t>(seed.walk.direction.x));
            note(uint64_t(std::bit_cast<uint32_t>(seed.walk.direction.y)) << 32 |
                 std::bit_cast<uint32_t>(seed.walk.direction.z));
        });
        note(context_.nodes.tables.version());
        note(context_.nodes.fields.version());
        return std::move(out_);
    }

  private:
    void note(uint64_t word) { out_.signature = mix64(out_.signature + mix64(word + 1)); }

    uint32_t mapOf(const PlantedSeed& planted) {
        const uint64_t key = uint64_t(planted.grammar) << 32 | planted.variant;
        if (const auto known = known_.find(key); known != known_.end()) return known->second;
        const LoadedGrammar& grammar = *context_.grammars.find(planted.grammar);
        const GrammarVariant* variant = planted.variant == kNoIndex ? nullptr : &context_.variants[planted.variant];
        const RuleMap& map = variant ? variant->map : grammar.map;
        RuleMapRef ref = map.refAt((variant ? variant->words : grammar.words).address());
        const std::vector<uint32_t>& layerOf = variant ? variant->layerOf : grammar.layerOf;
        for (size_t i = 0; i < layerOf.size() && i < kMaxLayers; ++i) ref.layerOf[i] = layerOf[i];
        note(grammar.version);
        for (const ParamInfo& param : map.params())
            for (float value : param.value) note(std::bit_cast<uint32_t>(value));
        // Which texels it reads isn't known: any stroke may concern it.
        if (!map.contexts().empty()) note(context_.nodes.paint.version());
        out_.maps.push_back(ref);
        out_.rules.push_back(&map);
        return known_[key] = uint32_t(out_.maps.size()) - 1;
    }

    const EspContext& context_;
    std::map<uint64_t, uint32_t> known_;
    PatternPlanting out_;
};

// [(map * surfaces + instance) * kMaxFields + field]
Result<std::vector<FieldRef>> fieldTable(EspContext& context, const PatternPlanting& planting) {
    const uint32_t count = std::max(context.surfaceSlots(), 1u);
    std::vector<FieldRef> table(planting.maps.size() * count * kMaxFields, FieldRef{});
    std::vector<std::pair<uint32_t, uint32_t>> surfaces;
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& s) { surfaces.emplace_back(id, s.instance); });
    for (size_t m = 0; m < planting.maps.size(); ++m)
        for (const auto& [id, instance] : surfaces)
            for (size_t f = 0; f < planting.rules[m]->fields().size(); ++f) {
                Result<MadeField*> made = fieldOn(context, id, planting.rules[m]->fields()[f]);
                if (!made) return made.failure();
                if (const MadeField* field = *made)
                    table[(m * count + instance) * kMaxFields + f] = {addressOf<FieldTexelBuf>(field->texels),
                                                                      field->size, field->symmetry};
            }
    return table;
}

EspResult derive(EspContext& context, const PatternPlanting& planting) {
    ContextPatterns& patterns = context.patterns;
    GrownPattern grown;
    if (!planting.seeds.empty()) {
        Result<std::vector<FieldRef>> fields = fieldTable(context, planting);
        if (!fields) return failWork(&context, fields.failure());
        PatternInputs inputs;
        inputs.surfaces = addressOf<SurfaceBuf>(context.surfaceTable);
        inputs.surfaceCount = std::max(context.surfaceSlots(), 1u);
        inputs.layers = addressOf<LayerBuf>(context.layerTable);
        inputs.grammars = planting.maps;
        inputs.seeds = planting.seeds;
        inputs.meshes = &patterns.meshes;
        if (!patterns.growth)
            if (Status ready = assign(patterns.growth, PatternGrowth::create(*context.device)); !ready)
                return failGpu(&context, ready.failure());
        Result<GrownPattern> made = patterns.growth->grow(inputs, *fields, !context.grow.shadersOnly);
        if (!made) return failWork(&context, made.failure());
        grown = std::move(*made);
    }
    if (patterns.data) {
        if (Status loaded = context.renderer->loadPieces(*patterns.data); !loaded)
            return failGpu(&context, loaded.failure());
        patterns.data.reset();
    }
    const PatternStats stats = grown.stats;
    if (Status placed = context.renderer->placePieces(std::move(grown.pieces)); !placed)
        return failGpu(&context, placed.failure());
    patterns.stats = stats;
    patterns.seeds = uint32_t(planting.seeds.size());
    patterns.grownFrom = planting.seeds.empty() ? 0 : planting.signature;
    return ESP_OK;
}

Status takePieces(EspContext& context, const std::filesystem::path& path, std::span<const std::byte> file) {
    Result<TerminalData> meshes = parseTerminals(file, path.string(), {"none"});
    if (!meshes) return meshes.failure();
    ContextPatterns& patterns = context.patterns;
    std::vector<TerminalMesh> names;
    for (const std::string& kind : meshes->kinds) names.push_back({kind, false});
    patterns.meshes = collidersOf(*meshes);
    patterns.names = std::move(names);
    patterns.data = std::move(*meshes);
    patterns.file = path;
    return Done{};
}

}  // namespace

EspResult usePieces(EspContext& context, const std::filesystem::path& wanted) {
    const std::filesystem::path path = wanted.empty() ? context.patterns.shipped : wanted;
    if (path == context.patterns.file && !context.patterns.names.empty()) return ESP_OK;
    std::vector<std::byte> file;
    if (EspResult unread = readWhole(&context, path.string(), file)) return unread;
    const Status taken = takePieces(context, path, file);
    return taken ? ESP_OK : failWork(&context, taken.failure());
}

EspResult shiftPatterns(EspContext& context, const glm::dvec3& by) {
    const PieceDraw* drawn = context.renderer->pieces();
    if (!drawn || drawn->empty()) return ESP_OK;
    std::vector<PatternPiece> pieces = drawn->pieces();
    std::vector<Remainder> remainders = context.patterns.remainders;
    remainders.resize(pieces.size());
    for (size_t i = 0; i < pieces.size(); ++i) shift(pieces[i].position, remainders[i], by);
    if (Status placed = context.renderer->placePieces(std::move(pieces)); !placed)
        return failGpu(&context, placed.failure());
    context.patterns.remainders = std::move(remainders);
    return ESP_OK;
}

void keepPatterns(EspContext& context) {
    if (context.patterns.grownFrom != 0) context.patterns.grownFrom = Gathering(context).run().signature;
    context.nodes.patterns.made();
}

EspResult readPiecesAgain(EspContext& context) {
    if (context.patterns.names.empty()) return ESP_OK;
    const std::filesystem::path path = context.patterns.file;
    std::vector<std::byte> file;
    if (EspResult unread = readWhole(&context, path.string(), file)) return unread;
    const Status taken = takePieces(context, path, file);
    return taken ? ESP_OK : failWork(&context, taken.failure());
}

Status knowPieces(EspContext& context) {
    if (!context.patterns.names.empty()) return Done{};
    const std::filesystem::path path = context.patterns.shipped;
    const Result<std::vector<std::byte>> file = context.files.read(path.string());
    return file ? takePieces(context, path, file.value()) : Status(file.failure());
}

bool beginsPattern(const EspContext& context, const PlantedSeed& seed) {
    const LoadedGrammar* grammar = context.grammars.find(seed.grammar);
    return grammar && grammar->map.patterns();
}

EspResult updatePatterns(EspContext& context) {
    ContextPatterns& patterns = context.patterns;
    graph::Node& node = context.nodes.patterns;
    if (!node.due()) return ESP_OK;
    bool any = patterns.grownFrom != 0;
    context.grammars.forEach([&](uint32_t, const LoadedGrammar& grammar) { any = any || grammar.map.patterns(); });
    if (!any) return ESP_OK;
    if (Status tables = context.refreshTables(); !tables) return failGpu(&context, tables.failure());
    if (Status variants = refreshVariants(context); !variants) return failGpu(&context, variants.failure());
    forgetGoneFields(context);
    const PatternPlanting planting = Gathering(context).run();
    const uint64_t wanted = planting.seeds.empty() ? 0 : planting.signature;
    if (wanted == patterns.grownFrom) {  // what changed is of plants alone
        node.made();
        return ESP_OK;
    }
    if (!context.device->lost() && patterns.failed.known(planting.signature))
        return patterns.failed.tell(context.error);
    const EspResult grown = grownOr(context, [&] { return derive(context, planting); });
    if (grown != ESP_OK) return patterns.failed.note(planting.signature, grown, context.error);
    node.made();
    return patterns.failed.forget();
}

}  // namespace espalier
