#pragma once

// Buffers of a growth, and how much room there is in them.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "runtime/gpu/buffer.hpp"

namespace espalier {

// One of two sets of buffers is drawn. A growth writes the other one, so that what is drawn stands until it is
// complete.
template <class Set>
struct DoubleBuffered {
    Set sets[2];
    uint32_t front = 0;
    Set& drawn() { return sets[front]; }
    Set& spare() { return sets[1 - front]; }
    const Set& drawn() const { return sets[front]; }
    const Set& spare() const { return sets[1 - front]; }
    void swap() { front = 1 - front; }
};

// Has at least so many bytes, or is made anew, without what was in it. What was there goes before, since there may be
// no room beside it: on failure nothing is left.
inline Status ensureRoom(Device& device, Buffer& buffer, const char* name, uint64_t bytes,
                         BufferUse use = BufferUse::device) {
    if (buffer.size() < bytes) buffer = {};
    return makeAtLeast(device, buffer, name, bytes, use);
}

// After growth that needed more: room for what was needed last and half as much again, but no less than `least`.
inline void shrinkRoom(uint32_t& room, uint32_t needed, uint32_t least) {
    room = uint32_t(std::min<uint64_t>(room, std::max<uint64_t>(needed + needed / 2ull, least)));
}

// Waits for all submitted work and copies the first `count` records.
template <class T>
Status readRecords(Device& device, const Buffer& buffer, uint32_t count, std::vector<T>& records) {
    records.clear();
    return count == 0 ? Status(Done{}) : assign(records, readVector<T>(device, buffer, 0, count));
}

}  // namespace espalier
