// A pooled allocator: requests in, pieces of large VkDeviceMemory blocks out. Small requests share blocks of
// 64 MiB with a best-fit free list; large ones have a block each, which is kept for a later request of like size.
#include "runtime/gpu/memory.hpp"

#include <bit>
#include <cassert>
#include <cstdint>
#include <iterator>
#include <map>
#include <new>
#include <optional>
#include <string>

#include "runtime/core/platform.hpp"
#include "runtime/gpu/results.hpp"

namespace espalier {
namespace {

constexpr VkDeviceSize kBlockBytes = 64ull << 20;
constexpr VkDeviceSize kLargeBytes = kBlockBytes / 4;  // from here on: a block of its own

VkDeviceSize roundUp(VkDeviceSize value, VkDeviceSize step) {
    return (value + step - 1) / step * step;
}

struct Block {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize size = 0;
    uint32_t type = 0;
    bool image = false;
    bool shared = false;  // holds several requests
    std::byte* mapped = nullptr;
    VkDeviceSize used = 0;
    std::map<VkDeviceSize, VkDeviceSize> holes;  // offset -> size, none adjacent
};

// The hole that is left smallest, or end.
auto bestHole(Block& block, VkDeviceSize size, VkDeviceSize alignment) {
    auto best = block.holes.end();
    for (auto it = block.holes.begin(); it != block.holes.end(); ++it) {
        const bool fits = roundUp(it->first, alignment) + size <= it->first + it->second;
        if (fits && (best == block.holes.end() || it->second < best->second)) best = it;
    }
    return best;
}

// Called where nothing may be thrown: without the host's memory for it the hole is forgotten until its block is empty.
void addHole(Block& block, VkDeviceSize offset, VkDeviceSize size) noexcept {
    if (size == 0) return;
    auto next = block.holes.lower_bound(offset);
    if (next != block.holes.end() && offset + size == next->first) {
        size += next->second;
        next = block.holes.erase(next);
    }
    if (next != block.holes.begin()) {
        auto previous = std::prev(next);
        if (previous->first + previous->second == offset) {
            previous->second += size;
            return;
        }
    }
    try {
        block.holes.emplace(offset, size);
    } catch (const std::bad_alloc&) {
    }
}

class PooledMemory : public MemorySource {
  public:
    PooledMemory(const DeviceFunctions& vk, VkDevice device, const VkPhysicalDeviceMemoryProperties& properties,
                 bool software, uint64_t keepBytes)
        : vk_(vk), device_(device), properties_(properties), software_(software), keepBytes_(keepBytes) {}

    ~PooledMemory() override {
        for (auto& [token, block] : blocks_) vk_.vkFreeMemory(device_, block.memory, nullptr);
    }

    Result<MemoryBlock> allocate(const MemoryRequest& request) override {
        const std::optional<uint32_t> type = chooseType(request);
        if (!type) return deviceFailure(request.name, "no memory type of the GPU suits it");
        const VkMemoryRequirements& need = request.requirements;
        const bool shared = need.size < kLargeBytes;
        for (auto& [token, block] : blocks_) {
            if (block.type != *type || block.image != request.image || block.shared != shared) continue;
            if (!shared && (block.used > 0 || block.size > need.size + need.size / 2)) continue;
            if (auto hole = bestHole(block, need.size, need.alignment); hole != block.holes.end())
                return take(token, block, hole, need);
        }
        Block fresh;
        fresh.type = *type;
        fresh.image = request.image;
        fresh.shared = shared;
        fresh.size = shared ? kBlockBytes : roundUp(need.size, 1 << 20);
        fresh.holes.emplace(0, fresh.size);
        Blocks place;  // made before memory is taken, so that none is taken for nothing
        place.emplace(++lastToken_, std::move(fresh));
        if (const Reserving reserved = reserve(place.begin()->second); reserved.result != VK_SUCCESS)
            return reserved.mapping ? resultFailure(reserved.result, request.name, "mapping its memory")
                                    : notAllocated(reserved.result, request);
        Block& block = blocks_.insert(place.extract(place.begin())).position->second;
        return take(lastToken_, block, block.holes.begin(), need);
    }

    void free(const MemoryBlock& piece) noexcept override {
        auto it = blocks_.find(piece.token);
        assert(it != blocks_.end());  // it is from here
        if (it == blocks_.end()) return;
        Block& block = it->second;
        addHole(block, piece.offset, piece.size);
        block.used -= piece.size;
        used_ -= piece.size;
        if (block.used > 0) return;
        empty_ += block.size;
        const bool whole = block.holes.size() == 1 && block.holes.begin()->second == block.size;
        if (empty_ > keepBytes_ || !whole) release(it);
    }

    void trim() override {
        for (auto it = blocks_.begin(); it != blocks_.end();) it = it->second.used ? std::next(it) : release(it);
    }

    uint64_t bytesUsed() const override { return used_; }
    uint64_t bytesReserved() const override { return reserved_; }

  private:
    using Blocks = std::map<uint64_t, Block>;

    VkMemoryPropertyFlags flagsOf(uint32_t type) const { return properties_.memoryTypes[type].propertyFlags; }

    // The allowed type with all needed flags and the fewest unwanted ones.
    std::optional<uint32_t> chooseType(const MemoryRequest& request) const {
        constexpr VkMemoryPropertyFlags local = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
        constexpr VkMemoryPropertyFlags mapped =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        constexpr VkMemoryPropertyFlags cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        const bool device = request.use == BufferUse::device, readback = request.use == BufferUse::readback;
        const VkMemoryPropertyFlags need = device ? local : mapped;
        const VkMemoryPropertyFlags want = readback ? cached : 0;
        std::optional<uint32_t> best;
        int bestScore = 0;
        for (uint32_t i = 0; i < properties_.memoryTypeCount; ++i) {
            const VkMemoryPropertyFlags flags = flagsOf(i);
            if (!(request.requirements.memoryTypeBits >> i & 1u) || (flags & need) != need) continue;
            const VkMemoryPropertyFlags unwanted = flags & ~need & ~want;
            const int score = std::popcount(flags & want) * 100 - std::popcount(unwanted);
            if (!best || score > bestScore) best = i, bestScore = score;
        }
        return best;
    }

    struct Reserving {
        VkResult result = VK_SUCCESS;
        bool mapping = false;  // it is the result of mapping what was allocated
    };
    // Takes a block from Vulkan, after giving up empty ones if need be.
    Reserving reserve(Block& block) {
        const VkMemoryType& type = properties_.memoryTypes[block.type];
        if (block.size > properties_.memoryHeaps[type.heapIndex].size) return {VK_ERROR_OUT_OF_DEVICE_MEMORY};
        VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
        flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
        VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        info.pNext = block.image ? nullptr : &flags;
        info.allocationSize = block.size;
        info.memoryTypeIndex = block.type;
        VkResult result = vk_.vkAllocateMemory(device_, &info, nullptr, &block.memory);
        if (result != VK_SUCCESS) {
            trim();
            result = vk_.vkAllocateMemory(device_, &info, nullptr, &block.memory);
        }
        if (result != VK_SUCCESS) return {result};
        const bool mappable = (type.propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) &&
                              (type.propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        if (mappable && (software_ || !block.image)) result = map(block);
        if (result != VK_SUCCESS) {
            vk_.vkFreeMemory(device_, block.memory, nullptr);
            return {result, true};
        }
        reserved_ += block.size;
        empty_ += block.size;
        return {};
    }

    // For good, but an image's only to drop its pages.
    VkResult map(Block& block) {
        void* at = nullptr;
        const VkResult result = vk_.vkMapMemory(device_, block.memory, 0, VK_WHOLE_SIZE, 0, &at);
        if (result != VK_SUCCESS) return result;
        if (software_) platform::dropPages(at, block.size);
        if (block.image) {
            vk_.vkUnmapMemory(device_, block.memory);
        } else {
            platform::askForLargePages(at, block.size);
            block.mapped = static_cast<std::byte*>(at);
        }
        return VK_SUCCESS;
    }

    Blocks::iterator release(Blocks::iterator it) {
        vk_.vkFreeMemory(device_, it->second.memory, nullptr);
        reserved_ -= it->second.size;
        empty_ -= it->second.size;
        return blocks_.erase(it);
    }

    MemoryBlock take(uint64_t token, Block& block, std::map<VkDeviceSize, VkDeviceSize>::iterator hole,
                     const VkMemoryRequirements& need) {
        const auto [begin, size] = *hole;
        const VkDeviceSize offset = roundUp(begin, need.alignment);
        block.holes.erase(hole);
        addHole(block, begin, offset - begin);
        addHole(block, offset + need.size, begin + size - offset - need.size);
        if (block.used == 0) empty_ -= block.size;
        block.used += need.size;
        used_ += need.size;
        return {block.memory, offset, need.size, block.mapped ? block.mapped + offset : nullptr, token};
    }

    Failure notAllocated(VkResult result, const MemoryRequest& request) const {
        return resultFailure(result, request.name,
                             "allocating " + std::to_string(request.requirements.size) + " bytes, " +
                                 std::to_string(reserved_) + " taken so far");
    }

    const DeviceFunctions& vk_;
    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_;
    bool software_;
    uint64_t keepBytes_;
    Blocks blocks_;
    uint64_t lastToken_ = 0;
    uint64_t used_ = 0;
    uint64_t reserved_ = 0;
    uint64_t empty_ = 0;  // bytes of blocks without a request
};

}  // namespace

std::unique_ptr<MemorySource> makePooledMemory(const DeviceFunctions& vk, VkDevice device,
                                               const VkPhysicalDeviceMemoryProperties& properties, bool software,
                                               uint64_t keepBytes) {
    return std::make_unique<PooledMemory>(vk, device, properties, software, keepBytes);
}

}  // namespace espalier
