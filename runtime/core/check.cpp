// The end of the program for mistakes that no caller could answer.
#include "runtime/core/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace espalier {

void fatal(std::string_view message, CodePlace where) {
    std::fprintf(stderr, "%s:%d: %.*s\n", where.file, where.line, int(message.size()), message.data());
    std::fflush(stderr);
    std::abort();
}

}  // namespace espalier
