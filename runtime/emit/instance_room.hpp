#pragma once

#include <algorithm>
#include <cstdint>

namespace espalier {

// How many instances of `instanceBytes` each bound growth gets room for that has `count` of them. spare: for twice as
// many, where memory that isn't touched costs nothing, since what outgrows its room is copied whole; but no more than
// a buffer of `mostBytes` holds, unless there are more already.
constexpr uint64_t instanceRoom(uint64_t count, uint64_t instanceBytes, uint64_t mostBytes, bool spare) {
    return spare ? std::max(count, std::min(2 * count, mostBytes / instanceBytes)) : count;
}

}  // namespace espalier
