// A line of a grammar -> its tokens, and lines that hold a word.
#include "sample_game/grammar_colours.hpp"

#include <algorithm>
#include <array>

namespace sample {
namespace {

bool isLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

// The end of what begins at `at`, and all of whose further letters hold.
template <class Holds>
size_t endOf(std::string_view line, size_t at, Holds&& holds) {
    do ++at;
    while (at < line.size() && holds(line[at]));
    return at;
}

TokenKind kindOfName(std::string_view name) {
    constexpr std::array<std::string_view, 10> kWords{"param", "context", "let", "width",     "include",
                                                      "and",   "or",      "not", "otherwise", "avoid"};
    if (std::ranges::find(kWords, name) != kWords.end()) return TokenKind::word;
    return name[0] >= 'A' && name[0] <= 'Z' ? TokenKind::name : TokenKind::plain;
}

Token tokenAt(std::string_view line, size_t at, bool& inComment) {
    const auto to = [&](size_t end, TokenKind kind) { return Token{at, end - at, kind}; };
    const std::string_view rest = line.substr(at);
    if (inComment || rest.starts_with("/*")) {
        const size_t end = line.find("*/", inComment ? at : at + 2);
        inComment = end == line.npos;
        return to(inComment ? line.size() : end + 2, TokenKind::comment);
    }
    if (rest.starts_with("//")) return to(line.size(), TokenKind::comment);
    const char c = line[at];
    if (c == '"') return to(std::min(line.size(), std::min(line.find('"', at + 1), line.size()) + 1), TokenKind::text);
    const auto goesOn = [](char next) { return isLetter(next) || isDigit(next); };
    if (c == '#') return to(endOf(line, at, goesOn), TokenKind::text);
    if (isDigit(c))
        return to(endOf(line, at, [&](char next) { return goesOn(next) || next == '.'; }), TokenKind::number);
    if (!isLetter(c)) return to(at + 1, TokenKind::plain);
    const size_t end = endOf(line, at, goesOn);
    return to(end, kindOfName(line.substr(at, end - at)));
}

char lowered(char c) {
    return c >= 'A' && c <= 'Z' ? char(c + 32) : c;
}

}  // namespace

std::vector<Token> tokensOf(std::string_view line, bool& inComment) {
    std::vector<Token> tokens;
    for (size_t at = 0; at < line.size();) {
        if (!inComment && (line[at] == ' ' || line[at] == '\t')) {
            ++at;
            continue;
        }
        tokens.push_back(tokenAt(line, at, inComment));
        at += tokens.back().length;
    }
    return tokens;
}

int findLine(std::string_view text, std::string_view wanted, int from) {
    if (wanted.empty()) return 0;
    int line = 1, first = 0;
    for (size_t begin = 0; begin <= text.size(); ++line) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view here = text.substr(begin, end - begin);
        begin = end + 1;
        const bool holds = std::ranges::search(here, wanted, {}, lowered, lowered).begin() != here.end();
        if (holds && line > from) return line;
        if (holds && first == 0) first = line;
    }
    return first;
}

}  // namespace sample
