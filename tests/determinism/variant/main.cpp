// In: a file of inputs. Out: one line on what the CPU reference grows of them. Built by several compilers.
#include "tests/determinism/variant/grow_on_cpu.hpp"

int main(int argc, char** argv) {
    using namespace espalier::determinismtest;
    FixedInputs in;
    if (argc != 2 || !readInputs(in, argv[1])) {
        std::fprintf(stderr, "usage: %s INPUTS\n", argv[0]);
        return 1;
    }
    const std::string line = grownOnCpu(in);
    std::puts(line.c_str());
    return line.empty() ? 1 : 0;
}
