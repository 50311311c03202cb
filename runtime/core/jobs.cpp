// Pieces of a range, taken by threads from one counter.
#include "runtime/core/jobs.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace espalier {

void parallelFor(size_t count, size_t grain, const std::function<void(size_t begin, size_t end)>& body,
                 unsigned threads) {
    grain = std::max<size_t>(grain, 1);
    const size_t pieces = count / grain + (count % grain != 0);
    const size_t machine = std::max(1u, threads ? threads : std::thread::hardware_concurrency());
    std::atomic<size_t> next = 0;
    auto work = [&] {
        for (size_t piece = next++; piece < pieces; piece = next++)
            body(piece * grain, std::min(count, (piece + 1) * grain));
    };
    std::vector<std::jthread> others;
    try {
        for (size_t i = 1; i < std::min(machine, pieces); ++i) others.emplace_back(work);
    } catch (const std::exception&) {
        // The machine has no thread left to give: those that there are do the work.
    }
    work();
}

}  // namespace espalier
