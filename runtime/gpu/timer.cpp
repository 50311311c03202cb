// Passes in, milliseconds out, some submissions later.
#include "runtime/gpu/timer.hpp"

#include <algorithm>
#include <array>
#include <new>

namespace espalier {
namespace {
constexpr uint32_t kNoMark = 0xFFFFFFFFu;
}

TimerRing::~TimerRing() {
    for (Pool& pool : pools_) device_.vk().vkDestroyQueryPool(device_.handle(), pool.queries, nullptr);
}

uint32_t TimerRing::poolFor(VkCommandBuffer commands, uint64_t serial, bool again) {
    for (uint32_t i = 0; i < pools_.size(); ++i) {
        if (pools_[i].serial != serial) continue;
        if (pools_[i].names.size() < kPairs) return i;
        if (again) return kNoMark;  // it may be within rendering now, where no other pool can be reset
    }
    auto vacant = std::ranges::find(pools_, 0u, &Pool::serial);
    if (vacant == pools_.end()) {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = kPairs * 2;
        Pool pool;
        if (!device_.succeeded(device_.vk().vkCreateQueryPool(device_.handle(), &info, nullptr, &pool.queries)))
            return kNoMark;
        device_.setName(VK_OBJECT_TYPE_QUERY_POOL, uint64_t(pool.queries), "timers");
        pools_.push_back(std::move(pool));
        vacant = pools_.end() - 1;
    }
    device_.vk().vkResetQueryPool(device_.handle(), vacant->queries, 0, kPairs * 2);
    if (again) device_.vk().vkCmdResetQueryPool(commands, vacant->queries, 0, kPairs * 2);
    vacant->serial = serial;
    return uint32_t(vacant - pools_.begin());
}

uint32_t TimerRing::start(VkCommandBuffer commands, uint64_t serial, std::string_view name, bool again) {
    if (device_.info().timestampNanoseconds == 0) return kNoMark;
    const uint32_t index = poolFor(commands, serial, again);
    if (index == kNoMark) return kNoMark;
    Pool& pool = pools_[index];
    const uint32_t pair = uint32_t(pool.names.size());
    pool.names.emplace_back(name);
    device_.vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool.queries, pair * 2);
    return index * kPairs + pair;
}

void TimerRing::stop(VkCommandBuffer commands, uint32_t mark) {
    if (mark == kNoMark) return;
    device_.vk().vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pools_[mark / kPairs].queries,
                                      mark % kPairs * 2 + 1);
}

void TimerRing::collect(uint64_t oldestPending) noexcept {
    const bool atWork = std::ranges::any_of(pools_, [&](const Pool& pool) { return pool.serial >= oldestPending; });
    for (Pool& pool : pools_) {
        if (pool.serial == 0 || pool.serial >= oldestPending) continue;
        try {
            if (!atWork || !device_.info().cpu) read(pool);
        } catch (const std::bad_alloc&) {
        }
        setFree(pool);
    }
}

void TimerRing::read(Pool& pool) {
    struct Stamp {
        uint64_t ticks, available;
    };
    std::array<Stamp, kPairs * 2> stamps{};
    const uint32_t count = uint32_t(pool.names.size()) * 2;
    const VkResult result = device_.vk().vkGetQueryPoolResults(
        device_.handle(), pool.queries, 0, count, count * sizeof(Stamp), stamps.data(), sizeof(Stamp),
        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WITH_AVAILABILITY_BIT);
    for (uint32_t i = 0; i < pool.names.size() && result >= 0; ++i) {  // a discarded recording has written none
        const Stamp &begin = stamps[i * 2], &end = stamps[i * 2 + 1];
        if (begin.available && end.available && end.ticks >= begin.ticks)
            record(pool.names[i], double(end.ticks - begin.ticks) * device_.info().timestampNanoseconds * 1e-6,
                   pool.serial);
    }
}

void TimerRing::setFree(Pool& pool) {
    pool.serial = 0;
    pool.names.clear();
}

void TimerRing::record(const std::string& name, double milliseconds, uint64_t serial) {
    auto known = std::ranges::find(times_, name, &PassTime::name);
    if (known == times_.end())
        times_.push_back({name, milliseconds, serial});
    else if (known->submission == serial)
        known->milliseconds += milliseconds;
    else if (known->submission < serial)
        *known = {name, milliseconds, serial};
}

}  // namespace espalier
