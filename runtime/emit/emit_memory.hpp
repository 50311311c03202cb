#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "runtime/gpu/buffer.hpp"

namespace espalier {

// How many instances of `instanceBytes` each bound growth gets room for that has `count` of them. spare: for twice as
// many, where memory that isn't touched costs nothing, since what outgrows its room is copied whole; but no more than
// a buffer of `mostBytes` holds, unless there are more already.
constexpr uint64_t instanceRoom(uint64_t count, uint64_t instanceBytes, uint64_t mostBytes, bool spare) {
    return spare ? std::max(count, std::min(2 * count, mostBytes / instanceBytes)) : count;
}

// A new buffer in place of what was there. texels: null, or the view of four words a texel that goes with it.
inline Status makeRoom(Device& device, Buffer& buffer, std::string_view name, uint64_t bytes,
                       TexelView* texels = nullptr) {
    if (texels) return makeTexels(device, name, bytes, VK_FORMAT_R32G32B32A32_UINT, buffer, *texels);
    return assign(buffer, Buffer::create(device, name, bytes));
}

}  // namespace espalier
