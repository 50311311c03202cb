// In place of the library's: operators that refuse what a thread may not have.
#include "tests/plugin/starving.hpp"

#include <cstdlib>
#include <new>

namespace espalier {

constinit thread_local uint32_t allocationsLeft = kPlenty;
constinit thread_local uint32_t refusals = 0;

}  // namespace espalier

using namespace espalier;

void* operator new(std::size_t bytes) {
    const bool none = allocationsLeft == 0;
    if (none) ++refusals;
    if (!none && allocationsLeft != kPlenty) --allocationsLeft;
    void* memory = none ? nullptr : std::malloc(bytes > 0 ? bytes : 1);
    return memory ? memory : throw std::bad_alloc();
}
// What the library's own would do by the one above; the sanitizers' has memory of its own.
void* operator new(std::size_t bytes, const std::nothrow_t&) noexcept {
    try {
        return operator new(bytes);
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
// The compiler doesn't see that our operator new takes from malloc as well.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
