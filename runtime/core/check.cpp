// The end of the program for mistakes that no caller could answer.
#include "runtime/core/check.hpp"

#include <cstdio>
#include <cstdlib>

namespace espalier {

void fatal(std::string_view message, std::source_location where) {
    std::fprintf(stderr, "%s:%u: %s: %.*s\n", where.file_name(), unsigned(where.line()), where.function_name(),
                 int(message.size()), message.data());
    std::fflush(stderr);
    std::abort();
}

}  // namespace espalier
