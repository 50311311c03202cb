// The entry that libFuzzer calls; which target is told by the name that the program is built with.
#include "tests/fuzz/targets.hpp"

extern "C" __attribute__((visibility("default"))) int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    espalier::fuzz::ESPALIER_FUZZ_TARGET({data, size});
    return 0;
}
