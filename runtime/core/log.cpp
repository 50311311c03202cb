// Messages to stderr.
#include "runtime/core/log.hpp"

#include <cstdio>

namespace espalier {

Log logToStderr() {
    return [](Severity severity, std::string_view text) {
        const char* kind = severity == Severity::error ? "error: " : severity == Severity::warning ? "warning: " : "";
        std::fprintf(stderr, "espalier: %s%.*s\n", kind, int(text.size()), text.data());
    };
}

}  // namespace espalier
