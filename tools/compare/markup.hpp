#pragma once

#include <string>

namespace espalier::compare {

// A text as XML and HTML hold it, in an attribute too. What XML can't hold, such as control characters and bytes that
// aren't UTF-8, becomes U+FFFD.
std::string escaped(const std::string& text);

}  // namespace espalier::compare
