// Closing the gaps that edits have left. In: what is drawn. Out: its nodes and leaves without gaps, where all anew
// would be ten times the work. Chunks and branches keep their places, until all grows anew. Native code moves nodes and
// leaves up in place; kernels copy them to the other set of buffers, which is drawn from then on.
#include <string>

#include "runtime/expand/growth.hpp"

namespace espalier {

// In place gaps are closed before room runs out: an edit that finds none is done twice, and fresh memory costs far more
// than closing does. Kernels copy all, which is the better the later.
bool Growth::gappy(const GrowthInputs& inputs) const {
    const bool inPlace = atOnce(inputs);
    const auto wide = [&](uint32_t taken, uint32_t live, uint64_t room) {
        const uint32_t gaps = taken - std::min(taken, live);
        const bool scarce = inPlace && room - std::min<uint64_t>(room, taken) < live / 16;
        return gaps > taken / (inPlace ? 4 : 3) || (scarce && gaps > live / 32);
    };
    const Plants& plants = plants_.drawn();
    return wide(view_.nodeCount, stats_.nodes, capacityOf<Node>(plants.nodes)) ||
           wide(view_.leafCount, stats_.leaves, capacityOf<Leaf>(plants.leaves));
}

// Chunks and branches leave gaps more slowly, which only a full growth closes, the longest wait of a stroke: when of
// either there are three for each that stands, and more than there is room for to begin with.
bool Growth::gappyLinks() const {
    const auto wide = [](uint32_t taken, uint32_t live, uint32_t least) { return taken > least && taken / 4 > live; };
    return wide(view_.chunkCount, stats_.chunks, least_.chunks) ||
           wide(view_.branchCount, stats_.branches, least_.branches);
}

Status Growth::compact(const GrowthInputs& inputs) {
    view_.moved = {};  // what it says is written over, and may get no room again
    if (Status ok = ensure(nodesWent_, "growth where nodes went", capacityOf<Node>(*view_.nodeBuffer) * 4ull); !ok)
        return ok;
    if (Status ok = ensure(leavesWent_, "growth where leaves went", capacityOf<Leaf>(*view_.leafBuffer) * 4ull); !ok)
        return ok;
    const bool inPlace = atOnce(inputs);
    if (Status room = inPlace ? Status(Done{}) : makeCopyRoom(); !room) return room;
    Result<GrowStatus> moved = closeGaps(inPlace);
    if (!moved) return moved.failure();
    if (Status right = checkMoved(moved->nodes, moved->leaves); !right) return right;
    if (!inPlace) {
        plants_.swap();
        links_.swap();
        chained_ = false;
    }
    showMoved(moved->nodes, moved->leaves);
    if (inPlace) (void)enlarge();  // where there isn't memory, what room there is may do
    stats_.reservedBytes = reserved();
    return Done{};
}

// As many nodes and leaves stay when gaps are closed as there were. Else a driver's kernels have counted wrong, and all
// grows anew.
Status Growth::checkMoved(uint32_t nodes, uint32_t leaves) {
    if (nodes == stats_.nodes && leaves == stats_.leaves) return Done{};
    whole_ = false;
    return deviceFailure("growth",
                         "the GPU counts " + std::to_string(nodes) + " nodes and " + std::to_string(leaves) +
                             " leaves where " + std::to_string(stats_.nodes) + " and " + std::to_string(stats_.leaves) +
                             " have grown",
                         Failure::Cause::driver);
}

// Nodes and leaves are so many now.
void Growth::showMoved(uint32_t nodes, uint32_t leaves) {
    const GrowthMove moved{&nodesWent_, &leavesWent_, view_.nodeCount, view_.leafCount, nodes, leaves};
    GrowStatus status{};
    status.nodes = nodes;
    status.leaves = leaves;
    status.chunks = view_.chunkCount;
    status.branches = view_.branchCount;
    show(status, true);
    view_.moved = moved;
    // What it says of earlier growths is of no account any more.
    if (touched_ && !touchedIsNew_) view_.touched = &touched_;
}

// For all that there is, and half as much again.
Status Growth::makePlantRoom(Plants& plants) {
    const auto roomy = [](uint32_t taken, uint32_t live, uint32_t room) {
        return std::max<uint64_t>({taken, live + live / 2ull, room});
    };
    const uint64_t nodes = roomy(view_.nodeCount, stats_.nodes, room_.nodes);
    if (Status ok = ensure(plants.nodes, "growth nodes", wholeTexels(nodes * sizeof(Node))); !ok) return ok;
    return ensure(plants.leaves, "growth leaves", roomy(view_.leafCount, stats_.leaves, room_.leaves) * sizeof(Leaf));
}

// Where what has grown leaves too little room: the same in the other set of buffers, with more.
Status Growth::enlarge() {
    const Plants& now = plants_.drawn();
    const auto suffices = [](uint64_t capacity, uint32_t live, uint32_t room) {
        return capacity >= std::max<uint64_t>(live + live / 8ull, room);
    };
    if (suffices(capacityOf<Node>(now.nodes), stats_.nodes, room_.nodes) &&
        suffices(capacityOf<Leaf>(now.leaves), stats_.leaves, room_.leaves))
        return Done{};
    return movePlants();
}

// From the one buffer into the other, once all that reads or writes them is done.
Status Growth::copyOver(std::initializer_list<Copied> pairs) {
    Result<Commands> commands = Commands::begin(device_, "move growth");
    if (!commands) return commands.failure();
    for (const Copied& pair : pairs) commands->copy(pair.from, pair.to, pair.bytes);
    return commands->finish();
}

// Nodes and leaves to the other set of buffers, with the room that edits ask for.
Status Growth::movePlants() {
    const Plants& now = plants_.drawn();
    Plants& to = plants_.spare();
    if (Status ok = makePlantRoom(to); !ok) return ok;
    const Status copied = copyOver({{now.nodes, to.nodes, view_.nodeCount * sizeof(Node)},
                                    {now.leaves, to.leaves, view_.leafCount * sizeof(Leaf)}});
    if (!copied) return copied;
    plants_.swap();
    lookAtFront();
    return Done{};
}

Status Growth::moveLinks() {
    const Links& now = links_.drawn();
    Links& to = links_.spare();
    const AgainBytes bytes = againBytes(now);
    if (Status ok = ensure(to.chunks, "growth chunks", bytes.chunks); !ok) return ok;
    if (Status ok = ensure(to.branches, "growth branches", bytes.branches); !ok) return ok;
    const Status copied = copyOver({{now.chunks, to.chunks, view_.chunkCount * sizeof(Chunk)},
                                    {now.branches, to.branches, view_.branchCount * sizeof(BranchRecord)}});
    if (!copied) return copied;
    links_.swap();
    lookAtFront();
    return Done{};
}

// After growth that needed far more, what stands moves to buffers of its own size, if that frees more than a block of
// memory that it may take. Nothing is left of the other set of nodes and leaves.
Status Growth::shrink() {
    constexpr uint64_t kFarMore = 4, kWorth = 64 << 20;
    const auto vast = [](const Buffer& buffer, uint64_t taken) {
        return buffer.size() > kWorth && buffer.size() / kFarMore > taken;
    };
    const Plants& plants = plants_.drawn();
    const bool moves =
        vast(plants.nodes, view_.nodeCount * sizeof(Node)) || vast(plants.leaves, view_.leafCount * sizeof(Leaf));
    plants_.spare() = {};
    const Status moved = moves ? movePlants() : Done{};
    plants_.spare() = {};
    if (!moved || !vast(links_.drawn().chunks, view_.chunkCount * sizeof(Chunk))) return moved;
    links_.spare() = {};
    return moveLinks();
}

Status Growth::makeCopyRoom() {
    Plants& plants = plants_.spare();
    Links& links = links_.spare();
    const Links& linksNow = links_.drawn();
    return allDone(
        {makePlantRoom(plants),
         ensure(links.chunks, "growth chunks",
                std::max<uint64_t>(linksNow.chunks.size(), room_.chunks * uint64_t(sizeof(Chunk)))),
         ensure(links.branches, "growth branches",
                std::max<uint64_t>(linksNow.branches.size(), room_.branches * uint64_t(sizeof(BranchRecord))))});
}

CompactEnv Growth::compactEnvironment(bool inPlace) const {
    CompactEnv env{};
    env.nodes = view_.nodes;
    env.leaves = view_.leaves;
    env.chunks = view_.chunks;
    env.toNodes = inPlace ? env.nodes : addressOf<NodeBuf>(plants_.spare().nodes);
    env.toLeaves = inPlace ? env.leaves : addressOf<LeafBuf>(plants_.spare().leaves);
    env.toChunks = inPlace ? env.chunks : addressOf<ChunkBuf>(links_.spare().chunks);
    env.nodesWent = addressOf<UintBuf>(nodesWent_);
    env.leavesWent = addressOf<UintBuf>(leavesWent_);
    env.status = addressOf<GrowStatusBuf>(status_);
    if (chained_) {
        env.firstLeaves = addressOf<UintBuf>(firstLeaves_);
        env.nextLeaves = addressOf<UintBuf>(nextLeaves_);
    }
    env.chunkCount = view_.chunkCount;
    env.leafCount = view_.leafCount;
    env.nodeCount = view_.nodeCount;
    return env;
}

// Returns counts of nodes and leaves. In place nothing fails on the way: see regrow().
Result<GrowStatus> Growth::closeGaps(bool inPlace) {
    const Links &links = links_.spare(), &linksNow = links_.drawn();
    Result<Run> run = Run::begin(runner_, "close gaps", inPlace);
    if (!run) return run.failure();
    if (Status up = run->send().upload(status_, std::vector<GrowStatus>(1)); !up) return up.failure();
    if (!inPlace) {
        run->send().copy(linksNow.chunks, links.chunks, view_.chunkCount * sizeof(Chunk));
        run->send().copy(linksNow.branches, links.branches, view_.branchCount * sizeof(BranchRecord));
        run->send().fill(nodesWent_, kNoIndex);
    }
    const CompactEnv env = compactEnvironment(inPlace);
    run->readBack(status_, sizeof(GrowStatus));
    if (Status closed = run->add(inPlace ? closingStages(env) : compactionStages(shaders(), env)); !closed)
        return closed.failure();
    if (Status finished = run->finish(); !finished) return finished.failure();
    return *run->got<GrowStatus>(0);
}

}  // namespace espalier
