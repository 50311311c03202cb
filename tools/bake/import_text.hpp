#pragma once

// Lines and words of a text, as OBJ and MTL have them.

#include <string>
#include <string_view>

#include "runtime/core/result.hpp"
#include "tools/formats/text.hpp"

namespace espalier::import {

using formats::isBlank;
using formats::nextLine;
using formats::nextWord;
using formats::toInteger;
using formats::toNumber;
using formats::trimmed;

inline std::string smallLetters(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
    return out;
}

// Text editors of Windows put a mark in front that tells the encoding.
inline std::string_view withoutByteOrderMark(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    return text;
}

// A line without what follows a # on it.
inline std::string_view withoutComment(std::string_view line) {
    return trimmed(line.substr(0, line.find('#')));
}

// Calls statement(line, number) for every line that is neither empty nor a comment; a backslash at its end joins the
// next one. Stops at the first failure. Comments at a line's end are left in: names may hold a #.
template <class Statement>
Status eachLine(std::string_view text, Statement&& statement) {
    std::string joined;
    int number = 0, first = 0;
    text = withoutByteOrderMark(text);
    while (!text.empty()) {
        std::string_view line = trimmed(nextLine(text));
        ++number;
        if (joined.empty()) first = number;
        if (line.starts_with('#')) line = {};
        const bool more = line.ends_with('\\');
        if (more) line.remove_suffix(1);
        if (more || !joined.empty()) joined.append(line).push_back(' ');
        if (more && !text.empty()) continue;
        std::string_view whole = trimmed(joined.empty() ? line : std::string_view(joined));
        if (!whole.empty()) {
            Status done = statement(whole, first);
            if (!done) return done;
        }
        joined.clear();
    }
    return Done{};
}

}  // namespace espalier::import
