// What becomes of mistakes that no caller could answer.
#include "runtime/core/check.hpp"

#include <string>

namespace espalier {

void fatal(std::string_view message, CodePlace where) {
    throw InternalError(std::string(where.file) + ":" + std::to_string(where.line) + ": " + std::string(message));
}

}  // namespace espalier
