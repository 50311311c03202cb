#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

// With AddressSanitizer drivers stay loaded to the end, so that their leaks have a module's name and can be told
// from ours (tools/lib/leaks.txt).
#ifdef __SANITIZE_ADDRESS__
extern "C" __attribute__((visibility("default"))) int dlclose(void*) {
    return 0;
}
#endif
