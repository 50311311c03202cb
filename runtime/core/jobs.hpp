#pragma once

#include <cstddef>
#include <functional>

namespace espalier {

// Calls body(begin, end) over [0, count) in pieces of at most `grain`, on up to `threads` threads (0: as many as
// the machine has), the calling one among them, and returns when all pieces are done. The cut into pieces doesn't
// depend on the number of threads; their order does. body must not throw.
void parallelFor(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body,
                 unsigned threads = 0);

}  // namespace espalier
