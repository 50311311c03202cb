#pragma once

#include <source_location>
#include <sstream>
#include <string_view>

namespace espalier {

// Prints the message with its place and ends the program: for programming mistakes and broken devices, which no
// caller could answer. Content mistakes and outside failures are a Result instead.
[[noreturn]] void fatal(std::string_view message, std::source_location where = std::source_location::current());

// Checks that are worth having in release builds too. Prints both values.
template <class A, class B>
void requireEqual(const A& a, const B& b, std::string_view what,
                  std::source_location where = std::source_location::current()) {
    if (a == b) return;
    std::ostringstream text;
    text << what << ": " << a << " is not " << b;
    fatal(text.str(), where);
}
inline void require(bool condition, std::string_view what,
                    std::source_location where = std::source_location::current()) {
    if (!condition) fatal(what, where);
}

}  // namespace espalier
