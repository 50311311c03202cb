// Numbers in a ring; how many contexts have each.
#include "runtime/plugin/context_number.hpp"

#include <array>
#include <mutex>

namespace espalier {
namespace {

constexpr uint32_t kNumbers = 1u << kContextBits;

// A process's contexts know nothing of each other but this.
struct Numbers {
    std::mutex lock;
    std::array<uint32_t, kNumbers> users{};
    uint32_t next = 0;
};
Numbers& numbers() {
    static Numbers all;
    return all;
}

}  // namespace

ContextNumber::ContextNumber() {
    Numbers& all = numbers();
    const std::lock_guard guard(all.lock);
    number_ = all.next;
    for (uint32_t i = 0; i < kNumbers; ++i) {
        const uint32_t candidate = (all.next + i) % kNumbers;
        if (all.users[candidate] < all.users[number_]) number_ = candidate;
    }
    ++all.users[number_];
    all.next = (number_ + 1) % kNumbers;
}

ContextNumber::~ContextNumber() {
    Numbers& all = numbers();
    const std::lock_guard guard(all.lock);
    --all.users[number_];
}

}  // namespace espalier
