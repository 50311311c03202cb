// A grammar's text and a place in it -> names that may stand there.
#include "sample_game/grammar_completion.hpp"

#include <algorithm>

#include "sample_game/grammar_colours.hpp"

namespace sample {
namespace {

constexpr size_t kLongestUsage = 60;

bool isNameLetter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}
char lowLetter(char c) {
    return c >= 'A' && c <= 'Z' ? char(c + 32) : c;
}
bool beginsWith(std::string_view name, std::string_view letters) {
    return name.size() > letters.size() &&
           std::ranges::equal(name.substr(0, letters.size()), letters, {}, lowLetter, lowLetter);
}

// Told name by name, with the line that each stands in, and the number of its token there.
template <class Tell>
void forNames(std::string_view text, Tell&& tell) {
    bool inComment = false;
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        const std::string_view line = text.substr(begin, end - begin);
        const std::vector<Token> tokens = tokensOf(line, inComment);
        for (size_t i = 0; i < tokens.size(); ++i) {
            const std::string_view name = line.substr(tokens[i].begin, tokens[i].length);
            const bool named = tokens[i].kind == TokenKind::plain || tokens[i].kind == TokenKind::name;
            if (named && isNameLetter(name[0])) tell(name, begin + tokens[i].begin, line, tokens, i);
        }
        begin = end + 1;
    }
}

// What a line says of the name that it declares: a parameter's label, a layer's, a rule's head. Empty: it declares
// none.
std::string saidBy(std::string_view line, const std::vector<Token>& tokens, size_t index) {
    const auto word = [&](size_t i) { return line.substr(tokens[i].begin, tokens[i].length); };
    const bool declared = index == 1 && tokens[0].kind == TokenKind::word;
    const bool rule = index == 0 && tokens[0].kind == TokenKind::name;
    if (!declared && !rule) return {};
    std::string said;
    if (declared) {
        for (size_t i = 2; i < tokens.size(); ++i)
            if (tokens[i].kind == TokenKind::text && tokens[i].length > 2)
                said = std::string(word(i).substr(1, tokens[i].length - 2));
        said = std::string(word(0)) + (said.empty() ? "" : ": " + said);
    } else {
        said = "rule";
    }
    if (said.size() > kLongestUsage) said.resize(kLongestUsage);
    return said;
}

}  // namespace

size_t lettersBefore(std::string_view text, size_t cursor) {
    size_t letters = 0;
    forNames(text, [&](std::string_view name, size_t at, std::string_view, const auto&, size_t) {
        if (at < cursor && cursor <= at + name.size()) letters = cursor - at;
    });
    return letters;
}

std::vector<Completion> completionsOf(std::string_view text, size_t cursor, const std::vector<Completion>& words) {
    const size_t count = lettersBefore(text, cursor);
    if (count == 0) return {};
    const std::string_view letters = text.substr(cursor - count, count);
    std::vector<Completion> own, others;
    forNames(text, [&](std::string_view name, size_t at, std::string_view line, const auto& tokens, size_t index) {
        if (!beginsWith(name, letters) || (at < cursor && cursor <= at + name.size())) return;
        const std::string said = saidBy(line, tokens, index);
        const auto known = std::ranges::find(own, name, &Completion::name);
        if (known == own.end())
            own.push_back({std::string(name), said});
        else if (known->usage.empty())
            known->usage = said;
    });
    for (const Completion& word : words) {
        if (!beginsWith(word.name, letters)) continue;
        std::erase_if(own, [&](const Completion& known) { return known.name == word.name; });
        others.push_back(word);
    }
    std::ranges::sort(own, {}, &Completion::name);
    std::ranges::sort(others, {}, &Completion::name);
    own.insert(own.end(), others.begin(), others.end());
    if (own.size() > kMostCompletions) own.resize(kMostCompletions);
    return own;
}

std::string insertedBy(const Completion& completion) {
    return completion.usage.starts_with(completion.name + "(") ? completion.name + "(" : completion.name;
}

}  // namespace sample
