#pragma once

// Lines, words and numbers of a text, as OBJ, MTL and PLY have them.

#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

namespace espalier::formats {

inline bool isBlank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// Cuts the first word off a line; empty at the line's end.
inline std::string_view nextWord(std::string_view& line) {
    size_t from = 0;
    while (from < line.size() && isBlank(line[from])) ++from;
    size_t to = from;
    while (to < line.size() && !isBlank(line[to])) ++to;
    std::string_view word = line.substr(from, to - from);
    line.remove_prefix(to);
    return word;
}

// What is left of a line, without blanks around it.
inline std::string_view trimmed(std::string_view line) {
    while (!line.empty() && isBlank(line.front())) line.remove_prefix(1);
    while (!line.empty() && isBlank(line.back())) line.remove_suffix(1);
    return line;
}

// Cuts the first line off a text, whichever way it ends: "\n", "\r\n", or "\r" alone, as old Macintosh files have it.
inline std::string_view nextLine(std::string_view& text) {
    size_t end = 0;
    while (end < text.size() && text[end] != '\n' && text[end] != '\r') ++end;
    std::string_view line = text.substr(0, end);
    text.remove_prefix(end);
    text.remove_prefix(text.starts_with("\r\n") ? 2 : text.empty() ? 0 : 1);
    return line;
}

// The whole word as a number; false for everything else. Numbers too small for a double are 0; what programs of Windows
// write for none, such as "-1.#IND", is one that is not a number.
inline bool toNumber(std::string_view word, double& value) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    if (word.starts_with("1.#") || word.starts_with("-1.#")) {
        value = std::numeric_limits<double>::quiet_NaN();
        return true;
    }
    auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error == std::errc::result_out_of_range && word.find("e-") != word.npos) value = 0, error = {};
    return error == std::errc() && end == word.data() + word.size();
}

inline bool toInteger(std::string_view word, long long& value) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size();
}

}  // namespace espalier::formats
