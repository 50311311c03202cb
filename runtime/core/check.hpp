#pragma once

#include <sstream>
#include <stdexcept>
#include <string_view>

namespace espalier {

// Where a check stands. (clang 14 lacks std::source_location.)
struct CodePlace {
    const char* file;
    int line;
    static CodePlace current(const char* file = __builtin_FILE(), int line = __builtin_LINE()) { return {file, line}; }
};

// A mistake in our own text. what(): the place and the message.
struct InternalError : std::logic_error {
    using std::logic_error::logic_error;
};

// Throws an InternalError: for programming mistakes and broken devices, which no caller could answer. The C interface
// makes a code of it, since a library mustn't end a host's process. Content mistakes and outside failures are a Result
// instead.
[[noreturn]] void fatal(std::string_view message, CodePlace where = CodePlace::current());

// Checks that are worth having in release builds too. The message has both values.
template <class A, class B>
void requireEqual(const A& a, const B& b, std::string_view what, CodePlace where = CodePlace::current()) {
    if (a == b) return;
    std::ostringstream text;
    text << what << ": " << a << " is not " << b;
    fatal(text.str(), where);
}
inline void require(bool condition, std::string_view what, CodePlace where = CodePlace::current()) {
    if (!condition) fatal(what, where);
}

}  // namespace espalier
