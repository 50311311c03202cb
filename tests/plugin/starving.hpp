#pragma once

// Want of the host's own memory, which a thread of this program can be made to meet.

#include <cstdint>

namespace espalier {

inline constexpr uint32_t kPlenty = UINT32_MAX;
extern constinit thread_local uint32_t allocationsLeft;  // pieces of memory that this thread may still have
extern constinit thread_local uint32_t refusals;

// What the call returns where the thread gets no more than `pieces` of memory.
template <class Call>
auto with(uint32_t pieces, const Call& call) {
    allocationsLeft = pieces;
    const auto result = call();
    allocationsLeft = kPlenty;
    return result;
}

}  // namespace espalier
