// Diagnostics as the text that tools and the editor print.
#include "runtime/core/result.hpp"

namespace espalier {

std::string toString(const Diagnostic& d) {
    std::string text = d.file;
    if (d.line > 0) text += ":" + std::to_string(d.line);
    if (d.line > 0 && d.column > 0) text += ":" + std::to_string(d.column);
    if (!text.empty()) text += ": ";
    if (d.warning) text += "warning: ";
    if (!d.rule.empty()) text += d.rule + ": ";
    return text + d.message;
}

std::string toString(const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& d : diagnostics) text += (text.empty() ? "" : "\n") + toString(d);
    return text;
}

Failure deviceFailure(std::string_view object, std::string message, Failure::Cause cause) {
    Failure failure(object, std::move(message));
    failure.cause = cause;
    return failure;
}

}  // namespace espalier
