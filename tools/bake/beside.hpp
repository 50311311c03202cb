#pragma once

#include <exception>
#include <system_error>
#include <thread>

namespace espalier::bakery {

// Does both at once, the second one on this thread, and returns when both are done. What they throw is thrown here
// then; of both, what the second one did.
template <class First, class Second>
void beside(First&& first, Second&& second) {
    std::exception_ptr thrown;
    const auto caught = [&] {
        try {
            first();
        } catch (...) {
            thrown = std::current_exception();
        }
    };
    {
        std::jthread other;  // joined at the end of the block
        try {
            other = std::jthread(caught);
        } catch (const std::system_error&) {  // no thread is left to give
            caught();
        }
        second();
    }
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace espalier::bakery
