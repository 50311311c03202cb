#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/gpu/device.hpp"

namespace espalier {

// Timestamp pairs of passes, in query pools that go round: one or more belong to a recording until it has finished.
class TimerRing {
  public:
    explicit TimerRing(Device& device) : device_(device) {}
    ~TimerRing();
    TimerRing(const TimerRing&) = delete;
    TimerRing& operator=(const TimerRing&) = delete;

    // Writes the first timestamp and returns a mark for stop(). Without timestamps both do nothing. again: the
    // recording may be submitted several times; then its first pass isn't within rendering.
    uint32_t start(VkCommandBuffer commands, uint64_t serial, std::string_view name, bool again);
    void stop(VkCommandBuffer commands, uint32_t mark);
    // Reads the pools of all recordings before `oldestPending` and sets them free. A software device that is at work
    // lets nobody read before it is done: times are those of a recording that nothing was recorded beside, then.
    // Times that the host has no memory for are lost: work that has been submitted can't fail any more.
    void collect(uint64_t oldestPending) noexcept;
    const std::vector<PassTime>& times() const { return times_; }

  private:
    static constexpr uint32_t kPairs = 64;  // passes a pool
    struct Pool {
        VkQueryPool queries = VK_NULL_HANDLE;
        uint64_t serial = 0;  // of its recording, 0: free
        std::vector<std::string> names;
    };
    uint32_t poolFor(VkCommandBuffer commands, uint64_t serial, bool again);
    void read(Pool& pool);
    static void setFree(Pool& pool);
    void record(const std::string& name, double milliseconds, uint64_t serial);

    Device& device_;
    std::vector<Pool> pools_;
    std::vector<PassTime> times_;
};

}  // namespace espalier
