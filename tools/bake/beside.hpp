#pragma once

#include <system_error>
#include <thread>

namespace espalier::bakery {

// Does both at once, the second one on this thread, and returns when both are done. Neither may throw.
template <class First, class Second>
void beside(First&& first, Second&& second) {
    std::jthread other;
    try {
        other = std::jthread(first);
    } catch (const std::system_error&) {  // no thread is left to give
        first();
    }
    second();
}

}  // namespace espalier::bakery
