// Enters: seeds, grammars, fields, surfaces by address. Leaves: pieces that stand. What runs out of room is derived
// again with more.
#include "runtime/pattern/pattern_growth.hpp"

#include <chrono>

#include "runtime/machine/room.hpp"

namespace espalier {

Status PatternGrowth::makeRoom(const PatternInputs& inputs, std::span<const FieldRef> fieldTable) {
    room_.items = std::max(room_.items, uint32_t(inputs.seeds.size()));
    const auto bytes = [](size_t count, size_t each) { return uint64_t(std::max<size_t>(count, 1)) * each; };
    const PieceMeshes& meshes = *inputs.meshes;
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
    } rows[] = {{items_, "pattern items", bytes(room_.items * size_t(kPatternPriorities), sizeof(PatternItem))},
                {shapes_, "pattern shapes", bytes(room_.items, sizeof(PatternShape))},
                {sets_, "pattern sets", bytes(room_.sets, sizeof(PatternSet))},
                {pieces_, "pattern pieces", bytes(room_.pieces, sizeof(PatternPiece))},
                {edges_, "pattern edges", bytes(room_.edges, sizeof(PatternEdge))},
                {pairs_, "pattern pairs", bytes(room_.pairs, sizeof(PatternPair))},
                {cells_, "pattern cells", bytes(room_.cells(), 4)},
                {meshes_, "piece meshes", bytes(meshes.meshes.size(), sizeof(PatternMesh))},
                {clusters_, "piece clusters", bytes(meshes.clusters.size(), sizeof(vec4))},
                {corners_, "piece corners", bytes(meshes.corners.size(), sizeof(vec3))},
                {status_, "pattern status", sizeof(PatternStatus)},
                {env_, "pattern environment", sizeof(PatternEnv)},
                {grammars_, "pattern grammars", bytes(inputs.grammars.size(), sizeof(RuleMapRef))},
                {fields_, "pattern fields", bytes(fieldTable.size(), sizeof(FieldRef))}};
    for (const auto& row : rows)
        if (Status made = ensureRoom(device_, row.buffer, row.name, row.bytes); !made) return made;
    return Done{};
}

PatternEnv PatternGrowth::environment(const PatternInputs& inputs) const {
    PatternEnv env{};
    env.surfaces = inputs.surfaces;
    env.layers = inputs.layers;
    env.grammars = addressOf<RuleMapBuf>(grammars_);
    env.fields = addressOf<FieldBuf>(fields_);
    env.items = addressOf<PatternItemBuf>(items_);
    env.shapes = addressOf<PatternShapeBuf>(shapes_);
    env.sets = addressOf<PatternSetBuf>(sets_);
    env.pieces = addressOf<PatternPieceBuf>(pieces_);
    env.edges = addressOf<PatternEdgeBuf>(edges_);
    env.pairs = addressOf<PatternPairBuf>(pairs_);
    env.cells = addressOf<UintBuf>(cells_);
    env.meshes = addressOf<PatternMeshBuf>(meshes_);
    env.clusters = addressOf<PatternVec4Buf>(clusters_);
    env.corners = addressOf<PatternVec3Buf>(corners_);
    env.status = addressOf<PatternStatusBuf>(status_);
    env.instances = inputs.surfaceCount;
    env.cellMask = room_.cells() - 1;
    return env;
}

PatternShaders PatternGrowth::shaders() const {
    const uint64_t groups = patternGroups(std::max(room_.items, room_.pieces));
    return {env_.address(), &status_, groups * kPatternGroup * kSlotWords * 4};
}

Status PatternGrowth::upload(Commands& commands, const PatternInputs& inputs, std::span<const FieldRef> fieldTable,
                             const PatternEnv& env) {
    const std::vector<RuleMapRef> grammars(inputs.grammars.begin(), inputs.grammars.end());
    const std::vector<FieldRef> fields(fieldTable.begin(), fieldTable.end());
    const PieceMeshes& meshes = *inputs.meshes;
    commands.fill(cells_, kNoIndex, 0, uint64_t(room_.cells()) * 4);
    return allDone({commands.upload(meshes_, meshes.meshes), commands.upload(clusters_, meshes.clusters),
                    commands.upload(corners_, meshes.corners), commands.upload(grammars_, grammars),
                    commands.upload(fields_, fields), commands.upload(items_, itemsOfPatternSeeds(inputs)),
                    commands.upload(status_, std::vector<PatternStatus>{freshPatternStatus(inputs, room_)}),
                    commands.upload(env_, std::vector<PatternEnv>{env})});
}

Result<PatternStatus> PatternGrowth::attempt(const PatternInputs& inputs, std::span<const FieldRef> fieldTable,
                                             bool native) {
    if (Status made = makeRoom(inputs, fieldTable); !made) return made.failure();
    const PatternEnv env = environment(inputs);
    for (bool first = true;; first = false) {
        Result<Run> run = Run::begin(runner_, "patterns", runner_.atOnce(native, status_));
        if (!run) return run.failure();
        if (first)
            if (Status sent = upload(run->send(), inputs, fieldTable, env); !sent) return sent.failure();
        run->readBack(status_, sizeof(PatternStatus));
        if (Status added = run->add(patternStages(shaders(), env)); !added) return added.failure();
        if (Status finished = run->finish(); !finished) return finished.failure();
        dispatches_ += run->dispatches();
        const PatternStatus status = *run->got<PatternStatus>(0);
        if (status.wave == 0 || !room_.holds(status) || !withinLimits(status, inputs.limits)) return status;
    }
}

Result<GrownPattern> PatternGrowth::readBack(const PatternInputs& inputs, bool native) {
    Result<Run> run = Run::begin(runner_, "patterns", runner_.atOnce(native, status_));
    if (!run) return run.failure();
    run->readBack(status_, sizeof(PatternStatus));
    if (Status added = run->add(patternHashStages(shaders(), environment(inputs))); !added) return added.failure();
    if (Status finished = run->finish(); !finished) return finished.failure();
    const PatternStatus status = *run->got<PatternStatus>(0);
    Result<std::vector<PatternPiece>> pieces = readVector<PatternPiece>(device_, pieces_, 0, status.pieces);
    if (!pieces) return pieces.failure();
    Result<std::vector<PatternSet>> sets = readVector<PatternSet>(device_, sets_, 0, status.sets);
    if (!sets) return sets.failure();
    return standingOf(*pieces, *sets, status);
}

Result<GrownPattern> PatternGrowth::grow(const PatternInputs& inputs, std::span<const FieldRef> fieldTable,
                                         bool native) {
    dispatches_ = 0;
    const auto begin = std::chrono::steady_clock::now();
    while (true) {
        Result<PatternStatus> status = attempt(inputs, fieldTable, native);
        if (!status) return status.failure();
        if (Status within = withinLimits(*status, inputs.limits); !within) return within.failure();
        if (room_.holds(*status)) break;
        room_.grow(*status);
    }
    Result<GrownPattern> grown = readBack(inputs, native);
    if (grown)
        grown->stats.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return grown;
}

Result<std::unique_ptr<PatternGrowth>> PatternGrowth::create(Device& device) {
    return std::unique_ptr<PatternGrowth>(new PatternGrowth(device));
}

}  // namespace espalier
