// In: a growth's records, or a file's bytes. Out: plants that stand by themselves, and their share of a growth that
// begins with them: records in one row, the structure's hash, counters.
#include "runtime/expand/frozen.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/core/hash.hpp"
#include "runtime/expand/growth_plan.hpp"
#include "shaders/shared/expand_avoid.h"

namespace espalier {
namespace {

// The head of a packed plant; then nodes, chunks, branches, leaves.
struct PlantHead {
    char magic[8] = {'e', 's', 'p', 'l', 'a', 'n', 't', '1'};  // the last: version of the records
    uint32_t nodes = 0, chunks = 0, branches = 0, leaves = 0;
    uint64_t hash = 0;  // of all that follows
};

uint64_t recordBytes(const PlantHead& h) {
    return uint64_t(h.nodes) * sizeof(Node) + uint64_t(h.chunks) * sizeof(Chunk) +
           uint64_t(h.branches) * sizeof(BranchRecord) + uint64_t(h.leaves) * sizeof(Leaf);
}

void moveIndex(uint32_t& index, size_t by) {
    if (index != kNoIndex) index += uint32_t(by);
}

template <class T>
void append(std::vector<T>& to, const std::vector<T>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

// Appends a plant whose seed is to have the index `seed`.
void append(GrowthRecords& to, PlantRecords plant, uint32_t seed) {
    shiftRecords(plant, uint32_t(to.nodes.size()), uint32_t(to.chunks.size()), uint32_t(to.branches.size()));
    for (Chunk& c : plant.chunks)
        if (c.branch == kNoIndex) c.firstNode = seed;
    for (BranchRecord& b : plant.branches) b.seed = seed;
    append(to.nodes, plant.nodes);
    append(to.chunks, plant.chunks);
    append(to.branches, plant.branches);
    append(to.leaves, plant.leaves);
}

template <class T>
std::byte* put(std::byte* to, const std::vector<T>& values) {
    if (!values.empty()) std::memcpy(to, values.data(), values.size() * sizeof(T));
    return to + values.size() * sizeof(T);
}
template <class T>
void take(std::span<const std::byte>& from, std::vector<T>& to, uint32_t count) {
    to.resize(count);
    if (count > 0) std::memcpy(to.data(), from.data(), count * sizeof(T));
    from = from.subspan(count * sizeof(T));
}

// A frozen plant is never looked at for an edit, so its file holds no read sets. Files of before hold some in another
// form, which are left out as well.
std::vector<Chunk> withoutReads(std::vector<Chunk> chunks) {
    for (Chunk& chunk : chunks) {
        chunk.marks &= ~kReadLevelBits;
        std::ranges::fill(chunk.reads, 0u);
    }
    return chunks;
}

constexpr float kFarthest = 1e9f;  // metres from a surface's origin
constexpr float kThickest = 1e3f;  // metres; no terminal makes a larger radius

// Whether what is worked out from its numbers is finite.
bool sound(const Node& n) {
    const float away = std::abs(n.position.x) + std::abs(n.position.y) + std::abs(n.position.z);
    return away <= kFarthest && n.radius >= 0 && n.radius <= kThickest && std::isfinite(n.arc);
}

// Links lead to records that exist, each node is one chunk's, chunks' nodes are in a row and know it, parents and the
// nodes that chunks start from come from elsewhere than below, branches are their chunks'.
bool sound(const PlantRecords& p, uint32_t surfaces) {
    const auto none = [](uint32_t index, size_t count) { return index == kNoIndex || index < count; };
    const auto depth = [&](uint32_t chunk) { return p.chunks[chunk].depth >> 16; };
    for (const Node& n : p.nodes)
        if (n.chunk >= p.chunks.size() || (n.place >> 16) >= surfaces || !sound(n)) return false;
    std::vector<uint32_t> linked(p.chunks.size(), 0);  // times that the chunk is somebody's child or sibling
    size_t nodes = 0;                                  // of chunks so far
    for (size_t i = 0; i < p.chunks.size(); ++i) {
        const Chunk& c = p.chunks[i];
        const uint32_t count = chunkNodes(c.marks);
        for (uint32_t link : {c.parent, c.next, c.firstChild, c.nextSibling})
            if (!none(link, p.chunks.size())) return false;
        if (!none(c.previousNode, p.nodes.size()) || !none(c.branch, p.branches.size())) return false;
        if ((c.marks & kChunkPublished) == 0 || count > kChunkNodes || (count > 0 && c.branch == kNoIndex))
            return false;
        if (count > 0 && (c.firstNode > p.nodes.size() || p.nodes.size() - c.firstNode < count)) return false;
        for (uint32_t k = 0; k < count; ++k)
            if (const Node& n = p.nodes[c.firstNode + k]; n.chunk != i || (n.flags >> 8 & 31u) != k) return false;
        nodes += count;
        if (!std::isfinite(c.entry.uv.x + c.entry.uv.y)) return false;
        for (uint32_t link : {c.firstChild, c.nextSibling})
            if (link != kNoIndex && ++linked[link] > 1) return false;
        // Further away from the seed each, so that no way along links has no end: by a step, and one for each try.
        const uint32_t own = c.depth >> 16;
        for (uint32_t link : {c.next, c.firstChild})
            if (link != kNoIndex &&
                (p.chunks[link].parent != i || depth(link) <= own || depth(link) > own + 1 + kMostTries))
                return false;
        if (c.next != kNoIndex && p.chunks[c.next].branch != c.branch) return false;
        if (c.nextSibling != kNoIndex && p.chunks[c.nextSibling].parent != c.parent) return false;
        if (c.parent != kNoIndex && depth(c.parent) >= c.depth >> 16) return false;
        if (c.previousNode != kNoIndex && depth(p.nodes[c.previousNode].chunk) >= c.depth >> 16) return false;
    }
    if (nodes != p.nodes.size()) return false;
    for (size_t b = 0; b < p.branches.size(); ++b) {
        const uint32_t first = p.branches[b].firstChunk;
        if (first >= p.chunks.size() || chunkNodes(p.chunks[first].marks) == 0 || p.chunks[first].branch != b)
            return false;
    }
    for (const Leaf& l : p.leaves)
        if (l.node >= p.nodes.size()) return false;
    return true;
}

}  // namespace

PlantRecords plantOf(const GrowthRecords& growth, uint32_t seed) {
    PlantRecords plant = growth;
    const auto theirs = [&](const Chunk& c) {
        return (c.branch == kNoIndex ? c.firstNode : growth.branches[c.branch].seed) == seed;
    };
    for (Leaf& l : plant.leaves)
        if (!theirs(growth.chunks[growth.nodes[l.node].chunk])) l.node = kNoIndex;
    for (Node& n : plant.nodes)
        if (!theirs(growth.chunks[n.chunk])) n.radius = -1;
    for (BranchRecord& b : plant.branches)
        if (b.seed != seed) b.firstChunk = kNoIndex;
    for (Chunk& c : plant.chunks)
        if (!theirs(c)) c.marks = 0;
    compactRecords(plant);
    for (BranchRecord& b : plant.branches) b.seed = 0;
    for (Chunk& c : plant.chunks) {
        if (c.branch == kNoIndex) c.firstNode = 0;
        if (c.parent == kNoIndex) c.nextSibling = kNoIndex;
    }
    return plant;
}

void shiftRecords(GrowthRecords& records, uint32_t nodes, uint32_t chunks, uint32_t branches) {
    for (Node& n : records.nodes) moveIndex(n.chunk, chunks);
    for (Chunk& c : records.chunks) {
        for (uint32_t* link : {&c.parent, &c.next, &c.firstChild, &c.nextSibling}) moveIndex(*link, chunks);
        moveIndex(c.previousNode, nodes);
        if (c.branch != kNoIndex) c.firstNode += nodes;  // else it is the seed's index
        moveIndex(c.branch, branches);
    }
    for (BranchRecord& b : records.branches) moveIndex(b.firstChunk, chunks);
    for (Leaf& l : records.leaves) moveIndex(l.node, nodes);
}

FrozenSum sumOf(std::span<const FrozenPlant> plants, uint32_t firstSeed) {
    FrozenSum sum;
    GrowthRecords& r = sum.records;
    for (size_t i = 0; i < plants.size(); ++i) append(r, *plants[i].records, firstSeed + uint32_t(i));
    uvec2 hash(0, 0);
    uint32_t feet = 0;
    for (const Node& n : r.nodes) {
        hash += hashOfNode(r.chunks[n.chunk].key, n);
        sum.inserted += (n.flags & kNodeInserted) != 0 ? 1 : 0;
    }
    for (const Leaf& l : r.leaves) hash += hashOfLeaf(r.chunks[r.nodes[l.node].chunk].key, r.nodes[l.node].flags, l);
    for (const Chunk& c : r.chunks) {
        feet += chunkNodes(c.marks) > 0 && c.previousNode == kNoIndex ? 1 : 0;
        sum.stopped += (c.step >> 24) + ((c.marks & kChunkStopped) != 0 ? 1 : 0);
        sum.deadEnds += (c.marks & kChunkDeadEnd) != 0 ? 1 : 0;
    }
    sum.steps = uint32_t(r.nodes.size()) - sum.inserted - feet;
    sum.hash[0] = hash.x;
    sum.hash[1] = hash.y;
    return sum;
}

std::vector<std::byte> packPlant(const PlantRecords& p) {
    PlantHead head;
    head.nodes = uint32_t(p.nodes.size());
    head.chunks = uint32_t(p.chunks.size());
    head.branches = uint32_t(p.branches.size());
    head.leaves = uint32_t(p.leaves.size());
    std::vector<std::byte> bytes(sizeof head + recordBytes(head));
    std::byte* at = bytes.data() + sizeof head;
    at = put(at, p.nodes);
    at = put(at, withoutReads(p.chunks));
    at = put(at, p.branches);
    put(at, p.leaves);
    head.hash = hashBytes(std::span(bytes).subspan(sizeof head));
    std::memcpy(bytes.data(), &head, sizeof head);
    return bytes;
}

Result<PlantRecords> unpackPlant(std::span<const std::byte> bytes, uint32_t surfaces) {
    const PlantHead wanted;
    PlantHead head;
    if (bytes.size() < sizeof head) return Failure("plant", "too short for a frozen plant");
    std::memcpy(&head, bytes.data(), sizeof head);
    if (std::memcmp(head.magic, wanted.magic, sizeof head.magic) != 0)
        return Failure("plant", "not a frozen plant, or one of another version");
    bytes = bytes.subspan(sizeof head);
    const uint64_t size = recordBytes(head);
    if (bytes.size() != size)
        return Failure("plant", std::to_string(bytes.size()) + " bytes of records where " + std::to_string(size) +
                                    " are announced");
    if (hashBytes(bytes) != head.hash) return Failure("plant", "its bytes have changed since it was packed");
    PlantRecords plant;
    take(bytes, plant.nodes, head.nodes);
    take(bytes, plant.chunks, head.chunks);
    plant.chunks = withoutReads(std::move(plant.chunks));
    take(bytes, plant.branches, head.branches);
    take(bytes, plant.leaves, head.leaves);
    if (!sound(plant, surfaces))
        return Failure("plant", "its records contradict each other, or their surface is missing");
    return plant;
}

}  // namespace espalier
