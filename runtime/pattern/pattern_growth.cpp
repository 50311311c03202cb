// Enters: seeds, grammars, fields, surfaces by address. Leaves: pieces that stand. What runs out of room is derived
// again with more.
#include "runtime/pattern/pattern_growth.hpp"

#include <chrono>
#include <cstddef>
#include <cstring>

#include "runtime/run/at_once.hpp"

namespace espalier {
namespace {

constexpr uint32_t kWavesAhead = 12;  // recorded in one submission
constexpr uint32_t kHashGroups = 64;

}  // namespace

Status PatternGrowth::makeKernels() {
    if (derive_) return Done{};
    const auto exact = [] { return exactly({}); };
    return makeCompute(device_, {{begin_, "pattern/begin.comp", exact(), kPatternGroup},
                                 {derive_, "pattern/derive.comp", exact(), kPatternGroup},
                                 {place_, "pattern/place.comp", exact(), kPatternGroup},
                                 {look_, "pattern/look.comp", exact(), kPatternGroup},
                                 {meet_, "pattern/meet.comp", exact(), kPatternGroup},
                                 {decide_, "pattern/decide.comp", exact(), kPatternGroup},
                                 {goOn_, "pattern/go_on.comp", exact(), kPatternGroup},
                                 {hash_, "pattern/hash.comp", exact(), kPatternGroup}});
}

Status PatternGrowth::makeRoom(const PatternInputs& inputs, std::span<const FieldRef> fieldTable) {
    room_.items = std::max(room_.items, uint32_t(inputs.seeds.size()));
    const auto bytes = [](size_t count, size_t each) { return uint64_t(std::max<size_t>(count, 1)) * each; };
    const PieceMeshes& meshes = *inputs.meshes;
    const struct {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
        BufferUse use = BufferUse::device;
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
                {fields_, "pattern fields", bytes(fieldTable.size(), sizeof(FieldRef))},
                {lanes_, "pattern lanes",
                 uint64_t(patternGroups(std::max(room_.items, room_.pieces))) * kPatternGroup * kSlotWords * 4},
                {readback_, "pattern readback", sizeof(PatternStatus), BufferUse::readback}};
    for (const auto& row : rows) {
        if (row.buffer.size() < row.bytes) row.buffer = {};
        if (Status made = makeAtLeast(device_, row.buffer, row.name, row.bytes, row.use); !made) return made;
    }
    return Done{};
}

Status PatternGrowth::upload(Commands& commands, const PatternInputs& inputs, std::span<const FieldRef> fieldTable) {
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

void PatternGrowth::recordWaves(Commands& commands, uint32_t waves) {
    Pass pass(commands, "patterns");
    const uint64_t env = env_.address();
    const auto next = [&] { pass.barrier(Use::compute | Use::indirect, Use::compute | Use::indirect); };
    const auto indirect = [&](const Program& program, size_t groups, bool slots = false) {
        slots ? pass.dispatchIndirect(program, status_, groups, env, {lanes_})
              : pass.dispatchIndirect(program, status_, groups, env);
        next();
        ++dispatches_;
    };
    for (uint32_t w = 0; w < waves; ++w) {
        pass.dispatch(begin_, {1, 1, 1}, env);
        next();
        ++dispatches_;
        indirect(derive_, offsetof(PatternStatus, deriveGroups), true);
        indirect(place_, offsetof(PatternStatus, pieceGroups), true);
        indirect(look_, offsetof(PatternStatus, pieceGroups));
        indirect(meet_, offsetof(PatternStatus, pairGroups));
        for (uint32_t r = 0; r < kPatternRounds; ++r) indirect(decide_, offsetof(PatternStatus, setGroups));
        indirect(goOn_, offsetof(PatternStatus, shapeGroups));
    }
}

Result<PatternStatus> PatternGrowth::attempt(const PatternInputs& inputs, std::span<const FieldRef> fieldTable) {
    if (Status made = makeRoom(inputs, fieldTable); !made) return made.failure();
    for (bool first = true;; first = false) {
        Result<Commands> commands = Commands::begin(device_, "patterns");
        if (!commands) return commands.failure();
        if (first) {
            if (Status sent = upload(*commands, inputs, fieldTable); !sent) return sent.failure();
            commands->barrier(Use::transfer, Use::compute | Use::indirect);
        }
        recordWaves(*commands, kWavesAhead);
        commands->barrier(Use::compute, Use::transfer);
        commands->copy(status_, readback_, sizeof(PatternStatus));
        commands->barrier(Use::transfer, Use::host);
        if (Status finished = commands->finish(); !finished) return finished.failure();
        PatternStatus status;
        std::memcpy(&status, readback_.mapped(), sizeof status);
        const bool done = status.wave == 0 || !room_.holds(status) || status.pieces > inputs.limits.maxPieces;
        if (done) return status;
    }
}

Result<GrownPattern> PatternGrowth::readBack() {
    Result<Commands> commands = Commands::begin(device_, "patterns");
    if (!commands) return commands.failure();
    {
        Pass pass(*commands, "patterns");
        pass.dispatch(hash_, {kHashGroups, 1, 1}, env_.address());
        pass.barrier(Use::compute, Use::transfer);
    }
    commands->copy(status_, readback_, sizeof(PatternStatus));
    commands->barrier(Use::transfer, Use::host);
    if (Status finished = commands->finish(); !finished) return finished.failure();
    PatternStatus status;
    std::memcpy(&status, readback_.mapped(), sizeof status);
    Result<std::vector<PatternPiece>> pieces = readVector<PatternPiece>(device_, pieces_, 0, status.pieces);
    if (!pieces) return pieces.failure();
    Result<std::vector<PatternSet>> sets = readVector<PatternSet>(device_, sets_, 0, status.sets);
    if (!sets) return sets.failure();
    return standingOf(*pieces, *sets, status);
}

Result<GrownPattern> PatternGrowth::grow(const PatternInputs& inputs, std::span<const FieldRef> fieldTable,
                                         bool native) {
    dispatches_ = 0;
    if (Status made = makeAtLeast(device_, status_, "pattern status", sizeof(PatternStatus)); !made)
        return made.failure();
    if (runsAtOnce(device_, native, status_)) {
        PatternInputs own = inputs;
        own.fields.v = const_cast<FieldRef*>(fieldTable.data());
        return growPatternsOnCpu(own);
    }
    const auto begin = std::chrono::steady_clock::now();
    if (Status made = makeKernels(); !made) return made.failure();
    while (true) {
        Result<PatternStatus> status = attempt(inputs, fieldTable);
        if (!status) return status.failure();
        if (Status within = withinLimits(*status, inputs.limits); !within) return within.failure();
        if (room_.holds(*status)) break;
        room_.grow(*status);
    }
    Result<GrownPattern> grown = readBack();
    if (grown)
        grown->stats.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return grown;
}

Result<std::unique_ptr<PatternGrowth>> PatternGrowth::create(Device& device) {
    return std::unique_ptr<PatternGrowth>(new PatternGrowth(device));
}

}  // namespace espalier
