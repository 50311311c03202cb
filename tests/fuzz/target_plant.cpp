// In: bytes. Out: nothing, if all goes well; a plant that is accepted packs to the same bytes and can be grown on.
#include <algorithm>
#include <cstring>
#include <vector>

#include "runtime/core/hash.hpp"
#include "runtime/expand/frozen.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {
namespace {

constexpr size_t kCountsAt = 8, kHashAt = 24, kHead = 32;

// The same with counts that fit its size and the hash that belongs to it: nearly every change would else be refused
// for these alone.
std::vector<std::byte> repaired(std::span<const std::byte> bytes) {
    std::vector<std::byte> out(bytes.begin(), bytes.end());
    const size_t sizes[] = {sizeof(Node), sizeof(Chunk), sizeof(BranchRecord), sizeof(Leaf)};
    size_t used = kHead;
    for (size_t i = 0; i < 4; ++i) {
        uint32_t count = 0;
        std::memcpy(&count, out.data() + kCountsAt + 4 * i, sizeof count);
        count = uint32_t(std::min<size_t>(count, (out.size() - used) / sizes[i]));
        std::memcpy(out.data() + kCountsAt + 4 * i, &count, sizeof count);
        used += count * sizes[i];
    }
    out.resize(used);
    const uint64_t hash = hashBytes(std::span(out).subspan(kHead));
    std::memcpy(out.data() + kHashAt, &hash, sizeof hash);
    return out;
}

void check(std::span<const std::byte> bytes) {
    auto plant = unpackPlant(bytes, 3);
    if (!plant) return checkMessage(plant.failure());
    require(std::ranges::equal(packPlant(*plant), bytes), "a plant packs to what it was");
    const auto records = std::make_shared<const PlantRecords>(std::move(*plant));
    const FrozenPlant twice[] = {{1, records}, {2, records}};
    require(sumOf(twice, 5).records.nodes.size() == 2 * records->nodes.size(), "plants stand side by side");
}

}  // namespace

void plant(Bytes bytes) {
    const auto all = std::as_bytes(bytes);
    check(all);
    if (all.size() >= kHead) check(repaired(all));
}

}  // namespace espalier::fuzz
