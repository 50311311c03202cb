#pragma once

#include <string_view>
#include <vector>

namespace sample {

// What is coloured of a line of a grammar's text.
enum class TokenKind { plain, comment, word, name, number, text };
struct Token {
    size_t begin = 0, length = 0;
    TokenKind kind = TokenKind::plain;
};
// Declarations are words; what begins with a capital letter is the name of a rule or a command; texts and colours are
// texts. Blanks belong to no token. inComment: whether the line begins within /* and */, and then whether it ends so.
std::vector<Token> tokensOf(std::string_view line, bool& inComment);

// The line, from 1, of the first place behind `from` that holds `wanted`, in whatever case; it goes on at the
// beginning. 0: none does.
int findLine(std::string_view text, std::string_view wanted, int from);

}  // namespace sample
