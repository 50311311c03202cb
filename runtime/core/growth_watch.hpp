#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <thread>
#include <utility>

#include "runtime/core/result.hpp"

namespace espalier {

// Who waits for growth that takes long: is told now and then how far it is, and may give it up. begin(), stopped() and
// what it asks are on the thread of Growth::grow(); look() is called by all threads of a growth.
class GrowthWatch {
  public:
    // With the nodes grown so far; false: growth is given up.
    using GoesOn = std::function<bool(uint64_t nodes)>;

    explicit GrowthWatch(GoesOn goesOn, std::chrono::milliseconds every = std::chrono::milliseconds(100))
        : goesOn_(std::move(goesOn)), every_(every) {}

    // Of a growth.
    void begin() {
        own_ = std::this_thread::get_id();
        next_ = Clock::now() + every_;
        stopped_ = false;
    }
    // Asks if it is time to. False: nothing more is begun.
    bool look(uint64_t nodes) {
        if (std::this_thread::get_id() == own_ && !stopped() && Clock::now() >= next_) {
            if (!goesOn_(nodes)) stopped_ = true;
            next_ = Clock::now() + every_;
        }
        return !stopped();
    }
    bool stopped() const { return stopped_.load(std::memory_order_relaxed); }

  private:
    using Clock = std::chrono::steady_clock;
    GoesOn goesOn_;
    std::chrono::milliseconds every_;
    std::thread::id own_;
    Clock::time_point next_;
    std::atomic<bool> stopped_ = false;
};

// Where nobody may watch, growth goes on.
inline bool goesOn(GrowthWatch* watch, uint64_t nodes) {
    return !watch || watch->look(nodes);
}

inline Failure stoppedFailure() {
    return Failure("growth", "growth was stopped; what was grown before stands");
}

}  // namespace espalier
